# SPDX-License-Identifier: GPL-3.0-or-later
"""A sphere's outline and its centre give each other back, through every lens."""

from __future__ import annotations

import numpy as np
import pytest
from drawn import MODELS, balls, differences
from hypothesis import given, settings
from hypothesis import strategies as st
from monocell.core import Distortion, Intrinsics
from monocell.core.ball.sphere import (
    OutlineRays,
    outline_pixels,
    outline_rays,
    sphere_at,
    sphere_from_rays,
    tangency,
)
from monocell.core.errors import InvalidValue, SphereNotFound

LAWS = settings(max_examples=40, deadline=None)
LENS = Intrinsics(
    1280,
    960,
    1200.0,
    1195.0,
    652.3,
    471.8,
    Distortion("plumb_bob", [-0.28, 0.09, 6e-4, -4e-4, -0.01]),
)
CENTRE = np.array([0.3, -0.2, 2.2])


@LAWS
@given(balls())
def test_the_centre_comes_back_from_the_outline_s_pixels(ball):
    lens, centre, radius = ball
    pixels = outline_pixels(lens, centre, radius, 60)
    rays = lens.rays(pixels)
    # w's excess over 1 is the square of the sphere's angular radius: its digits are the depth's
    tolerance = 1e-10 * (np.linalg.norm(centre) / radius) ** 2
    found = sphere_from_rays(rays, radius)
    assert np.linalg.norm(found - centre) < tolerance * np.linalg.norm(centre)


@LAWS
@given(balls(), st.integers(3, 40))
def test_rays_of_the_outline_touch_the_sphere(ball, count):
    _, centre, radius = ball
    rays = outline_rays(centre, radius, np.linspace(0, 6, count))
    nearest = (rays @ centre)[:, None] * rays
    np.testing.assert_allclose(np.linalg.norm(nearest - centre, axis=1), radius, rtol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(rays, axis=1), 1, atol=1e-12)


def test_the_outline_starts_on_the_right_and_goes_down():
    pixels = outline_pixels(LENS, [0, 0, 2.0], 0.1, 4)
    middle = pixels.mean(axis=0)
    right, below, left, above = pixels - middle
    assert right[0] > 50 > abs(right[1])
    assert below[1] > 50 > abs(below[0])
    assert left[0] < -50
    assert above[1] < -50


def test_three_rays_are_enough_and_a_third_of_the_outline_too():
    few = outline_rays(CENTRE, 0.04, [0.0, 2.0, 4.0])
    np.testing.assert_allclose(sphere_from_rays(few, 0.04), CENTRE, atol=1e-9)
    arc = outline_rays(CENTRE, 0.04, np.linspace(0.3, 2.4, 30))
    np.testing.assert_allclose(sphere_from_rays(arc, 0.04), CENTRE, atol=1e-6)


def test_a_ray_of_weight_zero_does_not_count():
    rays = outline_rays(CENTRE, 0.04, np.linspace(0, 6, 20))
    rays[3] = [0.0, 0.0, 1.0]
    weights = np.ones(20)
    weights[3] = 0
    np.testing.assert_allclose(sphere_from_rays(rays, 0.04, weights), CENTRE, atol=1e-9)
    assert np.linalg.norm(sphere_from_rays(rays, 0.04) - CENTRE) > 0.01


@pytest.mark.parametrize("count", [0, 1, 2])
def test_fewer_than_three_rays_make_no_sphere(count):
    with pytest.raises(SphereNotFound, match=f"three rays of its outline, got {count}"):
        sphere_from_rays(np.tile([0.0, 0.0, 1.0], (count, 1)), 0.04)


def test_one_ray_three_times_is_no_outline():
    with pytest.raises(SphereNotFound, match="no outline of a ball"):
        sphere_from_rays(np.tile([0.0, 0.6, 0.8], (3, 1)), 0.04)


def test_a_camera_inside_the_ball_sees_no_outline():
    with pytest.raises(SphereNotFound, match=r"inside the ball: 0\.03 m from its centre"):
        outline_rays([0, 0, 0.03], 0.04, [0.0])


