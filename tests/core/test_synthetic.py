# SPDX-License-Identifier: GPL-3.0-or-later
"""The synthetic pictures are what they say, and the limb is found on profiles of known making."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from monocell.core import Distortion, Intrinsics
from monocell.core.ball.limb import Reach, find_limb
from monocell.core.ball.sphere import outline_pixels
from monocell.core.picture.pictures import linear_light
from monocell.core.picture.synthetic import Ball, Photographer, photograph

LENS = Intrinsics(
    240, 180, 300.0, 299.0, 121.3, 88.2, Distortion("plumb_bob", [-0.2, 0.06, 4e-4, -3e-4, 0.0])
)
# a ball that shines evenly before black: its light is its area
FLAT = Photographer(
    ambient=1.0, background=(0.0, 0.0), blur_pixels=0.0, noise_grey_levels=0.0, supersampling=8
)
BALL = Ball((0.15, -0.1, 1.0), 0.08, (1.0, 1.0, 1.0), 0.0)


def polygon(pixels):
    """Area and centroid of a closed polygon (N, 2)."""
    ahead = np.roll(pixels, -1, axis=0)
    cross = pixels[:, 0] * ahead[:, 1] - ahead[:, 0] * pixels[:, 1]
    area = cross.sum() / 2
    return area, ((pixels + ahead) * cross[:, None]).sum(axis=0) / (6 * area)


def test_a_ball_covers_the_pixels_inside_its_outline():
    light = linear_light(photograph(LENS, (BALL,), FLAT))[..., 1].astype(float)
    area, centroid = polygon(outline_pixels(LENS, BALL.centre_camera, BALL.radius, 2000))
    assert light.sum() == pytest.approx(area, rel=2e-3)
    v, u = np.mgrid[: LENS.height, : LENS.width]
    seen = [(light * u).sum() / light.sum(), (light * v).sum() / light.sum()]
    np.testing.assert_allclose(seen, centroid, atol=0.01)


def test_the_same_seed_gives_the_same_picture_and_another_seed_other_noise():
    one, two = photograph(LENS, (BALL,)), photograph(LENS, (BALL,))
    np.testing.assert_array_equal(one, two)
    assert (one != photograph(LENS, (BALL,), Photographer(seed=1))).any()


def test_the_noise_is_as_large_as_asked_for():
    noisy = photograph(LENS, (), Photographer(background=(0.2, 0.2), noise_grey_levels=3.0))
    assert noisy[..., 0].std() == pytest.approx(3.0, rel=0.05)


def test_what_is_hidden_is_dark_and_what_is_out_of_sight_leaves_no_trace():
    hidden = photograph(LENS, (BALL,), replace(FLAT, hidden=((0, 0, 240, 180),)))
    assert hidden.max() < 60
    outside = photograph(LENS, (Ball((3.0, 0.0, 1.0), 0.05),), FLAT)
    assert outside.max() == 0


def test_jpeg_changes_a_picture_a_little():
    plain = photograph(LENS, (BALL,))
    pressed = photograph(LENS, (BALL,), Photographer(jpeg_quality=80))
    difference = np.abs(plain.astype(int) - pressed.astype(int))
    assert 0.1 < difference.mean() < 6


def profile(offsets, edge, radius, blur, ball=(0.3, 0.5), wall=(0.1, 0.004)):
    """Light across a limb, made by brute force: fine steps, blurred by summing."""
    fine = np.arange(-20, 20, 0.01)
    depth = np.clip((edge - fine) / radius, 0, 1)
    facing = np.sqrt(depth * (2 - depth))
    light = np.where(fine < edge, ball[0] + ball[1] * facing, wall[0] + wall[1] * fine)
    weights = np.exp(-0.5 * ((fine - offsets[:, None]) / blur) ** 2)
    return (weights * light).sum(axis=1) / weights.sum(axis=1)


@pytest.mark.parametrize(
    "ball", [(0.3, 0.5), (0.02, 0.7), (0.6, -0.4)], ids=["matt", "dark limb", "glowing"]
)
@pytest.mark.parametrize("radius", [12.0, 60.0])
def test_the_limb_is_found_where_it_is_and_not_where_the_light_changes_most(ball, radius):
    reach = Reach(5.0, 5.0)
    offsets = reach.offsets()
    edges = np.array([-1.3, -0.4, 0.0, 0.31, 1.7])
    profiles = np.stack([profile(offsets, e, radius, 0.8, ball) for e in edges])[:, :, None]
    found = find_limb(profiles, reach, 2.5, 0.8, radius)
    np.testing.assert_allclose(found.offsets_pixels[0], edges, atol=0.06)
    assert (found.flat_misfits > 10 * found.misfits[0]).all()


def test_the_limb_s_stated_curvature_is_that_of_its_scatter():
    rng = np.random.default_rng(0)
    reach = Reach(5.0, 5.0)
    offsets = reach.offsets()
    clean = profile(offsets, 0.2, 30.0, 0.8)
    noise = 0.01
    noisy = clean + rng.normal(0, noise, (600, len(offsets)))
    found = find_limb(noisy[:, :, None], reach, 2.0, 0.8, 30.0, 0.03)
    stated = np.sqrt(2 * noise**2 / found.curvatures[0])
    assert found.offsets_pixels[0].std() == pytest.approx(np.median(stated), rel=0.35)
