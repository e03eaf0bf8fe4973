# SPDX-License-Identifier: GPL-3.0-or-later
"""The 95 % ellipsoid holds the truth in 95 % of the cases, also where few sightings tell."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from ball_rig import PLACES, POSE, OutlineNoise, exact_outlines
from hypothesis import given
from hypothesis import strategies as st
from monocell.core import Camera
from monocell.core.calibration.ellipsoid import (
    ellipsoid,
    pose_error,
    reach_95,
    three_f_quantile,
    three_f_tail,
)
from monocell.core.calibration.joint_pose import fit_pose
from monocell.core.calibration.observation import Place


# Fisher's F(3, n) at 95 %, from printed tables
@pytest.mark.parametrize(
    ("freedom", "f"), [(1, 215.7), (2, 19.16), (5, 5.41), (8, 4.07), (17, 3.20), (120, 2.68)]
)
def test_the_quantiles_are_those_of_printed_tables(freedom, f):
    assert three_f_quantile(freedom) / 3 == pytest.approx(f, rel=2e-3)


def test_with_many_degrees_of_freedom_the_quantile_is_chi_squared_s():
    assert three_f_quantile(1e6) == pytest.approx(7.8147, abs=1e-3)
    assert three_f_quantile(9e4) == pytest.approx(7.8147, abs=1e-2)


@given(st.floats(1, 1e5), st.floats(0.01, 0.999))
def test_the_tail_beyond_a_quantile_is_what_is_left(freedom, share):
    assert three_f_tail(three_f_quantile(freedom, share), freedom) == pytest.approx(
        1 - share, abs=1e-6
    )


@given(st.integers(0, 2**32 - 1), st.floats(0.1, 30))
def test_the_ends_of_the_axes_lie_as_many_sigmas_away_as_it_reaches(seed, reach):
    root = np.random.default_rng(seed).normal(size=(3, 3)) * [1, 1e-2, 1e-3]
    covariance = root @ root.T
    shape = ellipsoid(covariance, reach)
    assert (np.diff(shape.semi_axes) <= 0).all()
    np.testing.assert_allclose(shape.directions @ shape.directions.T, np.eye(3), atol=1e-9)
    along = np.einsum("ki,ij,kj->k", shape.directions, covariance, shape.directions)
    # a nearly flat ellipsoid keeps half the digits of its longest axis
    digits = 1e-6 * shape.semi_axes[0]
    lengths = reach * np.sqrt(np.maximum(along, 0))
    np.testing.assert_allclose(lengths, shape.semi_axes, rtol=1e-4, atol=digits)


@pytest.mark.parametrize("freedom", [2, 5, 8, 17, 53])
@pytest.mark.parametrize("scale", [0.7, 1.0, 1.5, 4.0])
def test_the_truth_lies_inside_whatever_the_scale_of_the_noise_is(freedom, scale):
    """Errors and misfits drawn as they are distributed; the stated sigma carries the misfit."""
    rng = np.random.default_rng(1)
    inside = 0
    for square, pull in zip(
        scale**2 * rng.chisquare(3, 3000), scale**2 * rng.chisquare(freedom, 3000), strict=True
    ):
        misfit = np.sqrt(max(1.0, pull / freedom))
        balls = (freedom + 7) // 3
        fit = SimpleNamespace(
            asked=SimpleNamespace(freedom=freedom),
            says=[SimpleNamespace(pull=pull / balls)] * balls,
            unknowns=range(7),
            misfit=misfit,
            place_sigma=0.0,
            disagreement=misfit,
        )
        inside += square <= (reach_95(fit) * misfit) ** 2
    assert inside / 3000 > 0.94


@pytest.mark.parametrize(("balls", "least"), [(4, 0.8), (6, 0.85)])
def test_the_truth_lies_inside_where_the_robot_is_off_by_more_than_the_outlines(balls, least):
    """A robot's error moves whole balls, which the outlines' own noise knows nothing of."""
    rng = np.random.default_rng(7)
    inside = alone = 0
    for _ in range(80):
        observations = [
            replace(o, place=Place(o.place.offset + rng.normal(0, 5e-4, 3)))
            for o in exact_outlines(PLACES[:balls], OutlineNoise(0.2), rng)
        ]
        fit = fit_pose(observations, POSE)
        camera = Camera(None, fit.camera_from_base, fit.covariance)
        error = pose_error(camera, fit)
        off = error.position.directions @ (camera.centre_world - POSE.inverse().translation)
        far = np.linalg.norm(off / error.position.semi_axes)
        inside, alone = inside + (far < 1), alone + (far * error.reach < np.sqrt(7.8147))
    assert inside / 80 > least
    # what a plain chi-squared ellipsoid would hold
    assert alone < inside


def test_the_error_of_a_fit_is_told_along_the_world_and_about_the_camera():
    fit = fit_pose(exact_outlines(PLACES, OutlineNoise(0.2), np.random.default_rng(5)), POSE)
    camera = Camera(None, fit.camera_from_base, fit.covariance)
    error = pose_error(camera, fit)
    assert error.freedom == 3 * len(PLACES) - 7
    assert error.reach >= np.sqrt(7.8147) / fit.misfit
    draws = np.random.default_rng(6).multivariate_normal(np.zeros(6), fit.covariance, 4000)
    # where the optical centre goes when the pose is drawn from its covariance
    centres = np.array([camera.pose.perturbed(d).inverse().translation for d in draws])
    spread = centres - camera.centre_world
    np.testing.assert_allclose(spread.std(axis=0), error.position_sigma, rtol=0.07)
    assert np.sqrt((spread**2).sum(axis=1).mean()) == pytest.approx(error.position_total, rel=0.07)
    along = (spread @ error.position.directions.T) / error.position.semi_axes * error.reach
    np.testing.assert_allclose(along.std(axis=0), 1, rtol=0.07)


def test_a_baseline_states_no_error():
    fit = fit_pose(exact_outlines(PLACES), POSE)
    assert pose_error(Camera(None, POSE), fit) is None
