# SPDX-License-Identifier: GPL-3.0-or-later
"""Modelling by clicks in a real window."""

import bench_cell
import cv2
import numpy as np
import pytest
from monocell.core.document.cell_file import read_cell
from window_run import in_window

pytestmark = [pytest.mark.real_blender, pytest.mark.slow]

# a click names a screen pixel, which the view shows as up to so many pixels of the picture
CLICK_PIXELS = 1.0


def seen(pixels):
    """Pixels as the lens images them to pixels of the undistorted view."""
    i = bench_cell.INTRINSICS
    return i.undistorted().project(i.rays(np.array(pixels))).tolist()


def draw_bench(path):
    """The bench in plain colours: the floor's chequers, box and drum, through the true lens."""
    i = bench_cell.INTRINSICS
    v, u = np.mgrid[: i.height, : i.width]
    origin, rays = bench_cell.CAMERA.rays_world(np.stack([u.ravel(), v.ravel()], 1))
    picture = np.full((i.height * i.width, 3), (92.0, 86.0, 80.0))
    far = np.full(len(rays), np.inf)
    down = np.where(rays[:, 2] < 0, -origin[2] / np.minimum(rays[:, 2], -1e-9), np.inf)
    floor = origin + np.where(np.isfinite(down), down, 0)[:, None] * rays
    chequer = (np.floor(floor[:, :2] / 0.1).sum(axis=1) % 2)[:, None]
    on_table = np.isfinite(down) & (np.abs(floor[:, :2] - [0.35, 0]) < [0.45, 0.5]).all(axis=1)
    picture[on_table] = (150 + 22 * chequer * [1, 1.05, 1.1])[on_table]
    far[on_table] = down[on_table]
    for depth, color in (hit_box(origin, rays), hit_drum(origin, rays)):
        nearer = depth < far
        picture[nearer], far[nearer] = color[nearer], depth[nearer]
    image = picture.reshape(i.height, i.width, 3).astype(np.uint8)
    cv2.imwrite(str(path), cv2.GaussianBlur(image, (0, 0), 0.6))


def hit_box(origin, rays):
    pose = bench_cell.BOX.world_from_object.inverse()
    eye, ways = pose.apply(origin), pose.rotate(rays)
    half = bench_cell.BOX.half_extent
    near, far = (-half - eye) / ways, (half - eye) / ways
    enter, leave = np.minimum(near, far), np.maximum(near, far)
    depth, axis = enter.max(axis=1), enter.argmax(axis=1)
    depth[depth > leave.min(axis=1)] = np.inf
    return depth, np.array([0.75, 0.5, 1.0])[axis][:, None] * [60.0, 80.0, 205.0]


def hit_drum(origin, rays):
    drum = bench_cell.DRUM
    pose = drum.world_from_object.inverse()
    eye, ways = pose.apply(origin), pose.rotate(rays)
    a, b = (ways[:, :2] ** 2).sum(1), ways[:, :2] @ eye[:2]
    inside = b**2 - a * (eye[:2] @ eye[:2] - drum.radius**2)
    side = np.where(inside > 0, (-b - np.sqrt(np.maximum(inside, 0))) / a, np.inf)
    with np.errstate(invalid="ignore"):
        height = eye[2] + side * ways[:, 2]
        side[~(np.abs(height) <= drum.height / 2)] = np.inf
        shade = 0.45 + 0.4 * (eye[0] + side * ways[:, 0]) / drum.radius
    top = (drum.height / 2 - eye[2]) / ways[:, 2]
    off = np.linalg.norm(eye[:2] + top[:, None] * ways[:, :2], axis=1) > drum.radius
    top[off | (top < 0)] = np.inf
    light = np.where(top < side, 1.0, np.nan_to_num(shade, posinf=0, neginf=0))
    return np.minimum(side, top), np.clip(light, 0.2, 1)[:, None] * [190.0, 120.0, 50.0]


