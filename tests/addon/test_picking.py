# SPDX-License-Identifier: GPL-3.0-or-later
import bench_cell
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from monocell.addon.on_picture.picture_frame import PictureFrame
from monocell.addon.picking.pick_plan import corner_below
from monocell.addon.picking.pick_plans import (
    BOX,
    CYLINDER,
    FLOATING_SPHERE,
    FRUSTUM,
    LYING_CYLINDER,
    PRISM,
    SPHERE,
)
from monocell.addon.picking.pick_session import PickSession
from monocell.core import Cylinder, Pose
from monocell.core.picture.undistortion import undistorted_picture
from monocell.core.primitives import Cone, Prism, Sphere

CORNERS = bench_cell.CAMERA.project(bench_cell.BOX.corners_world())
BASE = CORNERS[bench_cell.ROUND]
# above the three picked base corners, and above the fourth
TOPS = CORNERS[[4, 5, 7, 6]]


def session(plan, *pixels):
    started = PickSession(plan, bench_cell.CAMERA, bench_cell.FLOOR)
    for pixel in pixels:
        started = started.picked(np.array(pixel))
    return started


def circle(thing, z, radius, angles):
    """Pixels of points of a circle of a round solid, `angles` from the side that faces the eye."""
    eye = bench_cell.POSE.inverse().translation - thing.world_from_object.translation
    at = np.arctan2(eye[1], eye[0]) + np.array(angles)
    points = np.stack([radius * np.cos(at), radius * np.sin(at), np.full(len(at), z)], axis=1)
    return bench_cell.CAMERA.project(thing.world_from_object.apply(points))


def typed(started, text):
    for sign in text:
        started = started.with_key(sign)
    return started


def sizes_in(words):
    return [float(word) for word in words.replace("×", " ").split() if word[0].isdigit()][::2]


@pytest.mark.parametrize("corner", range(4))
def test_a_top_pick_belongs_to_the_base_corner_below_it(corner):
    found = corner_below(bench_cell.CAMERA, bench_cell.FLOOR, BASE, TOPS[corner] + [3.0, 1.0], 4)
    assert found == corner


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
    assert session(BOX).taken_back().taken == ()


def test_more_top_picks_are_all_kept():
    assert session(BOX, *BASE, TOPS[1], TOPS[3]).picks()["top"] == [
        None,
        TOPS[1].tolist(),
        None,
        TOPS[3].tolist(),
    ]
    picks = bench_cell.drum_picks(tops=2)
    assert session(CYLINDER, *picks["rim"], *picks["top"]).picks() == picks


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


CUP = Cone("cup", Pose(np.eye(3), [0.34, 0.2, 0.06]), radius=0.05, top_radius=0.08, height=0.12)
BALL = Sphere("ball", Pose(np.eye(3), [0.3, -0.1, 0.07]), radius=0.07)
LOG = Cylinder(
    "log",
    Pose.from_rotation_vector([1.5707963267948966, 0, 0], [0.35, 0, 0.06]),
    radius=0.06,
    height=0.3,
)
WEDGE = Prism(
    "wedge",
    Pose(np.eye(3), [0.35, 0, 0.05]),
    polygon=[[-0.1, -0.05], [0.1, -0.05], [0, 0.1]],
    height=0.1,
)


def outline_of(ball, count):
    """Pixels of points of a ball's outline."""
    eye = bench_cell.POSE.inverse().translation
    towards = ball.world_from_object.translation - eye
    away = np.linalg.norm(towards)
    axis = towards / away
    # the circle in which the cone of sight touches the ball
    middle = eye + axis * (away - ball.radius**2 / away)
    reach = ball.radius * np.sqrt(1 - (ball.radius / away) ** 2)
    one = np.cross(axis, [0, 0, 1.0])
    one /= np.linalg.norm(one)
    angles = 2 * np.pi * np.arange(count) / count
    ring = np.outer(np.cos(angles), one) + np.outer(np.sin(angles), np.cross(axis, one))
    return bench_cell.CAMERA.project(middle + reach * ring)


