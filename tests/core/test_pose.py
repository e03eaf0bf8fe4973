# SPDX-License-Identifier: GPL-3.0-or-later
"""Poses form a group, rotation vectors invert exactly, and derivatives are those of the motion."""

from __future__ import annotations

import numpy as np
import pytest
from drawn import differences, poses, rotation_vectors, vectors
from hypothesis import example, given, settings
from monocell.core import Pose
from monocell.core.errors import InvalidValue
from monocell.core.pose import point_jacobian
from monocell.core.rotation import hat, rotation_from_vector, vector_from_rotation

LAWS = settings(max_examples=40, deadline=None)
POINTS = np.array([[0.3, -0.2, 1.1], [2.0, 0.5, -0.7], [0.0, 0.0, 0.0]])


def same(one, other, tolerance=1e-12):
    np.testing.assert_allclose(one.rotation, other.rotation, atol=tolerance)
    np.testing.assert_allclose(one.translation, other.translation, atol=10 * tolerance)


@LAWS
@given(poses(), poses(), poses())
def test_composition_is_associative_and_applies_the_right_one_first(a, b, c):
    same((a @ b) @ c, a @ (b @ c))
    np.testing.assert_allclose((a @ b).apply(POINTS), a.apply(b.apply(POINTS)), atol=1e-11)


@LAWS
@given(poses())
def test_a_pose_and_its_inverse_cancel_from_both_sides(a):
    same(a @ a.inverse(), Pose.identity())
    same(a.inverse() @ a, Pose.identity())
    np.testing.assert_allclose(a.inverse().apply(a.apply(POINTS)), POINTS, atol=1e-12)


@LAWS
@given(poses(), poses())
def test_the_inverse_of_a_product_is_the_product_of_inverses_in_reverse(a, b):
    same((a @ b).inverse(), b.inverse() @ a.inverse())


@LAWS
@given(poses())
def test_the_identity_changes_nothing_and_matrices_carry_poses_whole(a):
    same(a @ Pose.identity(), a, 0)
    same(Pose.from_matrix(a.matrix()), a, 0)


@LAWS
@given(poses(), vectors(3.0))
def test_directions_turn_without_moving_and_keep_their_length(a, v):
    turned = a.rotate(v)
    np.testing.assert_allclose(turned, a.apply(v) - a.apply(np.zeros(3)), atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(turned), np.linalg.norm(v), atol=1e-12)


@settings(max_examples=150, deadline=None)
@given(rotation_vectors())
@example(np.array([np.pi, 0.0, 0.0]))
@example(np.array([0.0, -np.pi, 0.0]))
@example(np.zeros(3))
def test_rotation_vectors_and_matrices_invert_each_other_up_to_half_a_turn(vector):
    rotation = rotation_from_vector(vector)
    np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-14)
    back = vector_from_rotation(rotation)
    assert np.linalg.norm(back) <= np.pi + 1e-12
    np.testing.assert_allclose(rotation_from_vector(back), rotation, atol=1e-14)
    # half a turn one way is half a turn the other way
    if np.linalg.norm(vector) < np.pi - 1e-8:
        np.testing.assert_allclose(back, vector, atol=1e-14, rtol=1e-11)


@pytest.mark.parametrize("size", [1e-3, 1e-6, 1e-9, 1e-13, 1e-100])
def test_a_tiny_rotation_keeps_all_its_digits(size):
    vector = size * np.array([0.6, -0.48, 0.64])
    np.testing.assert_allclose(
        vector_from_rotation(rotation_from_vector(vector)), vector, rtol=1e-9
    )


def test_a_rotation_turns_by_the_right_hand():
    quarter = Pose.from_rotation_vector([0, 0, np.pi / 2], [0, 0, 0])
    np.testing.assert_allclose(quarter.apply([1, 0, 0]), [0, 1, 0], atol=1e-15)


@LAWS
@given(vectors(2.0), vectors(2.0))
def test_hat_is_the_cross_product(a, b):
    np.testing.assert_allclose(hat(a) @ b, np.cross(a, b), atol=1e-14)
    np.testing.assert_allclose(hat(np.stack([a, b]))[1], hat(b))


@LAWS
@given(poses())
def test_the_twist_s_derivative_is_that_of_the_perturbed_pose(pose):
    moved = differences(lambda twist: pose.perturbed(twist).apply(POINTS), np.zeros(6), 1e-6)
    np.testing.assert_allclose(point_jacobian(pose.apply(POINTS)), moved, atol=1e-8)


@LAWS
@given(vectors(3.0), vectors(3.0))
def test_a_camera_looking_at_a_target_has_it_ahead_and_up_above(eye, target):
    up = np.array([0.0, 0.0, 1.0])
    if np.linalg.norm(np.cross(target - eye, up)) < 1e-3:
        return
    pose = Pose.looking_at(eye, target, up)
    ahead = pose.apply(target)
    np.testing.assert_allclose(ahead, [0, 0, np.linalg.norm(target - eye)], atol=1e-9)
    assert pose.rotate(up)[1] < 0
    assert abs(pose.rotate(up)[0]) < 1e-9
    np.testing.assert_allclose(pose.inverse().translation, eye, atol=1e-12)


@pytest.mark.parametrize("target", [[0.1, 0.2, 0.3], [0.1, 0.2, 5.0]])
def test_a_camera_can_t_look_at_itself_or_along_up(target):
    with pytest.raises(InvalidValue, match="looking_at"):
        Pose.looking_at([0.1, 0.2, 0.3], target, [0, 0, 1])


def test_a_rotation_typed_with_four_decimals_is_cleaned():
    true = rotation_from_vector([0.3, -0.2, 0.5])
    pose = Pose(true.round(4), np.zeros(3))
    np.testing.assert_allclose(pose.rotation @ pose.rotation.T, np.eye(3), atol=1e-15)
    np.testing.assert_allclose(pose.rotation, true, atol=1e-4)


@pytest.mark.parametrize(
    ("rotation", "told"),
    [
        (np.diag([1.0, 1.0, -1.0]), "mirror"),
        (1.01 * np.eye(3), "not orthonormal"),
        (np.ones((3, 3)), "not orthonormal"),
        (np.zeros((3, 3)), "not orthonormal"),
        (np.eye(2), "shape"),
        (np.full((3, 3), np.nan), "not finite"),
        ("turned", "expected numbers"),
    ],
)
def test_what_is_no_rotation_is_refused_with_the_reason(rotation, told):
    with pytest.raises(InvalidValue, match=told):
        Pose(rotation, np.zeros(3))


@pytest.mark.parametrize("translation", [[0, 0], [0, 0, np.inf], None, [[0, 0, 0]]])
def test_what_is_no_translation_is_refused(translation):
    with pytest.raises(InvalidValue, match="translation"):
        Pose(np.eye(3), translation)


def test_a_transposed_homogeneous_matrix_is_refused_instead_of_losing_its_translation():
    matrix = Pose.from_rotation_vector([0.1, 0.2, 0.3], [1, 2, 3]).matrix()
    with pytest.raises(InvalidValue, match="last row"):
        Pose.from_matrix(matrix.T)


def test_a_pose_can_t_be_changed_from_outside():
    given = np.eye(3)
    pose = Pose(given, np.zeros(3))
    given[0, 0] = 7
    assert pose.rotation[0, 0] == 1
    with pytest.raises(ValueError, match="read-only"):
        pose.translation[0] = 1