@LAWS
@given(balls())
def test_points_of_the_outline_have_no_residual_and_normals_outwards(ball):
    lens, centre, radius = ball
    pixels = outline_pixels(lens, centre, radius, 24)
    held = tangency(OutlineRays.of(lens, pixels), centre, radius)
    np.testing.assert_allclose(held.residual_pixels, 0, atol=1e-6)
    np.testing.assert_allclose(np.linalg.norm(held.normals, axis=1), 1, atol=1e-9)
    outwards = pixels - lens.project(centre[None])
    assert ((held.normals * outwards).sum(axis=1) > 0).all()


@LAWS
@given(balls(), st.floats(-0.3, 0.3))
def test_the_residual_is_the_distance_along_the_normal(ball, off):
    lens, centre, radius = ball
    pixels = outline_pixels(lens, centre, radius, 24)
    normals = tangency(OutlineRays.of(lens, pixels), centre, radius).normals
    moved = tangency(OutlineRays.of(lens, pixels + off * normals), centre, radius)
    # to first order in the residual: a part of it that is as large as it is to the outline
    size = np.linalg.norm(pixels - pixels.mean(axis=0), axis=1).min()
    np.testing.assert_allclose(moved.residual_pixels, off, atol=1e-6 + off * off / size)


@pytest.mark.parametrize("model", MODELS)
def test_the_tangency_s_derivatives_are_its_slopes(model):
    coefficients = {
        "none": [],
        "plumb_bob": [-0.28, 0.09, 6e-4, -4e-4, -0.01],
        "rational_polynomial": [0.3, -0.2, 5e-4, -3e-4, 0.02, 0.5, -0.1, 0.01],
        "equidistant": [-0.02, 0.004, -0.001, 2e-4],
    }[model]
    lens = Intrinsics(1280, 960, 1200.0, 1195.0, 652.3, 471.8, Distortion(model, coefficients))
    rng = np.random.default_rng(3)
    pixels = outline_pixels(lens, CENTRE, 0.04, 30) + rng.normal(0, 1e-4, (30, 2))
    outline = OutlineRays.of(lens, pixels)
    held = tangency(outline, CENTRE, 0.04)
    by_centre = differences(lambda c: tangency(outline, c, 0.04).residual_pixels, CENTRE, 1e-6)
    by_radius = differences(
        lambda r: tangency(outline, CENTRE, r[0]).residual_pixels, np.array([0.04]), 1e-6
    )
    np.testing.assert_allclose(held.by_centre, by_centre, atol=2e-3, rtol=1e-5)
    np.testing.assert_allclose(held.by_radius, by_radius[:, 0], atol=2e-3, rtol=1e-5)


@LAWS
@given(balls())
def test_a_sphere_of_a_size_around_a_pixel_is_about_the_true_one(ball):
    lens, centre, radius = ball
    pixels = outline_pixels(lens, centre, radius, 40)
    middle = lens.project(centre[None])[0]
    size = float(np.linalg.norm(pixels - middle, axis=1).mean())
    rough = sphere_at(lens, middle, size, radius)
    axis = centre / np.linalg.norm(centre)
    np.testing.assert_allclose(rough / np.linalg.norm(rough), axis, atol=1e-7)
    # a strong lens stretches the far side of a large ball
    assert 0.4 < np.linalg.norm(rough) / np.linalg.norm(centre) < 2.0


def test_no_sphere_stands_where_the_lens_images_nothing():
    folded = Intrinsics(
        1000, 1000, 300.0, 300.0, 500.0, 500.0, Distortion("plumb_bob", [-0.4, 0, 0, 0, 0])
    )
    with pytest.raises(SphereNotFound, match=r"no ray at pixel \[999.0, 0.0\]"):
        sphere_at(folded, [999, 0], 20, 0.04)
    with pytest.raises(InvalidValue, match="radius_pixels"):
        sphere_at(LENS, [600, 400], 0, 0.04)


@pytest.mark.filterwarnings("error")
def test_an_outline_that_leaves_the_field_of_the_lens_is_nan_there():
    folded = Intrinsics(
        1000, 1000, 300.0, 300.0, 500.0, 500.0, Distortion("plumb_bob", [-0.4, 0, 0, 0, 0])
    )
    pixels = outline_pixels(folded, [0.9, 0.0, 1.0], 0.3, 60)
    lost = np.isnan(pixels).any(axis=1)
    assert 5 < lost.sum() < 55
