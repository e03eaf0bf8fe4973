# SPDX-License-Identifier: GPL-3.0-or-later
"""Quad and local view, hidden things, several windows, and views left while picking, in a real
window."""

import bench_cell
import cv2
import numpy as np
import pytest
from model_scene import draw_scene
from monocell.core.document.cell_file import read_cell
from window_run import in_window

pytestmark = [pytest.mark.real_blender, pytest.mark.slow]

LEFT = ("area", "full", "workspace", "scene", "window", "file")


def seen(pixels):
    """Pixels as the lens images them to pixels of the undistorted view."""
    i = bench_cell.INTRINSICS
    return i.undistorted().project(i.rays(np.array(pixels))).tolist()


@pytest.fixture(scope="session")
def worked(window_blender, tmp_path_factory):
    """The folder that one Blender left its work in, and what it found."""
    folder = tmp_path_factory.mktemp("states")
    document = bench_cell.write_bench(folder, balls=False)
    draw_scene(folder / "bench.png")
    box, drum = bench_cell.box_picks(), bench_cell.drum_picks()
    top = bench_cell.BOX.corners_world()[4:].mean(axis=0)
    job = {
        "document": str(document),
        "box": seen([*box["base"], box["top"][1]]),
        "drum": seen([*drum["rim"], *drum["top"]]),
        "on_box": seen(bench_cell.CAMERA.project(top[None]))[0],
        "width": bench_cell.INTRINSICS.width,
        "height": bench_cell.INTRINSICS.height,
    }
    return in_window(window_blender, folder, "states_steps.py", job)


def text(worked, name):
    return (worked[0] / f"{name}.cell.json").read_text()


def objects_of(worked, name):
    return {thing.name: thing for thing in read_cell(worked[0] / f"{name}.cell.json").objects}


def test_no_step_fails(worked):
    _, found, run = worked
    assert "error" not in found, found.get("error")
    assert "Traceback" not in run.stdout + run.stderr


def test_a_box_is_picked_in_the_part_of_a_quad_view_that_shows_the_picture(worked):
    assert not worked[1]["quad_left_over"]
    box, truth = objects_of(worked, "quad")["box"], bench_cell.BOX
    # the part is half as wide: a click is coarser
    assert np.allclose(sorted(box.size), sorted(truth.size), atol=6e-3)
    place = box.world_from_object.translation
    assert np.allclose(place, truth.world_from_object.translation, atol=6e-3)
    assert sum(pick is not None for pick in box.picks["base"]) == 3


def drawn_edges(worked, name, corners):
    """The share of the box's three foremost edges along which the screenshot has lines of ours."""
    screen = cv2.imread(str(worked[0] / f"{name}.png")).astype(int)
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


def test_the_overlay_lies_on_the_picture_in_a_quad_view(worked):
    assert drawn_edges(worked, "2_quad_box", worked[1]["quad_corners"]) > 0.9


def test_what_is_hidden_is_neither_drawn_nor_picked(worked):
    assert drawn_edges(worked, "5_shown", worked[1]["shown_corners"]) > 0.9
    assert drawn_edges(worked, "4_hidden", worked[1]["corners"]) < 0.4
    assert worked[1]["through_hidden"] == "floor"


def test_a_hidden_camera_is_told_as_its_picture_is_hidden_too(worked):
    assert "camera is hidden here, and its picture with it" in worked[1]["camera_refusal"]


def test_local_view_gets_the_camera_back_and_shows_what_is_new(worked):
    # Blender itself leaves a camera that is not in the local view
    assert "Look through the cell's camera first" in worked[1]["local_refusal"]
    assert worked[1]["local_seen"]
    assert sorted(objects_of(worked, "local")) == ["box", "cylinder"]


@pytest.mark.parametrize("name", LEFT)
def test_a_view_that_is_left_while_picking_leaves_nothing_behind(worked, name):
    assert not worked[1][f"left_{name}"]
    assert not worked[1][f"picking_{name}"]


def test_undo_meanwhile_does_not_disturb_a_pick(worked):
    assert not worked[1]["undone_left_over"]
    before, picked = objects_of(worked, "before"), objects_of(worked, "picked")
    assert sorted(picked) == sorted([*before, "box 2"])
    assert text(worked, "after") == text(worked, "before")


def test_a_second_window_on_another_scene_does_not_disturb_a_pick(worked):
    assert sorted(worked[1]["two_windows"]) == ["box", "box 2"]


def test_an_action_in_edit_mode_is_one_undo_step(worked):
    assert worked[1]["edit_mode"] == ["OBJECT", "EDIT"]
    assert objects_of(worked, "edit_sized")["box"].size[2] == pytest.approx(0.2)
    assert text(worked, "edit_undone") == text(worked, "edit_before")


def test_a_file_that_is_saved_and_loaded_is_the_same(worked):
    assert text(worked, "loaded") == text(worked, "kept")