def test_a_frustum_is_its_two_rims():
    rim = circle(CUP, -0.06, 0.05, [-1.2, 0.0, 1.2])
    top = circle(CUP, 0.06, 0.08, [-2.0, 0.0, 2.0])
    thing = session(FRUSTUM, *rim, *top).solved()
    assert [thing.radius, thing.top_radius, thing.height] == pytest.approx([0.05, 0.08, 0.12])


def test_a_resting_ball_gets_its_radius_from_the_floor():
    started = session(SPHERE, *outline_of(BALL, 3))
    assert started.complete
    assert started.solved().radius == pytest.approx(0.07, abs=1e-6)


def test_a_floating_ball_needs_its_radius_typed():
    held = Sphere("held", Pose(np.eye(3), [0.3, 0.1, 0.35]), radius=0.05)
    started = session(FLOATING_SPHERE, *outline_of(held, 3))
    assert "radius" in started.preview(np.array([400.0, 300.0])).complaint
    thing = typed(started, "50").solved()
    assert thing.on is None and thing.radius == 0.05
    assert thing.world_from_object.translation == pytest.approx([0.3, 0.1, 0.35], abs=1e-6)


def test_a_lying_cylinder_keeps_that_it_lies():
    near, far = -0.15, 0.15
    if (
        bench_cell.POSE.apply(LOG.world_from_object.apply([0, 0, 0.15]))[2]
        < bench_cell.POSE.apply(LOG.world_from_object.apply([0, 0, -0.15]))[2]
    ):
        near, far = far, near
    angles = np.array([0.3, 1.8, 3.4, 5.0])
    points = lambda z, at: LOG.world_from_object.apply(  # noqa: E731
        np.stack([0.06 * np.cos(at), 0.06 * np.sin(at), np.full(len(at), z)], axis=1)
    )
    rim = bench_cell.CAMERA.project(points(near, angles))
    top = bench_cell.CAMERA.project(points(far, np.array([0.4, 1.2, 2.0])))
    thing = session(LYING_CYLINDER, *rim, *top).solved()
    assert [thing.radius, thing.height] == pytest.approx([0.06, 0.3], abs=1e-6)
    assert [(r.kind, r.to) for r in thing.relations] == [("lies_on", "floor")]


def prism_corners(level):
    corners = np.column_stack([WEDGE.polygon, np.full(3, level)])
    return bench_cell.CAMERA.project(WEDGE.world_from_object.apply(corners))


def test_a_prism_is_closed_at_its_first_corner_or_by_enter():
    started = session(PRISM, *prism_corners(-0.05))
    assert not started.complete and started.stage.role == "base"
    first = started.taken[0][1]
    assert started.closes(first + 2, 5.0) and not started.closes(first + 9, 5.0)
    assert started.closes(None, 0.0)
    closed = started.with_closed()
    assert closed.stage.role == "top"
    thing = closed.picked(prism_corners(0.05)[1]).solved()
    assert thing.height == pytest.approx(0.1, abs=1e-6)
    assert closed.picked(prism_corners(0.05)[1]).picks()["top"][0] is None
    assert not closed.taken_back().closed


def test_two_corners_close_no_prism():
    assert not session(PRISM, *prism_corners(-0.05)[:2]).closes(None, 0.0)


def test_another_way_keeps_what_both_know():
    started = typed(session(CYLINDER, *bench_cell.drum_picks()["rim"]), "180")
    turned = started.replanned(LYING_CYLINDER)
    assert [role for role, _ in turned.taken] == ["rim"] * 3
    assert turned.known == {"height": 0.18}


def test_with_shift_a_stage_takes_more_points():
    picks = bench_cell.drum_picks()
    started = session(CYLINDER, *picks["rim"][:2])
    more = started.picked(np.array(picks["rim"][2]), more=True)
    assert more.stage.role == "rim"
    assert more.picked(np.array(picks["rim"][0])).stage.role == "top"


def test_a_box_has_no_fifth_base_corner():
    fourth = session(BOX, *BASE[:2]).picked(BASE[2], more=True).picked(CORNERS[2], more=True)
    assert fourth.stage.role == "top"