@pytest.fixture(scope="session")
def worked(window_blender, tmp_path_factory):
    """The folder that one Blender left its work in, and what it found."""
    folder = tmp_path_factory.mktemp("window")
    document = bench_cell.write_bench(folder, calibrated=False)
    draw_bench(folder / "bench.png")
    box, drum = bench_cell.box_picks(), bench_cell.drum_picks(tops=2)
    job = {
        "document": str(document),
        "box": seen([*box["base"], box["top"][1]]),
        "drum": seen([*drum["rim"], *drum["top"]]),
        "width": bench_cell.INTRINSICS.width,
        "height": bench_cell.INTRINSICS.height,
    }
    return in_window(window_blender, folder, "window_steps.py", job)


def objects_of(folder, name):
    return {thing.name: thing for thing in read_cell(folder / f"{name}.cell.json").objects}


def test_no_step_fails(worked):
    _, found, run = worked
    assert "error" not in found, found.get("error")
    assert "Traceback" not in run.stdout + run.stderr


def test_clicks_are_kept_as_pixels_of_the_picture_as_it_came(worked):
    box = objects_of(worked[0], "box")["box"]
    truth = bench_cell.box_picks()
    assert np.abs(np.array(box.picks["base"]) - truth["base"]).max() < CLICK_PIXELS
    assert [pick is None for pick in box.picks["top"]] == [True, False, True, True]
    assert np.abs(np.array(box.picks["top"][1]) - truth["top"][1]).max() < CLICK_PIXELS


def test_clicks_make_the_true_box(worked):
    box, truth = objects_of(worked[0], "box")["box"], bench_cell.BOX
    assert np.allclose(sorted(box.size), sorted(truth.size), atol=3e-3)
    centre = box.world_from_object.translation
    assert np.allclose(centre, truth.world_from_object.translation, atol=3e-3)
    assert (np.abs(box.size_sigma()) > 0).all()


def test_clicks_make_the_true_drum(worked):
    drum = objects_of(worked[0], "all")["cylinder"]
    truth = bench_cell.DRUM
    assert len(drum.picks["top"]) == 2
    assert drum.radius == pytest.approx(truth.radius, abs=3e-3)
    assert drum.height == pytest.approx(truth.height, abs=6e-3)


def test_undo_takes_the_object_and_redo_brings_it_back(worked):
    folder, _, _ = worked
    assert objects_of(folder, "undone") == {}
    before, after = (folder / f"{name}.cell.json" for name in ("box", "redone"))
    assert after.read_text() == before.read_text()


def test_cancelling_leaves_nothing(worked):
    folder, found, _ = worked
    before, after = (folder / f"{name}.cell.json" for name in ("redone", "cancelled"))
    assert after.read_text() == before.read_text()
    assert not found["left_over"]


def test_the_gltf_is_written(worked):
    assert (worked[0] / "cell.glb").stat().st_size > 1000


def test_the_overlay_lies_on_the_picture(worked):
    """Along the edges of the box as the picture shows them the screen is yellow, as selected."""
    folder, found, _ = worked
    screen = cv2.imread(str(folder / "6_box.png")).astype(int)
    yellow = screen[:, :, 1:].min(axis=2) - screen[:, :, 0] > 60
    (left, top), (right, bottom) = found["corners"]
    corners = bench_cell.BOX.corners_world()
    # two edges of the top and the nearest upright one, none of them hidden
    edges = [(corners[i], corners[j]) for i, j in ((4, 5), (5, 7), (1, 5))]
    points = np.concatenate([np.linspace(a, b, 20) for a, b in edges])
    pixels = np.array(seen(bench_cell.CAMERA.project(points)))
    size = (bench_cell.INTRINSICS.width, bench_cell.INTRINSICS.height)
    x, y = (np.array([left, top]) + pixels / size * [right - left, bottom - top]).T
    rows, columns = np.round(screen.shape[0] - 1 - y).astype(int), np.round(x).astype(int)
    near = [yellow[r - 4 : r + 5, c - 4 : c + 5].any() for r, c in zip(rows, columns, strict=True)]
    assert np.mean(near) > 0.95
    # and not because the screen is yellow all over
    assert yellow.mean() < 0.02
