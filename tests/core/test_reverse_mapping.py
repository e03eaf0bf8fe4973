# SPDX-License-Identifier: GPL-3.0-or-later
"""Reverse mapping undoes projection for every lens, and states its own error."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from monocell.core import (
    Camera,
    Distortion,
    Intrinsics,
    Pose,
    ReferenceLine,
    ReferencePlane,
)
from monocell.core.errors import InvalidValue, PickError
from monocell.core.modelling.mapped_covariance import (
    point_covariance_on_line,
    point_covariance_on_plane,
)
from monocell.core.modelling.reverse_mapping import (
    grazing_warnings,
    point_derivatives_on_line,
    point_derivatives_on_plane,
    points_on_line,
    points_on_plane,
    points_on_plane_or_nan,
)

LENSES = {
    "none": (),
    "plumb_bob": (-0.28, 0.09, 0.0006, -0.0004, -0.01),
    "rational_polynomial": (0.3, -0.2, 0.0005, -0.0003, 0.02, 0.5, -0.1, 0.01),
    "equidistant": (-0.02, 0.004, -0.001, 0.0002),
}
FLOOR = ReferencePlane("floor", np.zeros(3), np.array([0.0, 0.0, 1.0]))
WALL = ReferencePlane("wall", np.array([-0.4, 0.1, 0.0]), np.array([1.0, -0.3, 0.1]))
EDGE = ReferenceLine("edge", np.array([0.1, -0.2, 0.05]), np.array([0.4, 1.0, 0.2]))
POSE = Pose.looking_at([1.2, -1.0, 1.1], [0.0, 0.0, 0.1], [0.0, 0.0, 1.0])
TWIST_COVARIANCE = np.diag([1e-6, 2e-6, 3e-6, 4e-6, 5e-6, 6e-6]) + 5e-7


def camera(model: str, pose: Pose = POSE, covariance: object = None) -> Camera:
    lens = Distortion(model, np.array(LENSES[model]))
    return Camera(Intrinsics(1280, 960, 1000.0, 990.0, 650.3, 470.8, lens), pose, covariance)


lenses = pytest.mark.parametrize("model", LENSES)


@lenses
@settings(max_examples=60, deadline=None)
@given(x=st.floats(-0.5, 0.5), y=st.floats(-0.5, 0.5), tilt=st.floats(-0.6, 0.6))
def test_a_point_of_a_plane_comes_back_from_its_pixel(model, x, y, tilt):
    plane = ReferencePlane("ramp", [0.1, 0.0, 0.05], [np.sin(tilt), 0.1, np.cos(tilt)])
    point = plane.world_from_plane.apply([[x, y, 0.0]])
    cam = camera(model)
    np.testing.assert_allclose(points_on_plane(cam, plane, cam.project(point)), point, atol=1e-11)


@lenses
@settings(max_examples=60, deadline=None)
@given(along=st.floats(-0.4, 0.6))
def test_a_point_of_a_line_comes_back_from_its_pixel(model, along):
    point = EDGE.point + along * EDGE.direction[None]
    cam = camera(model)
    np.testing.assert_allclose(points_on_line(cam, EDGE, cam.project(point)), point, atol=1e-11)


@lenses
@settings(max_examples=60, deadline=None)
@given(u=st.floats(-0.5, 1279.5), v=st.floats(-0.5, 959.5))
def test_a_mapped_pixel_projects_onto_itself(model, u, v):
    cam = camera(model)
    points = points_on_plane_or_nan(cam, FLOOR, [[u, v]])
    np.testing.assert_allclose(cam.project(points), [[u, v]], atol=1e-9)


@lenses
def test_a_million_pixels_map_as_exactly_as_one(model):
    cam = camera(model)
    pixels = np.random.default_rng(1).uniform([0, 0], [1279, 959], (50_000, 2))
    np.testing.assert_allclose(cam.project(points_on_plane(cam, FLOOR, pixels)), pixels, atol=1e-9)


@lenses
@pytest.mark.parametrize("plane", [FLOOR, WALL], ids=lambda p: p.name)
def test_derivatives_on_a_plane_match_differences(model, plane):
    pixels = np.array([[300.0, 500.0], [700.0, 400.0], [900.0, 800.0]])
    by_pixel, by_twist = point_derivatives_on_plane(camera(model), plane, pixels)
    _check_derivatives(points_on_plane, model, plane, pixels, by_pixel, by_twist)


@lenses
def test_derivatives_on_a_line_match_differences_even_beside_it(model):
    pixels = camera(model).project(EDGE.point + np.outer([-0.2, 0.1, 0.3], EDGE.direction))
    pixels += [[3.0, -8.0], [40.0, 25.0], [0.0, 0.0]]
    by_pixel, by_twist = point_derivatives_on_line(camera(model), EDGE, pixels)
    _check_derivatives(points_on_line, model, EDGE, pixels, by_pixel, by_twist)


def _check_derivatives(mapped, model, reference, pixels, by_pixel, by_twist):
    step = 1e-3
    for i in range(2):
        moved = np.eye(2)[i] * step
        ahead = mapped(camera(model), reference, pixels + moved)
        behind = mapped(camera(model), reference, pixels - moved)
        np.testing.assert_allclose(by_pixel[..., i], (ahead - behind) / (2 * step), atol=1e-8)
    step = 1e-5
    for i in range(6):
        twist = np.eye(6)[i] * step
        ahead = mapped(camera(model, POSE.perturbed(twist)), reference, pixels)
        behind = mapped(camera(model, POSE.perturbed(-twist)), reference, pixels)
        np.testing.assert_allclose(by_twist[..., i], (ahead - behind) / (2 * step), atol=1e-7)


@pytest.mark.parametrize("reference", [FLOOR, EDGE], ids=lambda r: r.name)
def test_covariance_matches_a_thousand_draws(reference):
    rng = np.random.default_rng(3)
    on_plane = isinstance(reference, ReferencePlane)
    mapped = points_on_plane if on_plane else points_on_line
    stated = point_covariance_on_plane if on_plane else point_covariance_on_line
    cam = camera("plumb_bob", covariance=TWIST_COVARIANCE)
    pixel = cam.project([[0.15, -0.075, 0.075]] if not on_plane else [[0.2, 0.1, 0.0]])
    twists = rng.multivariate_normal(np.zeros(6), TWIST_COVARIANCE, 1000)
    picks = pixel + rng.normal(0, 0.7, (1000, 2))
    draws = np.array(
        [
            mapped(camera("plumb_bob", POSE.perturbed(t)), reference, p[None])[0]
            for t, p in zip(twists, picks, strict=True)
        ]
    )
    expected = stated(cam, reference, pixel, 0.7)[0]
    scale = np.trace(expected)
    np.testing.assert_allclose(np.cov(draws.T), expected, atol=0.12 * scale)


def test_without_a_camera_covariance_only_the_pick_counts():
    pixels = [[640.0, 480.0]]
    one = point_covariance_on_plane(camera("none"), FLOOR, pixels, 1.0)
    two = point_covariance_on_plane(camera("none"), FLOOR, pixels, 2.0)
    both = point_covariance_on_plane(
        camera("none", covariance=TWIST_COVARIANCE), FLOOR, pixels, 1.0
    )
    np.testing.assert_allclose(two, 4 * one)
    assert np.trace(both[0]) > np.trace(one[0])


def test_a_pixel_above_the_horizon_is_refused_with_its_distance_from_it():
    # a level camera: the horizon is the row of the principal point
    level = Pose.looking_at([0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 0.0, 1.0])
    with pytest.raises(PickError, match=r"corner at \(640\.0, 458\.5\) lies 12\.3 px \(0\.7 deg"):
        points_on_plane(camera("none", level), FLOOR, [[640.0, 458.5]], ["corner"])


def test_the_first_bad_pixel_of_many_is_named():
    level = Pose.looking_at([0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 0.0, 1.0])
    with pytest.raises(PickError, match="pixel 1 at"):
        points_on_plane(camera("none", level), FLOOR, [[640.0, 700.0], [640.0, 100.0]])


def test_the_bulk_form_gives_nan_above_the_horizon_and_points_below():
    level = Pose.looking_at([0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 0.0, 1.0])
    points = points_on_plane_or_nan(camera("none", level), FLOOR, [[640.0, 100.0], [640.0, 700.0]])
    assert np.isnan(points[0]).all()
    assert np.isfinite(points[1]).all()


@pytest.mark.parametrize(
    "lens", [("plumb_bob", (-0.5, 0, 0, 0, 0)), ("equidistant", (-0.1, 0, 0, 0))]
)
def test_every_ray_up_to_the_fold_of_the_lens_comes_back(lens):
    distortion = Distortion(lens[0], np.array(lens[1], dtype=float))
    inner = Intrinsics(2000, 2000, 1000.0, 1000.0, 1000.0, 1000.0, distortion)
    # the fold is where r - 0.5 r^3 or angle - 0.1 angle^3 stops rising
    fold = np.arctan(np.sqrt(2 / 3)) if lens[0] == "plumb_bob" else np.sqrt(10 / 3)
    rng = np.random.default_rng(4)
    angle, around = fold * np.sqrt(rng.uniform(0, 1, 20_000)), rng.uniform(0, 7, 20_000)
    rays = np.stack([np.cos(around), np.sin(around), 0 * around], 1) * np.sin(angle)[:, None]
    rays[:, 2] = np.cos(angle)
    back = inner.rays(inner.project(rays))
    # at the fold itself a pixel moves with the square of the ray, which costs half the digits
    np.testing.assert_allclose(back, rays, atol=1e-7)


def test_a_pixel_that_the_lens_does_not_image_is_refused():
    lens = Distortion("plumb_bob", np.array([-0.5, 0.0, 0.0, 0.0, 0.0]))
    cam = Camera(Intrinsics(1280, 960, 700.0, 700.0, 640.0, 480.0, lens), POSE)
    with pytest.raises(PickError, match="past the edge of what this lens images"):
        points_on_plane(cam, FLOOR, [[1275.0, 955.0]])


def test_a_camera_in_the_plane_itself_is_refused():
    flat = Pose.looking_at([1.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 1.0])
    with pytest.raises(PickError, match="lies in floor itself"):
        points_on_plane(camera("none", flat), FLOOR, [[640.0, 700.0]])


def test_a_grazing_ray_is_warned_of_with_its_angle():
    level = Pose.looking_at([0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 0.0, 1.0])
    row = 470.8 + 990.0 * np.tan(np.radians(1.2))
    (warning,) = grazing_warnings(camera("none", level), FLOOR, [[650.3, row], [650.3, 900.0]])
    assert "pixel 0" in warning
    assert "1.20 degrees" in warning


def test_a_pixel_nearest_to_the_line_behind_the_camera_is_refused():
    behind = ReferenceLine("behind", POSE.inverse().apply([0.0, 0.0, -1.0]), POSE.rotation[0])
    with pytest.raises(PickError, match="behind the camera"):
        points_on_line(camera("none"), behind, [[650.3, 470.8]])


def test_a_ray_along_the_line_is_refused():
    origin, rays = camera("none").rays_world([[700.0, 300.0]])
    away = ReferenceLine("away", np.add(origin, [0.0, 0.0, 0.5]), rays[0])
    with pytest.raises(PickError, match="looks along away"):
        points_on_line(camera("none"), away, [[700.0, 300.0]])


@pytest.mark.parametrize("pixels", [[1.0, 2.0], [[1.0, 2.0, 3.0]], [[np.nan, 2.0]]])
def test_pixels_of_a_wrong_shape_or_not_finite_are_refused(pixels):
    with pytest.raises(InvalidValue):
        points_on_plane(camera("none"), FLOOR, pixels)


def test_a_plane_has_a_right_handed_frame_with_its_normal_as_z():
    for plane in (FLOOR, WALL, ReferencePlane("ceiling", [0, 0, 2], [0, 0, -1])):
        frame = plane.world_from_plane
        assert np.linalg.det(frame.rotation) == pytest.approx(1.0)
        np.testing.assert_allclose(frame.rotation[:, 2], plane.normal, atol=1e-12)
        np.testing.assert_allclose(frame.translation, plane.point)
