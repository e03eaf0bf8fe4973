# SPDX-License-Identifier: GPL-3.0-or-later
"""Overlays put lines and labels where they belong and leave the rest of the picture alone."""

from __future__ import annotations

import numpy as np
import pytest
from monocell.core import Box, Camera, Cone, Cylinder, Intrinsics, Pose, Prism, Sphere, Tube
from monocell.core.ball.sphere import outline_pixels
from monocell.core.errors import PictureError
from monocell.core.picture.overlay import BallOutline, caption, draw_overlay
from monocell.core.picture.overlay_label import Label, place_label
from monocell.core.picture.wireframe import wireframe
from picked_scene import FLOOR, box_on, camera, cylinder_on


def grey(cam, value=120):
    return np.full((cam.intrinsics.height, cam.intrinsics.width, 3), value, np.uint8)


def scaled(factor):
    inner = Intrinsics(
        int(320 * factor), int(240 * factor), 300 * factor, 300 * factor, 160 * factor, 120 * factor
    )
    return Camera(inner, camera().pose)


def test_the_picture_given_is_not_touched():
    picture = grey(camera())
    draw_overlay(picture, camera(), [box_on(FLOOR)])
    assert (picture == 120).all()


def test_nothing_to_draw_leaves_the_picture_as_it_was():
    np.testing.assert_array_equal(draw_overlay(grey(camera()), camera()), grey(camera()))


def test_visible_edges_are_drawn_on_their_pixels():
    cam, box = camera(), box_on(FLOOR)
    drawn = draw_overlay(grey(cam), cam, [box])
    for line in wireframe(box, cam):
        rows = np.round(line.pixels[1:-1]).astype(int)
        change = np.abs(drawn[rows[:, 1], rows[:, 0]].astype(int) - 120).max(axis=1)
        assert (change > 25).all()


def test_a_line_is_placed_finer_than_a_pixel():
    # the weight of the drawn stroke, left against right, follows the outline's sub-pixel place
    cam = camera("none")
    centres = []
    for shift in (0.0, 0.25, 0.5, 0.75):
        outline = np.array([[400.0 + shift, 200.0], [400.0 + shift, 700.0]])
        black = np.zeros((960, 1280, 3), np.uint8)
        drawn = draw_overlay(black, cam, balls=[BallOutline(outline, (255, 255, 255))])
        row = drawn[450, 390:412].astype(float).mean(axis=1)
        centres.append(float(row @ np.arange(390, 412) / row.sum()))
    np.testing.assert_allclose(np.array(centres) - 400, [0, 0.25, 0.5, 0.75], atol=0.1)


def test_hidden_edges_are_fainter_than_visible_ones():
    cam, drum = camera(), cylinder_on(FLOOR)
    drawn = draw_overlay(grey(cam), cam, [drum]).astype(int)
    strength = {}
    for line in wireframe(drum, cam):
        places = np.linspace(0.2, 0.8, 15) * (len(line.pixels) - 1)
        inner = [np.interp(places, np.arange(len(line.pixels)), axis) for axis in line.pixels.T]
        rows = np.round(np.column_stack(inner)).astype(int)
        change = np.abs(drawn[rows[:, 1], rows[:, 0]] - 120).max(axis=1)
        strength.setdefault(line.visible, []).append(np.median(change))
    assert max(strength[False]) < min(strength[True])


@pytest.mark.parametrize("factor", [0.5, 1, 4, 8])
def test_line_and_label_follow_the_picture_size(factor):
    cam = scaled(factor)
    drawn = draw_overlay(grey(cam), cam, [box_on(FLOOR)])
    share = (np.abs(drawn.astype(int) - 120).max(axis=2) > 10).mean()
    assert 0.005 < share < 0.45


def test_a_ball_is_drawn_on_its_outline_even_where_half_of_it_is_not_imaged():
    cam = camera()
    outline = outline_pixels(cam.intrinsics, [0.0, 0.0, 1.0], 0.1)
    outline[40:90] = np.nan
    drawn = draw_overlay(grey(cam), cam, balls=[BallOutline(outline)]).astype(int)
    rows = np.round(outline[np.isfinite(outline[:, 0])]).astype(int)
    assert (np.abs(drawn[rows[:, 1], rows[:, 0]] - 120).max(axis=1) > 25).all()


def test_an_object_outside_the_picture_has_no_label_and_no_lines():
    cam = camera("none")
    far = Box("far", Pose(np.eye(3), np.array([2.4, -2.0, 2.2])), size=[0.1, 0.1, 0.1])
    np.testing.assert_array_equal(draw_overlay(grey(cam), cam, [far]), grey(cam))


def test_captions_hold_sizes_in_millimetres_with_their_sigma():
    covariance = np.zeros((9, 9))
    covariance[6, 6], covariance[7, 7] = 0.4e-3**2, 0.03e-3**2
    box = Box("b", Pose.identity(), size=[0.0841, 0.2, 0.3], covariance=covariance)
    assert caption(box) == "84.1 ± 0.4 × 200.00 ± 0.03 × 300.0 mm"
    assert caption(Cylinder("c", Pose.identity(), radius=0.04, height=0.25)) == (
        "radius 40.0, height 250.0 mm"
    )


def test_captions_name_the_sizes_of_every_kind():
    here, square = Pose.identity(), [[-0.1, -0.1], [0.1, -0.1], [0.1, 0.1], [-0.1, 0.1]]
    told = {
        "radius 40.0 mm": Sphere("s", here, radius=0.04),
        "radius 40.0, height 250.0 mm": Cone("c", here, radius=0.04, height=0.25),
        "radius 40.0, top radius 20.0, height 250.0 mm": Cone(
            "c", here, radius=0.04, top_radius=0.02, height=0.25
        ),
        "radius 40.0, inner radius 20.0, height 250.0 mm": Tube(
            "t", here, radius=0.04, inner_radius=0.02, height=0.25
        ),
        "4 corners, height 250.0 mm": Prism("p", here, polygon=square, height=0.25),
    }
    assert [caption(thing) for thing in told.values()] == list(told)


def test_labels_stay_in_the_picture_and_off_each_other():
    label = Label(("name", "12.0 ± 0.1 × 3.0 mm"), (255, 0, 0), 11.0)
    taken = []
    for _ in range(4):
        box = place_label(label, np.array([500.0, 400.0, 620.0, 520.0]), taken, (1280, 960))
        assert (box >= 0).all()
        assert (box <= [1280, 960, 1280, 960]).all()
        for other in taken:
            extent = np.minimum(box[2:], other[2:]) - np.maximum(box[:2], other[:2])
            assert (extent <= 0).any()
        taken.append(box)


def test_a_label_wider_than_the_picture_is_cut_and_does_no_harm():
    cam = Camera(Intrinsics(40, 30, 40.0, 40.0, 20.0, 15.0), camera().pose)
    drawn = draw_overlay(grey(cam), cam, [box_on(FLOOR)])
    assert drawn.shape == (30, 40, 3)


@pytest.mark.parametrize(
    "picture",
    [np.zeros((960, 1280), np.uint8), np.zeros((480, 640, 3), np.uint8), np.zeros((960, 1280, 3))],
    ids=["grey", "another size", "floats"],
)
def test_a_picture_of_another_kind_is_refused(picture):
    with pytest.raises(PictureError, match="this camera needs"):
        draw_overlay(picture, camera())
