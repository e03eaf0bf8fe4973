# SPDX-License-Identifier: GPL-3.0-or-later
import bench_cell
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from monocell.addon.pick_plan import (
    BOX,
    CONE,
    CYLINDER,
    FRUSTUM,
    PRISM,
    SPHERE,
    TUBE,
    corner_below,
)
from monocell.addon.pick_session import PickSession
from monocell.addon.picture_frame import PictureFrame
from monocell.core import Cone, Pose, Tube
from monocell.core.modelling.solve import solve_sketch
from monocell.core.picture.undistortion import undistorted_picture
from monocell.core.sketch import Sketch

CORNERS = bench_cell.CAMERA.project(bench_cell.BOX.corners_world())
BASE = CORNERS[bench_cell.ROUND]
# above the three picked base corners, and above the fourth
TOPS = CORNERS[[4, 5, 7, 6]]


def session(plan, *pixels):
    started = PickSession(plan, bench_cell.CAMERA, bench_cell.FLOOR)
    for pixel in pixels:
        started = started.picked(np.array(pixel))
    return started


def sizes_in(words):
    return [float(word) for word in words.replace("×", " ").split() if word[0].isdigit()][::2]


@pytest.mark.parametrize("corner", range(4))
def test_a_top_pick_belongs_to_the_base_corner_below_it(corner):
    corners = bench_cell.BOX.corners_world()[[0, 1, 3, 2]]
    pixel = TOPS[corner] + np.array([3.0, 1.0])
    assert corner_below(bench_cell.CAMERA, bench_cell.FLOOR, corners, pixel, -1) == corner


def test_the_box_that_is_shown_is_the_true_one():
    preview = session(BOX, *BASE).preview(TOPS[1])
    assert preview.complaint == ""
    assert sizes_in(preview.words) == pytest.approx([200, 140, 120], abs=0.06)
    drawn = np.concatenate([line.pixels for line in preview.lines])
    intrinsics = bench_cell.INTRINSICS
    truth = intrinsics.undistorted().project(intrinsics.rays(CORNERS))
    assert all(np.linalg.norm(drawn - corner, axis=1).min() < 0.05 for corner in truth)


def test_the_cylinder_that_is_shown_is_the_true_one():
    picks = bench_cell.drum_picks()
    preview = session(CYLINDER, *picks["rim"]).preview(np.array(picks["top"][0]))
    assert "radius 60.0" in preview.words and "height 180.0" in preview.words


def test_the_point_under_the_cursor_is_told_in_metres():
    corner = bench_cell.BOX.corners_world()[0]
    words = session(BOX).preview(BASE[0]).words
    assert words.startswith("x {:.3f}   y {:.3f}   z 0.000 m   ± ".format(*corner[:2]))
    # a pixel there is about 2 mm, and longer along the view
    assert 1.0 < float(words.split()[-2]) < 8.0


def test_from_the_second_corner_on_the_base_is_drawn():
    assert session(BOX).preview(BASE[0]).lines == ()
    assert len(session(BOX, BASE[0]).preview(BASE[1]).lines) == 1
    flat = session(BOX, *BASE[:2]).preview(BASE[2])
    assert len(flat.lines) == 12 and flat.complaint == ""


def test_what_can_not_be_the_object_is_said_and_not_taken():
    assert "horizon" in session(BOX).preview(np.array([400.0, -260.0])).complaint
    assert "line" in session(BOX, *BASE[:2]).preview(BASE[0]).complaint
    below = session(BOX, *BASE).preview(BASE[1] + [0.0, 20.0])
    assert below.complaint != "" and below.lines != ()


def test_beside_the_picture_nothing_is_drawn():
    preview = session(BOX, *BASE).preview(None)
    assert preview.lines == () and preview.words == "outside the picture"


def test_taking_back_forgets_the_last_pick_only():
    picked = session(BOX, *BASE)
    assert picked.taken_back().picks() == session(BOX, *BASE[:2]).picks()
    assert session(BOX).taken_back().pixels == ((), ())


def test_more_top_picks_are_all_kept():
    assert session(BOX, *BASE, TOPS[1], TOPS[3]).picks()["top"] == [
        None,
        TOPS[1].tolist(),
        None,
        TOPS[3].tolist(),
    ]
    picks = bench_cell.drum_picks(tops=2)
    assert session(CYLINDER, *picks["rim"], *picks["top"]).picks() == picks


def rim_pixels(thing, level, angles):
    """Pixels of points of a rim, at angles from the side that faces the camera."""
    eye = bench_cell.POSE.inverse().translation - thing.world_from_object.translation
    turned = np.arctan2(eye[1], eye[0]) + np.array(angles)
    radius = level[0]
    points = np.stack([radius * np.cos(turned), radius * np.sin(turned)], 1)
    points = np.column_stack([points, np.full(len(points), level[1])])
    return bench_cell.CAMERA.project(thing.world_from_object.apply(points))


