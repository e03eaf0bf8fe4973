# SPDX-License-Identifier: GPL-3.0-or-later
"""The pose of all outlines: exact on exact ones, and as uncertain as it states on noisy ones."""

from __future__ import annotations

import numpy as np
import pytest
from ball_rig import (
    LENS,
    PLACES,
    POSE,
    RADIUS,
    OutlineNoise,
    exact_outlines,
    pose_twist,
    sigmas_off,
)
from monocell.core.ball.sphere import OutlineRays, tangency
from monocell.core.calibration.joint_pose import BIAS_SIGMA_PIXELS, fit_pose
from monocell.core.calibration.observation import OutlineObservation, Place
from monocell.core.errors import DegeneratePositions
from monocell.core.pose import point_jacobian

# a start as three rough centres give it
START = POSE.perturbed([0.01, -0.02, 0.01, 0.02, -0.01, 0.03])
NOISE = 0.2
TRIALS = 60


def test_exact_outlines_give_the_exact_pose():
    fit = fit_pose(exact_outlines(PLACES), START)
    np.testing.assert_allclose(pose_twist(fit.camera_from_base), 0, atol=1e-8)
    assert abs(fit.edge_bias_pixels) < 1e-6
    assert fit.misfit == 1.0


def test_three_balls_are_enough():
    fit = fit_pose(exact_outlines(PLACES[:3]), START)
    np.testing.assert_allclose(pose_twist(fit.camera_from_base), 0, atol=1e-7)


def test_half_the_outlines_are_enough():
    observations = [
        OutlineObservation(
            o.outline.chosen(np.arange(80) < 40), o.sigma_pixels[:40], o.place, RADIUS
        )
        for o in exact_outlines(PLACES)
    ]
    fit = fit_pose(observations, START)
    np.testing.assert_allclose(pose_twist(fit.camera_from_base), 0, atol=1e-7)


@pytest.mark.parametrize("bias", [-0.06, 0.04])
def test_an_edge_bias_that_all_outlines_share_is_found_and_kept_out_of_the_pose(bias):
    fit = fit_pose(exact_outlines(PLACES, OutlineNoise(bias=bias)), START)
    assert fit.edge_bias_pixels == pytest.approx(bias, abs=0.01)
    assert fit.edge_bias_sigma_pixels < BIAS_SIGMA_PIXELS
    assert sigmas_off(pose_twist(fit.camera_from_base), fit.covariance) < 1.0


def test_stray_points_are_outvoted():
    rng = np.random.default_rng(2)
    observations = exact_outlines(PLACES, OutlineNoise(0.1), rng)
    for observation in observations:
        stray = rng.choice(80, 12, replace=False)
        moved = observation.outline.pixels.copy()
        moved[stray] += rng.uniform(2, 4, (12, 1)) * [1, 0.5]
        spoilt = OutlineRays.of(LENS, moved)
        for name in ("pixels", "rays", "rays_by_pixel"):
            object.__setattr__(observation.outline, name, getattr(spoilt, name))
    fit = fit_pose(observations, START)
    assert sigmas_off(pose_twist(fit.camera_from_base), fit.covariance) < 6


def test_balls_in_one_place_leave_the_pose_open():
    with pytest.raises(DegeneratePositions, match="leave a direction of the pose undetermined"):
        fit_pose(exact_outlines(PLACES[[0, 0, 0]]), POSE)


@pytest.fixture(scope="module")
def trials():
    """Fits of one rig under outline noise of known sigma."""
    rng = np.random.default_rng(11)
    return [
        fit_pose(exact_outlines(PLACES, OutlineNoise(NOISE), rng), START) for _ in range(TRIALS)
    ]


def test_the_errors_of_many_fits_are_no_larger_than_they_state(trials):
    errors = np.array([pose_twist(fit.camera_from_base) for fit in trials])
    stated = np.mean([fit.covariance for fit in trials], axis=0)
    ratio = np.sqrt((errors**2).mean(axis=0) / np.diag(stated))
    # what outlines have in common is stated too, and is not in this noise: careful, not wild
    assert (ratio < 1.25).all()
    assert (ratio > 0.3).all()
    squares = [sigmas_off(e, f.covariance) ** 2 for e, f in zip(errors, trials, strict=True)]
    assert np.mean(squares) < 6 * 1.4
    assert np.mean(squares) > 6 * 0.15


def test_the_errors_of_many_fits_reach_the_cramer_rao_bound(trials):
    errors = np.array([pose_twist(fit.camera_from_base) for fit in trials])
    information = np.zeros((7, 7))
    information[6, 6] = 1 / BIAS_SIGMA_PIXELS**2
    for observation in exact_outlines(PLACES):
        centre = POSE.apply(observation.place.offset)
        held = tangency(observation.outline, centre, RADIUS)
        rows = np.hstack([held.by_centre @ point_jacobian(centre), -np.ones((80, 1))])
        information += rows.T @ rows / NOISE**2
    # the bias is truly zero in every trial, which only lowers the error: an exact prior's bound
    bound = np.linalg.inv(information[:6, :6])
    free = np.linalg.inv(information)[:6, :6]
    mean_square = errors.T @ errors / TRIALS
    scale = np.sqrt(np.diag(free))
    over_exact = np.sqrt(np.trace(np.linalg.solve(bound, mean_square)) / 6)
    over_free = np.sqrt(np.trace(np.linalg.solve(free, mean_square)) / 6)
    assert 0.8 < over_free < 1.2, over_free
    assert over_exact > 0.85
    assert (np.sqrt(np.diag(mean_square)) < 1.3 * scale).all()


def test_the_noise_left_is_the_noise_put_in(trials):
    left = np.concatenate([np.concatenate(fit.residuals_pixels) for fit in trials])
    assert left.std() == pytest.approx(NOISE, rel=0.05)
    misfits = [fit.misfit for fit in trials]
    assert np.median(misfits) < 1.3


def test_balls_that_are_not_where_the_robot_says_show_in_the_misfit():
    rng = np.random.default_rng(4)
    observations = exact_outlines(PLACES, OutlineNoise(0.05), rng)
    moved = [
        OutlineObservation(
            o.outline, o.sigma_pixels, Place(o.place.offset + rng.normal(0, 2e-3, 3)), RADIUS
        )
        for o in observations
    ]
    fit, honest = fit_pose(moved, START), fit_pose(observations, START)
    assert fit.misfit > 4 > honest.misfit
    assert (np.diag(fit.covariance) > 9 * np.diag(honest.covariance)).all()
