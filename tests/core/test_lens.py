# SPDX-License-Identifier: GPL-3.0-or-later
"""Projection and rays invert each other for every lens; derivatives and OpenCV agree."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from drawn import MODELS, differences, distortions, imaged_rays, lenses
from hypothesis import given, settings
from hypothesis import strategies as st
from monocell.core import Distortion, Intrinsics
from monocell.core.errors import InvalidValue

LAWS = settings(max_examples=30, deadline=None)
SEEDS = st.integers(0, 2**32 - 1)


@pytest.mark.parametrize("model", MODELS)
@LAWS
@given(data=st.data(), seed=SEEDS)
def test_rays_come_back_from_their_pixels(model, data, seed):
    lens = data.draw(lenses((model,)))
    rays = imaged_rays(lens, np.random.default_rng(seed))
    back = lens.rays(lens.project(rays))
    np.testing.assert_allclose(back, rays, atol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(back, axis=1), 1, atol=1e-12)


@pytest.mark.parametrize("model", MODELS)
@LAWS
@given(data=st.data(), seed=SEEDS)
def test_pixels_come_back_from_their_rays_wherever_the_lens_images_one(model, data, seed):
    lens = data.draw(lenses((model,)))
    size = [lens.width, lens.height]
    pixels = np.random.default_rng(seed).uniform(-0.5, 1, (60, 2)) * size
    rays = lens.rays(pixels)
    imaged = np.isfinite(rays).all(axis=1)
    assert np.isnan(rays[~imaged]).all()
    np.testing.assert_allclose(lens.project(rays[imaged]), pixels[imaged], atol=1e-6)


@pytest.mark.parametrize("model", MODELS)
@LAWS
@given(data=st.data(), seed=SEEDS)
def test_the_projection_s_derivative_is_its_slope(model, data, seed):
    lens = data.draw(lenses((model,)))
    points = imaged_rays(lens, np.random.default_rng(seed), 8, 0.9) * 1.7
    pixels, jacobian = lens.project_with_jacobian(points)
    np.testing.assert_array_equal(pixels, lens.project(points))
    for point, derivative in zip(points, jacobian, strict=True):
        slope = differences(lambda p: lens.project(p[None])[0], point, 1e-6)
        np.testing.assert_allclose(derivative, slope, atol=2e-5 * lens.fx, rtol=1e-5)
    # moving along its ray a point stays on its pixel
    np.testing.assert_allclose((jacobian @ points[:, :, None])[..., 0], 0, atol=1e-8 * lens.fx)


@pytest.mark.parametrize("model", MODELS)
@LAWS
@given(data=st.data(), seed=SEEDS)
def test_the_ray_s_derivative_is_its_slope(model, data, seed):
    lens = data.draw(lenses((model,)))
    pixels = lens.project(imaged_rays(lens, np.random.default_rng(seed), 6, 0.8))
    rays, jacobian = lens.rays_with_jacobian(pixels)
    for pixel, derivative in zip(pixels, jacobian, strict=True):
        slope = differences(lambda p: lens.rays(p[None])[0], pixel, 1e-3)
        np.testing.assert_allclose(derivative, slope, atol=1e-5 * np.abs(slope).max())
    np.testing.assert_allclose((rays[:, None] @ jacobian)[:, 0], 0, atol=1e-12)


@LAWS
@given(lenses(("plumb_bob", "rational_polynomial")), SEEDS)
def test_polynomial_lenses_project_as_opencv_does(lens, seed):
    points = imaged_rays(lens, np.random.default_rng(seed)) * 2.0
    theirs, _ = cv2.projectPoints(
        points, np.zeros(3), np.zeros(3), lens.matrix(), lens.distortion.coefficients
    )
    np.testing.assert_allclose(lens.project(points), theirs[:, 0], atol=1e-6)


@LAWS
@given(lenses(("equidistant",)), SEEDS)
def test_a_fisheye_projects_as_opencv_does(lens, seed):
    points = imaged_rays(lens, np.random.default_rng(seed)) * 2.0
    theirs, _ = cv2.fisheye.projectPoints(
        points[:, None], np.zeros(3), np.zeros(3), lens.matrix(), lens.distortion.coefficients
    )
    np.testing.assert_allclose(lens.project(points), theirs[:, 0], atol=1e-6)


def test_the_corner_of_a_wide_lens_is_exact_where_opencv_s_five_steps_are_half_a_pixel_off():
    coefficients = np.array([-0.28, 0.09, 0.0006, -0.0004, -0.01])
    lens = Intrinsics(
        1280, 960, 1200.0, 1195.0, 652.3, 471.8, Distortion("plumb_bob", coefficients)
    )
    corner = np.array([[0.0, 959.0]])
    np.testing.assert_allclose(lens.project(lens.rays(corner)), corner, atol=1e-9)
    plain = cv2.undistortPoints(corner[:, None], lens.matrix(), coefficients)[:, 0]
    theirs = lens.project(np.column_stack([plain, [1.0]]))
    assert np.linalg.norm(theirs - corner) > 0.01


@LAWS
@given(distortions())
def test_the_radial_curve_rises_up_to_its_limit_and_no_farther(distortion):
    profile = distortion._profile
    within = np.linspace(0, min(profile.limit, 8.0), 200)[:-1]
    assert (profile.slope(within) > 0).all()
    assert (np.diff(profile.distorted(within)) > 0).all()
    if np.isfinite(profile.limit):
        assert np.isnan(profile.distorted(np.array([1.01 * profile.limit]))).all()
    reached = profile.distorted(within)
    np.testing.assert_allclose(profile.undistorted(reached), within, atol=1e-7)


@pytest.mark.parametrize("model", ["plumb_bob", "equidistant"])
def test_past_the_fold_of_its_polynomial_a_lens_images_nothing_either_way(model):
    coefficients = {"plumb_bob": [-0.4, 0, 0, 0, 0], "equidistant": [-0.1, 0, 0, 0]}[model]
    lens = Intrinsics(1000, 1000, 300.0, 300.0, 500.0, 500.0, Distortion(model, coefficients))
    past = {"plumb_bob": [5.0, 0.0, 1.0], "equidistant": [1.0, 0.0, -1.0]}[model]
    assert np.isnan(lens.project(np.array([past]))).all()
    assert np.isnan(lens.rays(np.array([[999.0, 0.0]]))).all()
    assert np.isfinite(lens.rays(np.array([[510.0, 480.0]]))).all()


@pytest.mark.parametrize("model", ["none", "plumb_bob", "rational_polynomial"])
def test_what_is_behind_a_pinhole_is_not_imaged(model):
    lens = Intrinsics(640, 480, 500.0, 500.0, 320.0, 240.0, _mild(model))
    behind = np.array([[0.1, 0.1, -1.0], [0.1, 0.1, 0.0], [0.0, 0.0, -1.0]])
    assert np.isnan(lens.project(behind)).all()


def test_a_fisheye_images_what_is_beside_and_behind_it():
    lens = Intrinsics(
        2000, 2000, 300.0, 300.0, 1000.0, 1000.0, Distortion("equidistant", [0.0] * 4)
    )
    rays = np.array([[1.0, 0.0, 0.0], [0.8, 0.0, -0.6]])
    pixels = lens.project(rays)
    np.testing.assert_allclose(pixels[0], [1000 + 300 * np.pi / 2, 1000], atol=1e-9)
    np.testing.assert_allclose(lens.rays(pixels), rays, atol=1e-12)


@pytest.mark.parametrize("model", MODELS)
def test_nan_stays_nan_and_nothing_stays_nothing(model):
    lens = Intrinsics(640, 480, 500.0, 500.0, 320.0, 240.0, _mild(model))
    assert np.isnan(lens.rays(np.array([[np.nan, 3.0]]))).all()
    assert np.isnan(lens.project(np.array([[np.nan, 0.0, 1.0]]))).any()
    assert lens.rays(np.zeros((0, 2))).shape == (0, 3)
    assert lens.project(np.zeros((0, 3))).shape == (0, 2)


@pytest.mark.parametrize("model", MODELS)
def test_the_optical_axis_meets_the_principal_point(model):
    lens = Intrinsics(640, 480, 500.0, 510.0, 311.5, 250.25, _mild(model))
    np.testing.assert_allclose(lens.project(np.array([[0.0, 0.0, 2.0]])), [[311.5, 250.25]])
    np.testing.assert_allclose(lens.rays(np.array([[311.5, 250.25]])), [[0, 0, 1]], atol=1e-15)
    _, jacobian = lens.project_with_jacobian(np.array([[0.0, 0.0, 2.0]]))
    np.testing.assert_allclose(jacobian[0], [[250, 0, 0], [0, 255, 0]], atol=1e-9)


def test_the_centre_of_the_top_left_pixel_is_zero_and_the_picture_ends_half_a_pixel_out():
    lens = Intrinsics(640, 480, 500.0, 500.0, 320.0, 240.0)
    inside = lens.contains([[-0.5, -0.5], [639.5, 479.5], [-0.51, 0], [0, 479.51], [300, 200]])
    assert inside.tolist() == [True, True, False, False, True]


@pytest.mark.parametrize(
    ("changed", "told"),
    [
        ({"width": 0}, "width"),
        ({"height": 4.5}, "height"),
        ({"width": float("nan")}, "width"),
        ({"height": float("inf")}, "height"),
        ({"width": "wide"}, "width"),
        ({"fx": 0.0}, "fx"),
        ({"fy": -3.0}, "fy"),
        ({"fx": float("nan")}, "fx"),
        ({"cx": 5000.0}, "cx: 5000 is more than a whole picture"),
        ({"cy": -500.0}, "cy"),
        ({"cx": None}, "cx"),
    ],
)
def test_intrinsics_that_can_t_be_are_refused_by_name(changed, told):
    usual = {"width": 640, "height": 480, "fx": 500.0, "fy": 500.0, "cx": 320.0, "cy": 240.0}
    with pytest.raises(InvalidValue, match=told):
        Intrinsics(**(usual | changed))


@pytest.mark.parametrize(
    ("model", "coefficients", "told"),
    [
        ("brown", [], "none of none, plumb_bob"),
        ("plumb_bob", [0.1] * 4, "plumb_bob has 5, got 4"),
        ("none", [0.1], "none has 0, got 1"),
        ("equidistant", [0, 0, np.nan, 0], "not finite"),
        ("equidistant", [[0, 0, 0, 0]], "shape"),
    ],
)
def test_a_distortion_that_is_none_is_refused(model, coefficients, told):
    with pytest.raises(InvalidValue, match=told):
        Distortion(model, coefficients)


def _mild(model):
    count = {"none": 0, "plumb_bob": 5, "rational_polynomial": 8, "equidistant": 4}[model]
    return Distortion(model, np.full(count, 1e-3))
