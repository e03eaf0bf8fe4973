# SPDX-License-Identifier: GPL-3.0-or-later
"""Quad and local view, hidden things, several windows, and views left while picking, in a real
window."""

import json

import bench_cell
import cv2
import numpy as np
import pytest
from model_scene import draw_scene
from monocell.core.document.cell_file import read_cell
from window_run import in_window

pytestmark = [pytest.mark.real_blender, pytest.mark.slow]

# the ways in which each run leaves a view
LEFT = (("file",), ("area", "full", "workspace", "scene"), ("window", "closed", "working"))


def seen(pixels):
    """Pixels as the lens images them to pixels of the undistorted view."""
    i = bench_cell.INTRINSICS
    return i.undistorted().project(i.rays(np.array(pixels))).tolist()


def worked(blender, folder, run):
    """What one Blender left in a folder after a part of the steps."""
    document = bench_cell.write_bench(folder, balls=False)
    draw_scene(folder / "bench.png")
    box, drum = bench_cell.box_picks(), bench_cell.drum_picks()
    top = bench_cell.BOX.corners_world()[4:].mean(axis=0)
    job = {
        "run": run,
        "document": str(document),
        "picks": {"box": json.dumps(box), "drum": json.dumps(drum)},
        "box": seen([*box["base"], box["top"][1]]),
        "drum": seen([*drum["rim"], *drum["top"]]),
        "on_box": seen(bench_cell.CAMERA.project(top[None]))[0],
        "width": bench_cell.INTRINSICS.width,
        "height": bench_cell.INTRINSICS.height,
    }
    return in_window(blender, folder, "states_steps.py", job)


@pytest.fixture(scope="session")
def views(window_blender, tmp_path_factory):
    """Views of all kinds: the folder that one Blender left its work in, and what it found."""
    return worked(window_blender, tmp_path_factory.mktemp("views"), "views")


@pytest.fixture(scope="session")
def left(window_blender, tmp_path_factory):
    """The same of views that were left while something was picked."""
    return worked(window_blender, tmp_path_factory.mktemp("left"), "left")


@pytest.fixture(scope="session")
def windows(window_blender, tmp_path_factory):
    """The same of a second window."""
    return worked(window_blender, tmp_path_factory.mktemp("windows"), "windows")


def text(work, name):
    return (work[0] / f"{name}.cell.json").read_text()


def objects_of(work, name):
    return {thing.name: thing for thing in read_cell(work[0] / f"{name}.cell.json").objects}


def test_no_step_fails(views, left, windows):
    for _, found, run in (views, left, windows):
        assert "error" not in found, found.get("error")
        assert "Traceback" not in run.stdout + run.stderr


def test_a_box_is_picked_in_the_part_of_a_quad_view_that_shows_the_picture(views):
    assert not views[1]["quad_left_over"]
    box, truth = objects_of(views, "quad")["box"], bench_cell.BOX
    # the part is half as wide: a click is coarser
    assert np.allclose(sorted(box.size), sorted(truth.size), atol=6e-3)
    place = box.world_from_object.translation
    assert np.allclose(place, truth.world_from_object.translation, atol=6e-3)
    assert sum(pick is not None for pick in box.picks["base"]) == 3


def drawn_edges(work, name, corners):
    """The share of the box's three foremost edges along which the screenshot has lines of ours."""
    screen = cv2.imread(str(work[0] / f"{name}.png")).astype(int)
    blue, green, red = np.moveaxis(screen, 2, 0)
    ours = (np.minimum(green, red) - blue > 60) | ((blue - red > 60) & (blue > 150))
    (left, top), (right, bottom) = corners
    box = bench_cell.BOX.corners_world()
    edges = [(box[i], box[j]) for i, j in ((4, 5), (5, 7), (1, 5))]
    points = np.concatenate([np.linspace(a, b, 20) for a, b in edges])
    pixels = np.array(seen(bench_cell.CAMERA.project(points)))
    size = (bench_cell.INTRINSICS.width, bench_cell.INTRINSICS.height)
    x, y = (np.array([left, top]) + pixels / size * [right - left, bottom - top]).T
    rows, columns = np.round(screen.shape[0] - 1 - y).astype(int), np.round(x).astype(int)
    near = [ours[r - 4 : r + 5, c - 4 : c + 5].any() for r, c in zip(rows, columns, strict=True)]
    return np.mean(near)


def test_the_overlay_lies_on_the_picture_in_a_quad_view(views):
    assert drawn_edges(views, "2_quad_box", views[1]["quad_corners"]) > 0.9


def test_what_is_hidden_is_neither_drawn_nor_picked(views):
    assert drawn_edges(views, "5_shown", views[1]["shown_corners"]) > 0.9
    assert drawn_edges(views, "4_hidden", views[1]["corners"]) < 0.4
    assert views[1]["through_hidden"] == "floor"


def test_a_hidden_camera_is_told_as_its_picture_is_hidden_too(views):
    assert "camera is hidden here, and its picture with it" in views[1]["camera_refusal"]


def test_local_view_gets_the_camera_back_and_shows_what_is_new(views):
    # Blender itself leaves a camera that is not in the local view
    assert "Look through the cell's camera first" in views[1]["local_refusal"]
    assert views[1]["local_seen"]
    assert sorted(objects_of(views, "local")) == ["box", "cylinder"]


def test_a_view_that_is_left_while_picking_leaves_nothing_behind(views, left, windows):
    for (_, found, _), ways in zip((views, left, windows), LEFT, strict=True):
        for way in ways:
            assert not found[f"left_{way}"], way
            assert not found[f"picking_{way}"], way


def test_a_window_that_is_closed_ends_what_it_was_doing(windows):
    found = windows[1]
    assert found["was_closed"]
    assert found["was_working"]
    assert found["title_working"] == ""


def test_undo_meanwhile_does_not_disturb_a_pick(left):
    assert not left[1]["undone_left_over"]
    before, picked = objects_of(left, "before"), objects_of(left, "picked")
    assert sorted(picked) == sorted([*before, "box 2"])
    assert text(left, "after") == text(left, "before")


def test_a_second_window_on_another_scene_does_not_disturb_a_pick(windows):
    assert sorted(windows[1]["two_windows"]) == ["box", "box 2"]


def test_an_action_in_edit_mode_is_one_undo_step(views):
    assert views[1]["edit_mode"] == ["OBJECT", "EDIT"]
    assert objects_of(views, "edit_sized")["box"].size[2] == pytest.approx(0.2)
    assert text(views, "edit_undone") == text(views, "edit_before")


def test_a_file_that_is_saved_and_loaded_is_the_same(views):
    assert text(views, "loaded") == text(views, "kept")
