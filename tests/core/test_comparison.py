# SPDX-License-Identifier: GPL-3.0-or-later
"""An estimate's errors against the truth are the ones that were put in."""

from __future__ import annotations

import numpy as np
import pytest
from drawn import poses
from hypothesis import given, settings
from monocell.core import (
    Box,
    Camera,
    Cell,
    Cone,
    Cylinder,
    Intrinsics,
    Pose,
    Prism,
    ReferencePlane,
    Sketch,
    Sphere,
    Tube,
)
from monocell.core.comparison import compare_cells, object_error, pose_error
from monocell.core.errors import InvalidValue, NoPose
from monocell.core.primitives import polygon_centre

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


def rotated(pose, *turn):
    return pose @ Pose.from_rotation_vector(turn, [0, 0, 0])


POSE = Pose.from_rotation_vector([0.2, -0.3, 0.4], [0.5, 0.1, 0.2])
RIGHT_ANGLES = [
    [0, 0, np.pi / 2],
    [np.pi / 2, 0, 0],
    [0, -np.pi / 2, 0],
    [np.pi, 0, 0],
    (np.array([1, 1, 1]) * 2 * np.pi / 3 / 3**0.5).tolist(),
]


@pytest.mark.parametrize("turn", RIGHT_ANGLES)
def test_a_box_told_along_other_axes_is_the_same_box(turn):
    truth = Box("b", POSE, size=[0.3, 0.2, 0.1])
    size = np.abs(Pose.from_rotation_vector(turn, [0, 0, 0]).rotation.T @ [0.301, 0.2, 0.1])
    error = object_error(truth, Box("b", rotated(rotated(POSE, 0, 0, 0.01), *turn), size=size))
    np.testing.assert_allclose(error.sizes, [0.001, 0, 0], atol=1e-12)
    assert error.rotation == pytest.approx(0.01) and error.tilt == pytest.approx(0, abs=1e-7)


def test_a_drum_and_a_tube_upside_down_are_the_same_and_spin_does_not_show():
    over = rotated(POSE, np.pi - 0.02, 0, 0)
    spun = rotated(over, 0, 0, 1.3)
    for kind, sizes in (
        (Cylinder, {"radius": 0.1, "height": 0.3}),
        (Tube, {"radius": 0.1, "inner_radius": 0.05, "height": 0.3}),
    ):
        error = object_error(kind("d", POSE, **sizes), kind("d", spun, **sizes))
        assert error.tilt == pytest.approx(0.02)
        assert error.rotation is None and not error.sizes.any()


def test_a_frustum_upside_down_has_its_radii_exchanged_and_a_pointed_cone_does_not():
    over = rotated(POSE, np.pi - 0.02, 0, 0)
    truth = Cone("c", POSE, radius=0.1, top_radius=0.05, height=0.3)
    spread = np.diag([1e-6] * 6 + [1e-6, 4e-6, 9e-6])
    found = Cone("c", over, radius=0.051, top_radius=0.1, height=0.3, covariance=spread)
    error = object_error(truth, found)
    np.testing.assert_allclose(error.sizes, [0, 0.001, 0], atol=1e-12)
    np.testing.assert_allclose(error.size_sigma, [2e-3, 1e-3, 3e-3])
    assert error.tilt == pytest.approx(0.02)
    pointed = Cone("c", POSE, radius=0.1, height=0.3)
    assert object_error(pointed, Cone("c", over, radius=0.1, height=0.3)).tilt == pytest.approx(
        np.pi - 0.02
    )


def test_a_ball_has_no_axis_to_tilt():
    error = object_error(
        Sphere("s", POSE, radius=0.1), Sphere("s", rotated(POSE, 1, 2, 0), radius=0.11)
    )
    assert (error.tilt, error.rotation, error.size_names) == (0.0, None, ("radius",))


def test_the_tilt_and_the_rotation_state_their_sigmas():
    axis = POSE.rotation[:, 2]
    covariance = np.zeros((9, 9))
    covariance[:3, :3] = 1e-6 * np.eye(3) + 3e-6 * np.outer(axis, axis)
    error = object_error(
        Box("b", POSE, size=[1, 2, 3]), Box("b", POSE, size=[1, 2, 3], covariance=covariance)
    )
    assert error.tilt_sigma == pytest.approx(np.sqrt(2e-6))
    assert error.rotation_sigma == pytest.approx(np.sqrt(6e-6))


CORNERS = np.array([[0, 0], [0.4, 0], [0.4, 0.1], [0.1, 0.1], [0.1, 0.3], [0, 0.3]])
ELL = CORNERS - polygon_centre(CORNERS)


def test_a_prism_is_matched_by_its_corners_wherever_its_polygon_begins():
    truth = Prism("p", POSE, polygon=ELL, height=0.2)
    turn = Pose.from_rotation_vector([0, 0, 0.7], [0, 0, 0]).rotation[:2, :2]
    moved = rotated(POSE, 0, 0, 0.7)
    for polygon, pose in (
        (np.roll(ELL, 2, axis=0) @ turn, moved),
        # upside down: mirrored, the other way round
        ((ELL * [1, -1])[::-1], rotated(POSE, np.pi, 0, 0)),
    ):
        error = object_error(truth, Prism("p", pose, polygon=polygon, height=0.2))
        assert error.corners.shape == (12,)
        np.testing.assert_allclose(error.corners, 0, atol=1e-12)
    higher = object_error(truth, Prism("p", POSE, polygon=ELL, height=0.21))
    np.testing.assert_allclose(higher.corners, 0.005)


def test_a_prism_of_other_corners_is_told_and_not_matched():
    truth = Prism("p", POSE, polygon=ELL, height=0.2)
    square = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1.0]])
    found = Prism("p", POSE, polygon=square, height=0.2)
    comparison = compare_cells(
        Cell(Camera(LENS), objects=(truth,)), Cell(Camera(LENS), objects=(found,))
    )
    assert comparison.objects[0].corners is None
    assert comparison.warnings == ("p: has 4 corners, the true one 6: not matched",)
