# SPDX-License-Identifier: GPL-3.0-or-later
"""Poses from points in both frames, and what positions can tell of a pose."""

from __future__ import annotations

import numpy as np
import pytest
from drawn import poses
from hypothesis import given, settings
from hypothesis import strategies as st
from monocell.core.calibration.frames import pose_from_points, pose_from_triads
from monocell.core.calibration.position_geometry import check_positions, geometry_of
from monocell.core.errors import DegeneratePositions, TooFewSightings

LAWS = settings(max_examples=40, deadline=None)
SEEDS = st.integers(0, 2**32 - 1)
CORNER = np.array([[0.5, 0.0, 0.1], [0.5, 0.4, 0.1], [0.8, 0.1, 0.5]])


@LAWS
@given(poses(), SEEDS)
def test_three_points_in_both_frames_give_the_pose(pose, seed):
    points = CORNER + np.random.default_rng(seed).normal(0, 0.02, (3, 3))
    for found in (
        pose_from_triads(points, pose.apply(points)),
        pose_from_points(points, pose.apply(points)),
    ):
        np.testing.assert_allclose(found.rotation, pose.rotation, atol=1e-10)
        np.testing.assert_allclose(found.translation, pose.translation, atol=1e-10)


@LAWS
@given(poses(), SEEDS)
def test_rigid_alignment_is_no_worse_than_the_true_pose_under_noise(pose, seed):
    rng = np.random.default_rng(seed)
    world = rng.uniform(-1, 1, (8, 3))
    camera = pose.apply(world) + rng.normal(0, 0.01, (8, 3))
    weights = rng.uniform(0.2, 2.0, 8)
    found = pose_from_points(world, camera, weights)

    def misfit(p):
        return float(weights @ ((p.apply(world) - camera) ** 2).sum(axis=1))

    assert misfit(found) <= misfit(pose) + 1e-12
    assert misfit(found) <= misfit(found.perturbed(rng.normal(0, 1e-3, 6)))


def test_alignment_never_mirrors_even_where_mirrored_points_would_fit_better():
    mirrored = CORNER * [1, 1, -1] + [0, 0, 2]
    found = pose_from_points(np.vstack([CORNER, [0, 0, 0]]), np.vstack([mirrored, [0, 0, 2]]))
    assert np.linalg.det(found.rotation) == pytest.approx(1)


@pytest.mark.parametrize("solve", [pose_from_triads, pose_from_points])
@pytest.mark.parametrize("points", [[[0, 0, 0], [1, 1, 1], [2, 2, 2]], [[1, 2, 3]] * 3])
def test_points_on_a_line_make_no_frame(solve, points):
    with pytest.raises(DegeneratePositions):
        solve(np.array(points, dtype=float), CORNER)


def test_the_geometry_of_positions_is_measured_from_their_best_line_and_plane():
    x = np.linspace(0, 1, 5)
    flat = np.column_stack([x, 0.1 * (-1) ** np.arange(5), np.zeros(5)])
    geometry = geometry_of(flat)
    assert geometry.count == 5
    assert geometry.length == pytest.approx(1.0, abs=0.01)
    assert geometry.off_line == pytest.approx(0.12, abs=0.02)
    assert geometry.off_plane == pytest.approx(0, abs=1e-12)
    assert geometry.turn_per_millimetre == pytest.approx(1e-3 / geometry.off_line, rel=1e-3)


@pytest.mark.parametrize("count", [0, 1, 2])
def test_fewer_than_three_positions_are_too_few(count):
    verb = "is" if count == 1 else "are"
    with pytest.raises(TooFewSightings, match=f"there {verb} {count}; add sightings"):
        check_positions(CORNER[:count])


def test_positions_on_a_line_are_refused_in_millimetres_and_degrees():
    line = np.array([[0, 0, 0], [0.25, 0, 0], [0.5, 0.004, 0], [0.75, 0, 0]])
    with pytest.raises(DegeneratePositions) as refusal:
        check_positions(line)
    told = str(refusal.value)
    assert "4 ball positions lie within 2." in told or "within 3." in told
    assert "750 mm long" in told
    assert "deg about it" in told
    assert "hold the ball at least 75 mm off that line" in told


def test_positions_near_a_line_are_taken_with_a_warning():
    near = np.array([[0, 0, 0], [0.25, 0, 0], [0.5, 0.05, 0], [0.75, 0, 0]])
    (warning,) = check_positions(near).warnings()
    assert "mm of a line" in warning
    assert check_positions(CORNER).warnings() == ()


def test_the_same_position_again_does_not_count():
    with pytest.raises(DegeneratePositions, match="only 2 different ball positions; three"):
        check_positions(CORNER[[0, 1, 0, 1]])
    with pytest.raises(DegeneratePositions, match="only 1 different ball position; three"):
        check_positions(CORNER[[2, 2, 2]])
    assert check_positions(CORNER[[0, 1, 2, 2]]).count == 4


def test_a_line_far_from_the_origin_is_as_much_a_line():
    line = np.outer([0, 1, 2.0], [0.1, 0.2, 0.1]) + 1000
    with pytest.raises(DegeneratePositions, match="mm of a line"):
        check_positions(line)
