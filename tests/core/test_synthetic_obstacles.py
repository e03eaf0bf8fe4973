# SPDX-License-Identifier: GPL-3.0-or-later
"""Bars, panels, shadows, boards and shaken cameras in synthetic pictures are what they say."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from monocell.core import Intrinsics
from monocell.core.picture.pictures import linear_light
from monocell.core.picture.synthetic import Ball, Bar, Photographer, photograph

LENS = Intrinsics(200, 160, 300.0, 300.0, 99.5, 79.5)
EVEN = Photographer(
    ambient=1.0, background=(0.0, 0.0), blur_pixels=0.0, noise_grey_levels=0.0, supersampling=8
)
BALL = Ball((0.0, 0.0, 1.0), 0.08, (1.0, 1.0, 1.0), 0.0)
WALL_GREEN = 0.95


def green(how, balls=()):
    return linear_light(photograph(LENS, balls, how))[..., 1].astype(float)


def centroid(light):
    v, u = np.mgrid[: light.shape[0], : light.shape[1]]
    return np.array([(light * u).sum(), (light * v).sum()]) / light.sum()


def test_a_bar_covers_its_length_times_its_width_and_two_half_discs():
    bar = Bar((40.3, 50.7), (120.1, 90.2), 11.0, (0.5, 0.5, 0.5))
    light = green(replace(EVEN, bars=(bar,))) / 0.5
    length = np.hypot(120.1 - 40.3, 90.2 - 50.7)
    assert light.sum() == pytest.approx(11.0 * length + np.pi * 5.5**2, rel=1e-2)
    np.testing.assert_allclose(centroid(light), [80.2, 70.45], atol=0.05)


def test_a_panel_lies_behind_the_ball_and_a_bar_before_it():
    panel = ((0.0, 0.0, 200.0, 160.0), (0.1, 0.3, 0.2))
    bar = Bar((99.5, 79.5), (99.5, 79.5), 9.0)
    light = green(replace(EVEN, panels=(panel,), bars=(bar,)), (BALL,))
    assert light[20, 20] == pytest.approx(0.3, abs=0.01)
    assert light[79, 99] == pytest.approx(0.04, abs=0.01)
    assert light[79, 112] == pytest.approx(1.0, abs=0.01)


def test_a_shaken_camera_spreads_the_light_and_does_not_move_it():
    still = green(EVEN, (BALL,))
    shaken = green(replace(EVEN, motion_pixels=(3.0, 1.5)), (BALL,))
    np.testing.assert_allclose(centroid(shaken), centroid(still), atol=0.02)
    assert shaken.sum() == pytest.approx(still.sum(), rel=3e-3)
    # an even way of length m has the variance m^2 / 12, bilinear steps add a little
    u = np.arange(LENS.width)
    spread = [((light * (u - 99.5) ** 2).sum() / light.sum()) for light in (still, shaken)]
    assert spread[1] - spread[0] == pytest.approx(3.0**2 / 12, abs=0.25)


def test_a_shadow_leaves_ambient_light_on_its_side_alone():
    lit = replace(EVEN, ambient=0.2, light=(0.0, 0.0, -1.0))
    shaded = replace(lit, shadow=(1.0, 0.0, 0.0, 0.0))
    light, shadow = green(lit, (BALL,)), green(shaded, (BALL,))
    assert shadow[79, 90] == pytest.approx(0.2, abs=0.01)
    np.testing.assert_array_equal(shadow[:, 105:], light[:, 105:])


def test_a_board_has_squares_of_two_kinds_of_light():
    light = green(replace(EVEN, background=(0.4, 0.4), checker_pixels=20.0))
    bright, dark = 0.4 * WALL_GREEN, 0.4 * WALL_GREEN * 0.3
    near = np.minimum(abs(light - bright), abs(light - dark))
    assert (near < 0.01).all()
    assert (light > 0.2).mean() == pytest.approx(0.5, abs=0.05)
