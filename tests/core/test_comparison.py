# SPDX-License-Identifier: GPL-3.0-or-later
"""An estimate's errors against the truth are the ones that were put in."""

from __future__ import annotations

import numpy as np
import pytest
from drawn import poses
from hypothesis import given, settings
from monocell.core import Box, Camera, Cell, Cylinder, Intrinsics, Pose, ReferencePlane, Sketch
from monocell.core.comparison import compare_cells, object_error, pose_error
from monocell.core.errors import InvalidValue, NoPose

LENS = Intrinsics(640, 480, 500.0, 500.0, 320.0, 240.0)
FLOOR = ReferencePlane("floor", [0, 0, 0], [0, 0, 1])
TWIST = np.array([1e-3, -2e-3, 3e-3, 0.01, 0.02, -0.01])
SPREAD = np.diag([1e-6, 1e-6, 1e-6, 1e-4, 1e-4, 1e-4])


@settings(max_examples=20, deadline=None)
@given(poses())
def test_the_pose_s_error_is_the_twist_that_was_put_in(pose):
    truth, estimate = Camera(LENS, pose), Camera(LENS, pose.perturbed(TWIST), SPREAD)
    error = pose_error(truth, estimate)
    np.testing.assert_allclose(error.rotation, TWIST[:3], atol=1e-12)
    np.testing.assert_allclose(error.centre, estimate.centre_world - truth.centre_world)
    expected = np.sqrt(np.sum(TWIST**2 / np.diag(SPREAD)))
    assert error.mahalanobis == pytest.approx(expected, rel=1e-9)
    np.testing.assert_allclose(error.rotation_sigma, 1e-3)


def test_no_stated_error_or_one_of_zero_gives_no_number_of_sigmas():
    truth = Camera(LENS, Pose.identity())
    assert pose_error(truth, truth).mahalanobis is None
    exact = Camera(LENS, Pose.identity(), np.zeros((6, 6)))
    assert pose_error(truth, exact).mahalanobis is None


def test_a_camera_without_pose_has_no_error():
    with pytest.raises(NoPose):
        pose_error(Camera(LENS), Camera(LENS, Pose.identity()))
    assert compare_cells(Cell(Camera(LENS)), Cell(Camera(LENS, Pose.identity()))).pose is None


def test_an_object_s_errors_are_signed_and_in_its_own_order():
    here = Pose.from_rotation_vector([0, 0, 0.3], [1, 2, 3])
    there = Pose.from_rotation_vector([0.01, 0, 0], [0.1, 0, -0.2]) @ here
    variances = np.diag(np.arange(1.0, 9.0) ** 2)
    error = object_error(
        Cylinder("d", here, radius=0.1, height=0.5),
        Cylinder("d", there, radius=0.12, height=0.45, covariance=variances),
    )
    np.testing.assert_allclose(error.sizes, [0.02, -0.05], atol=1e-12)
    np.testing.assert_allclose(error.position, there.translation - here.translation)
    np.testing.assert_allclose(error.size_sigma, [7, 8])
    assert error.tilt == pytest.approx(0.01, rel=1e-4)


@pytest.mark.parametrize("quarter_turns", [0, 1, 2, 3])
def test_a_box_seen_with_x_and_y_exchanged_is_the_same_box(quarter_turns):
    truth = Box("b", Pose.from_rotation_vector([0, 0, 0.2], [0, 0, 0]), size=[0.3, 0.2, 0.1])
    turn = Pose.from_rotation_vector([0, 0, quarter_turns * np.pi / 2 + 0.01], [0, 0, 0])
    size = [0.2, 0.301, 0.1] if quarter_turns % 2 else [0.301, 0.2, 0.1]
    spread = np.diag([1e-6] * 6 + ([1e-6, 4e-6, 9e-6] if quarter_turns % 2 else [4e-6, 1e-6, 9e-6]))
    estimate = Box("b", truth.world_from_object @ turn, size=size, covariance=spread)
    error = object_error(truth, estimate)
    np.testing.assert_allclose(error.sizes, [0.001, 0, 0], atol=1e-12)
    np.testing.assert_allclose(error.size_sigma, [2e-3, 1e-3, 3e-3])
    assert error.tilt == pytest.approx(0, abs=1e-7)


def test_objects_are_matched_by_name_and_the_unmatched_told():
    def block(name):
        return Box(name, Pose.identity(), size=[1, 1, 1])

    picked = Sketch("c", "box", "floor", {})
    truth = Cell(Camera(LENS), objects=(block("a"), block("b"), block("c")))
    found = Cell(
        Camera(LENS), references=(FLOOR,), objects=(block("d"), block("b")), sketches=(picked,)
    )
    comparison = compare_cells(truth, found)
    assert [error.name for error in comparison.objects] == ["b"]
    assert comparison.missing == ("a", "c")
    assert comparison.surplus == ("d",)


def test_a_drum_is_not_held_against_a_box():
    drum = Cylinder("a", Pose.identity(), radius=1, height=1)
    with pytest.raises(InvalidValue, match="a: a cylinder in truth, a box in the cell"):
        object_error(drum, Box("a", Pose.identity(), size=[1, 1, 1]))