def solved(plan, *pixels):
    picked = session(plan, *pixels)
    assert picked.complete
    sketch = Sketch("x", plan.kind, "floor", picked.picks())
    return solve_sketch(bench_cell.CAMERA, sketch, [bench_cell.FLOOR]).object


UPRIGHT = Pose(np.eye(3), [0.36, 0.05, 0.08])


def test_cone_frustum_and_tube_are_picked_as_their_plans_say():
    foot = [-1.3, 0.0, 1.3]
    cone = Cone("c", UPRIGHT, radius=0.06, top_radius=0.0, height=0.16)
    apex = bench_cell.CAMERA.project(UPRIGHT.apply(np.array([[0, 0, 0.08]])))
    found = solved(CONE, *rim_pixels(cone, (0.06, -0.08), foot), *apex)
    assert found.sizes == pytest.approx([0.06, 0, 0.16], abs=1e-6)
    top = rim_pixels(cone, (0.03, 0.08), foot)
    found = solved(FRUSTUM, *rim_pixels(cone, (0.06, -0.08), foot), *top)
    assert found.sizes == pytest.approx([0.06, 0.03, 0.16], abs=1e-5)
    tube = Tube("t", UPRIGHT, radius=0.06, inner_radius=0.04, height=0.16)
    pixels = [
        *rim_pixels(tube, (0.06, -0.08), foot),
        *rim_pixels(tube, (0.06, 0.08), [0.2]),
        *rim_pixels(tube, (0.04, 0.08), [2.5]),
    ]
    assert solved(TUBE, *pixels).sizes == pytest.approx([0.06, 0.04, 0.16], abs=1e-5)


def test_a_ball_on_the_reference_is_picked_by_its_outline():
    from monocell.core.ball.sphere import outline_pixels

    centre = bench_cell.POSE.apply(np.array([0.4, 0, 0.05]))
    pixels = outline_pixels(bench_cell.INTRINSICS, centre, 0.05, 12)
    found = solved(SPHERE, *pixels[[0, 4, 8]])
    assert found.radius == pytest.approx(0.05, abs=1e-6)


def test_a_prism_takes_any_number_of_corners_and_enter_ends_its_base():
    floor = [[0.3, -0.1], [0.42, -0.1], [0.45, 0.02], [0.36, 0.08], [0.28, 0.0]]
    base = np.column_stack([floor, np.zeros(5)])
    pixels = bench_cell.CAMERA.project(base)
    picking = session(PRISM, *pixels)
    assert not picking.complete and picking.open and picking.step.role == "base"
    assert "another base corner" in picking.prompt
    raised = bench_cell.CAMERA.project(base + np.array([0, 0, 0.1]))
    picking = picking.advanced().picked(raised[1])
    assert picking.complete
    assert [pick is None for pick in picking.picks()["top"]] == [True, False, True, True, True]
    sketch = Sketch("x", "prism", "floor", picking.picks())
    found = solve_sketch(bench_cell.CAMERA, sketch, [bench_cell.FLOOR]).object
    assert found.height == pytest.approx(0.1, abs=1e-6)
    # taking back leads over the step into the one before
    assert picking.taken_back().taken_back().step.role == "base"


FRAME = PictureFrame(-35.25, 12.5, 1004.75, 792.5, bench_cell.INTRINSICS)


@given(st.floats(0.0, 800.0), st.floats(0.0, 600.0))
def test_a_region_point_comes_back_from_its_pixel(x, y):
    assert FRAME.region_points(FRAME.view_pixel(x, y)[None])[0] == pytest.approx([x, y], abs=1e-9)


def test_pixel_centres_are_whole_and_edges_lie_on_the_frame():
    assert FRAME.view_pixel(FRAME.left, FRAME.top) == pytest.approx([-0.5, -0.5])
    assert FRAME.view_pixel(FRAME.right, FRAME.bottom) == pytest.approx([799.5, 599.5])


def test_a_click_on_the_undistorted_view_is_a_pixel_of_the_picture_as_it_came():
    """A dot in the picture is clicked where the undistorted picture shows it."""
    for u, v in ((60, 50), (700, 520), (411, 293), (90, 540)):
        rows, columns = np.mgrid[:600, :800]
        dot = 255 * np.exp(-((columns - u) ** 2 + (rows - v) ** 2) / 18.0)
        picture = np.repeat(dot[:, :, None], 3, axis=2).astype(np.uint8)
        shown = undistorted_picture(picture, bench_cell.INTRINSICS)[:, :, 0].astype(float)
        seen = np.array([(columns * shown).sum(), (rows * shown).sum()]) / shown.sum()
        x, y = FRAME.region_points(seen[None])[0]
        assert FRAME.picture_pixel(x, y) == pytest.approx([u, v], abs=0.15)
