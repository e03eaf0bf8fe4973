# SPDX-License-Identifier: GPL-3.0-or-later
"""What leaving a sighting out would do, told from one fit, is what a second fit does."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from ball_rig import PLACES, POSE, OutlineNoise, exact_outlines, pose_twist
from monocell.core.calibration.joint_pose import fit_pose
from monocell.core.calibration.leave_one_out import leave_one_out, leverage_warnings
from monocell.core.calibration.observation import Place

NAMES = [f"pose_{i}.png" for i in range(9)]


def noisy(seed, places=PLACES, sigma=0.2):
    return exact_outlines(places, OutlineNoise(sigma), np.random.default_rng(seed))


def moved(observation, by):
    return replace(observation, place=Place(observation.place.offset + by))


def told(observations):
    fit = fit_pose(observations, POSE)
    changes = leave_one_out(fit)
    sigma = np.sqrt(np.trace(fit.covariance[3:, 3:]))
    return changes, leverage_warnings(NAMES[: len(observations)], changes, sigma)


@pytest.mark.parametrize("seed", range(3))
def test_the_change_is_that_of_fitting_again_without_the_sighting(seed):
    observations = noisy(seed)
    fit = fit_pose(observations, POSE)
    centre = fit.camera_from_base.inverse().translation
    scale = np.sqrt(np.trace(fit.covariance[3:, 3:]))
    for i, change in enumerate(leave_one_out(fit)):
        again = fit_pose([o for j, o in enumerate(observations) if j != i], POSE)
        # to a half of the pose's own sigma, which it does not need to be finer than
        moves = again.camera_from_base.inverse().translation - centre
        assert np.linalg.norm(change.centre_moves - moves) < 0.5 * scale
        twist = pose_twist(again.camera_from_base, fit.camera_from_base)
        sigmas = np.sqrt(twist @ np.linalg.solve(fit.covariance, twist))
        assert change.sigmas == pytest.approx(sigmas, abs=0.7, rel=0.2)
        spread = np.sqrt(np.trace(again.covariance[3:, 3:])) * fit.misfit / again.misfit
        assert change.position_sigma == pytest.approx(spread, rel=0.1)
        assert change.turn == pytest.approx(np.linalg.norm(twist[:3]), abs=5e-4)


def test_a_large_change_is_told_too():
    observations = noisy(1)
    observations[2] = moved(observations[2], [0.0, 0.004, 0.002])
    fit = fit_pose(observations, POSE)
    change = leave_one_out(fit)[2]
    again = fit_pose([o for j, o in enumerate(observations) if j != 2], POSE)
    moves = (
        again.camera_from_base.inverse().translation - fit.camera_from_base.inverse().translation
    )
    assert np.linalg.norm(moves) > 2e-3
    np.testing.assert_allclose(change.centre_moves, moves, atol=0.35 * np.linalg.norm(moves))


def test_exact_sightings_change_nothing_and_accuse_nobody():
    changes, warnings = told(exact_outlines(PLACES))
    assert warnings == ()
    assert max(c.moves for c in changes) < 1e-6
    assert max(c.sigmas for c in changes) < 0.01


def test_a_ball_that_was_elsewhere_is_named():
    alone = 0
    for culprit in range(6):
        observations = noisy(culprit + 20)
        observations[culprit] = moved(observations[culprit], [0.003, -0.003, 0.003])
        _, (warning,) = told(observations)
        accused = warning.split(" disagree")[0]
        assert NAMES[culprit] in accused
        assert "without it the camera" in warning or "too few to tell which" in warning
        alone += accused == NAMES[culprit]
    assert alone >= 4


def test_of_four_no_single_one_is_accused_when_two_could_be_it():
    for seed in range(8):
        observations = noisy(seed, PLACES[:4])
        observations[1] = moved(observations[1], [0.004, 0.004, -0.004])
        _, warnings = told(observations)
        for warning in warnings:
            if "disagree" in warning:
                assert NAMES[1] in warning.split("disagree")[0]


def test_good_sightings_are_not_accused():
    accused = [w for seed in range(40) for w in told(noisy(seed + 100))[1] if "disagree" in w]
    assert accused == []


def test_the_only_ball_off_a_line_is_what_the_pose_hangs_on():
    line = np.array([[0.0, -0.3, 0.2], [0.06, -0.1, 0.22], [0.1, 0.1, 0.19], [0.17, 0.3, 0.2]])
    places = np.vstack([line, [[0.05, 0.0, 0.5]]])
    found = [told(noisy(seed, places, 0.4))[1] for seed in range(60)]
    hanging = [w for warnings in found for w in warnings if "hangs on" in w]
    assert hanging
    assert all(w.startswith("the pose hangs on pose_4.png: without it the camera") for w in hanging)
    assert all("hold the ball near there once more" in w for w in hanging)


def test_of_three_none_can_be_left_out():
    changes, warnings = told(noisy(3, PLACES[:3]))
    assert changes == (None, None, None)
    assert warnings == ()
