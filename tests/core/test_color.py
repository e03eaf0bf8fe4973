# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from monocell.core.errors import InvalidValue, PictureError
from monocell.core.look.color import color_of
from monocell.core.pose import Pose
from painted_cell import CAMERA, ball, crate, drum, photograph

ORANGE = np.array([0.7, 0.32, 0.06])
# how strongly each face of a box is lit
LIGHT = {"top": 1.0, "x+": 0.55, "y-": 0.3}


def lit(color):
    def paint(thing, face, st):
        if thing.kind == "box":
            level = np.full(len(st), LIGHT.get(face, 1.0))
        else:
            # round the side the light falls off as the cosine does, with a floor of ambient light
            level = 0.3 + 0.7 * np.clip(np.cos(2 * np.pi * (st[:, 0] - 0.85)), 0, 1)
        return level[:, None] * color

    return paint


def noisy(picture, sigma=3.0, seed=0):
    noise = np.random.default_rng(seed).normal(0, sigma, picture.shape)
    return np.clip(picture + noise, 0, 255).round().astype(np.uint8)


def relative(color, truth):
    return float(np.abs(color - truth).max() / truth.max())


@settings(max_examples=5, deadline=None)
@given(st.tuples(*[st.floats(0.02, 0.85)] * 3).map(np.array))
def test_a_box_lit_differently_on_each_face_has_the_colour_of_its_best_lit_face(color):
    box = crate()
    sample = color_of(box, [box], noisy(photograph([box], lit(color), side=1)), CAMERA)
    assert relative(sample.color, color) < 0.03
    assert sample.uniform and not sample.warnings
    assert sample.pixels > 5000
    # the noise that was added: three levels of 255, more light per level where it is bright
    assert (sample.spread < 0.04).all()


@pytest.mark.parametrize("thing", [drum(), ball()], ids=lambda thing: thing.name)
def test_shading_round_a_curved_side_is_not_taken_for_a_print(thing):
    sample = color_of(thing, [thing], noisy(photograph([thing], lit(ORANGE))), CAMERA)
    assert sample.uniform
    assert sample.share > 0.9
    assert relative(sample.color, ORANGE) < 0.12


def test_a_highlight_a_shadow_and_a_cable_do_not_change_the_colour():
    box = crate()
    clean = color_of(box, [box], photograph([box], lit(ORANGE)), CAMERA).color
    picture = photograph([box], lit(ORANGE))
    top = box.world_from_object.apply([[0.0, 0.02, 0.12]])
    u, v = CAMERA.project(top)[0].round().astype(int)
    cv2.circle(picture, (int(u), int(v)), 9, (250, 252, 253), -1, cv2.LINE_AA)
    picture[:, u - 30 : u - 12] = (picture[:, u - 30 : u - 12] * 0.5).astype(np.uint8)
    cv2.line(picture, (150, 60), (400, 330), (160, 40, 20), 6, cv2.LINE_AA)
    sample = color_of(box, [box], noisy(picture), CAMERA)
    assert relative(sample.color, clean) < 0.03
    assert 0.6 < sample.share < 0.95


def test_up_to_half_may_be_another_colour_and_then_a_texture_is_the_answer():
    box = crate()

    def striped(thing, face, st):
        stripe = (st[:, 0] * 8 % 1.0 < 0.4)[:, None]
        return LIGHT.get(face, 1.0) * np.where(stripe, [0.05, 0.1, 0.6], ORANGE)

    sample = color_of(box, [box], noisy(photograph([box], striped)), CAMERA)
    assert relative(sample.color, ORANGE) < 0.04
    assert not sample.uniform
    assert 0.4 < sample.share < 0.75


def test_a_print_without_hue_is_a_print_too():
    box = crate()

    def inked(thing, face, st):
        ink = ((st * 9 % 1.0 < 0.5).sum(axis=1) == 1)[:, None]
        return LIGHT.get(face, 1.0) * np.where(ink, [[0.08] * 3], [[0.6] * 3])

    assert not color_of(box, [box], noisy(photograph([box], inked)), CAMERA).uniform


def test_what_stands_in_front_lends_no_colour():
    box = crate()
    towards = CAMERA.centre_world - box.world_from_object.translation
    front = type(box)(
        "front", Pose(np.eye(3), box.world_from_object.translation + 0.4 * towards),
        size=[0.12, 0.12, 0.2],
    )  # fmt: skip

    def paint(thing, face, st):
        return lit(np.array([0.02, 0.1, 0.7]) if thing is front else ORANGE)(thing, face, st)

    picture = photograph([box, front], paint)
    sample = color_of(box, [box, front], picture, CAMERA)
    assert sample.share > 0.99
    assert relative(sample.color, ORANGE) < 0.02
    hidden = np.ones(picture.shape[:2], dtype=bool)
    assert color_of(box, [box, front], picture, CAMERA, hidden=hidden).color is None


def test_jpeg_blocks_at_the_edges_are_kept_away_from():
    box = crate()
    picture = photograph([box], lit(ORANGE))
    _, data = cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, 60])
    decoded = cv2.imdecode(data, cv2.IMREAD_COLOR)
    near, far = (color_of(box, [box], decoded, CAMERA, jpeg=jpeg) for jpeg in (False, True))
    assert far.pixels < near.pixels
    assert far.share > near.share
    assert relative(far.color, ORANGE) < 0.03


def test_an_object_that_is_not_seen_or_hardly_says_so():
    box = crate()
    picture = photograph([box], lit(ORANGE))
    behind = type(box)("behind", Pose(np.eye(3), np.array([-9.0, 6, -5])), size=[0.1, 0.1, 0.1])
    sample = color_of(behind, [behind, box], picture, CAMERA)
    assert sample.color is None and sample.pixels == 0
    assert "behind: is not seen in the picture" in sample.warnings[0]
    speck = type(box)("speck", Pose(np.eye(3), np.array([0, 0, 0.1])), size=[0.012] * 3)
    small = color_of(speck, [speck], photograph([speck], lit(ORANGE)), CAMERA)
    assert small.color is not None
    assert "speck: its colour comes from" in small.warnings[0]


def test_an_overexposed_object_says_so():
    box = crate()
    sample = color_of(box, [box], photograph([box], lit(np.array([1.0, 1.0, 0.9]))), CAMERA)
    assert any("overexposed" in warning for warning in sample.warnings)


def test_a_picture_of_another_size_and_a_stranger_are_refused():
    box = crate()
    with pytest.raises(PictureError, match="480 x 360"):
        color_of(box, [box], np.zeros((10, 10, 3), np.uint8), CAMERA)
    with pytest.raises(InvalidValue, match="crate: is none of the 1 things"):
        color_of(box, [drum()], np.zeros((360, 480, 3), np.uint8), CAMERA)
