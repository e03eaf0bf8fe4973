# SPDX-License-Identifier: GPL-3.0-or-later
"""A rigid motion between two named frames: `b_from_a.apply(p_a) == p_b`."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from .arrays import Array, frozen
from .errors import InvalidValue
from .rotation import hat, rotation_from_vector, vector_from_rotation

# a rotation typed with four decimals is accepted and cleaned; anything worse is a mistake
TYPED_ROTATION_TOLERANCE = 1e-3
CLEAN_ROTATION_TOLERANCE = 1e-12
# the earth's circumference: beyond it numbers lose their micrometres, and no robot stands there
FARTHEST = 4e7


@dataclass(frozen=True, eq=False)
class Pose:
    """A rotation (3, 3) and a translation (3,) in metres: `p_b = rotation @ p_a + translation`.

    Named after its frames so that neighbours cancel:
    `camera_from_world @ world_from_object` is `camera_from_object`.

    Raises InvalidValue when the rotation is not orthonormal to 1e-3 or mirrors.

    >>> half_turn = Pose.from_rotation_vector([0, 0, 3.141592653589793], [1, 0, 0])
    >>> half_turn.apply([[2, 1, 0]]).round(9).tolist()
    [[-1.0, -1.0, 0.0]]
    """

    rotation: Array
    translation: Array

    def __post_init__(self) -> None:
        rotation = frozen(self.rotation, (3, 3), "rotation")
        object.__setattr__(self, "rotation", _orthonormal(rotation))
        translation = frozen(self.translation, (3,), "translation")
        if np.abs(translation).max() > FARTHEST:
            raise InvalidValue(
                f"translation: {np.abs(translation).max():.3g} m is farther than any cell "
                f"({FARTHEST:g} m); positions are in metres"
            )
        object.__setattr__(self, "translation", translation)

    @staticmethod
    def identity() -> Pose:
        return Pose(np.eye(3), np.zeros(3))

    @staticmethod
    def from_rotation_vector(rotation_vector: ArrayLike, translation: ArrayLike) -> Pose:
        """A pose from a rotation vector (3,) in radians and a translation (3,) in metres."""
        vector = frozen(rotation_vector, (3,), "rotation_vector")
        return Pose(rotation_from_vector(vector), np.asarray(translation, dtype=float))

    @staticmethod
    def from_matrix(matrix: ArrayLike) -> Pose:
        """A pose from a homogeneous matrix (4, 4). Raises InvalidValue for a transposed one."""
        m = frozen(matrix, (4, 4), "matrix")
        if np.abs(m[3] - [0, 0, 0, 1]).max() > CLEAN_ROTATION_TOLERANCE:
            raise InvalidValue(
                f"matrix: the last row is {m[3].round(4).tolist()}, not 0 0 0 1; is it transposed?"
            )
        return Pose(m[:3, :3], m[:3, 3])

    @staticmethod
    def looking_at(eye_world: ArrayLike, target_world: ArrayLike, up_world: ArrayLike) -> Pose:
        """The `camera_from_world` of a camera at `eye` whose optical axis meets `target`.

        The camera's y axis (down in the picture) is as far from `up` as it can be.
        """
        eye = frozen(eye_world, (3,), "eye_world")
        forward = frozen(target_world, (3,), "target_world") - eye
        right = np.cross(forward, frozen(up_world, (3,), "up_world"))
        if np.linalg.norm(right) < 1e-12 * max(1.0, float(np.linalg.norm(forward))):
            raise InvalidValue("looking_at: the target lies at the eye or straight along up")
        z, x = forward / np.linalg.norm(forward), right / np.linalg.norm(right)
        rotation = np.array([x, np.cross(z, x), z])
        return Pose(rotation, -rotation @ eye)

    def apply(self, points: ArrayLike) -> Array:
        """Points (..., 3) of the right-hand frame in the left-hand frame."""
        moved: Array = np.asarray(points, dtype=float) @ self.rotation.T + self.translation
        return moved

    def rotate(self, vectors: ArrayLike) -> Array:
        """Directions (..., 3): rotated, not moved."""
        turned: Array = np.asarray(vectors, dtype=float) @ self.rotation.T
        return turned

    def inverse(self) -> Pose:
        return Pose(self.rotation.T, -self.rotation.T @ self.translation)

    def __matmul__(self, other: Pose) -> Pose:
        return Pose(
            self.rotation @ other.rotation, self.rotation @ other.translation + self.translation
        )

    def rotation_vector(self) -> Array:
        """The rotation vector (3,) in radians, at most pi long."""
        return vector_from_rotation(self.rotation)

    def matrix(self) -> Array:
        """The homogeneous matrix (4, 4)."""
        matrix = np.eye(4)
        matrix[:3, :3], matrix[:3, 3] = self.rotation, self.translation
        return matrix

    def perturbed(self, twist: ArrayLike) -> Pose:
        """Left perturbation by (rotation vector, translation), (6,), both in the left-hand frame.

        `p_b' = exp(twist[:3]) @ p_b + twist[3:]`, so that a point moves by
        `-hat(p_b) @ twist[:3] + twist[3:]` to first order. All covariances of poses are on
        this twist.
        """
        xi = np.asarray(twist, dtype=float)
        return Pose.from_rotation_vector(xi[:3], xi[3:]) @ self


def point_jacobian(points: ArrayLike) -> Array:
    """How moved points (..., 3) change with the twist of `Pose.perturbed`: (..., 3, 6)."""
    p = np.asarray(points, dtype=float)
    identity = np.broadcast_to(np.eye(3), (*p.shape, 3))
    return np.concatenate([-hat(p), identity], axis=-1)


def _orthonormal(rotation: Array) -> Array:
    error = float(np.abs(rotation @ rotation.T - np.eye(3)).max())
    if error > TYPED_ROTATION_TOLERANCE or np.linalg.det(rotation) < 0:
        raise InvalidValue(
            f"rotation: rows are not orthonormal (off by {error:.2g}) or mirror "
            f"(determinant {np.linalg.det(rotation):.3f}); give a proper rotation matrix"
        )
    if error <= CLEAN_ROTATION_TOLERANCE:
        return rotation
    u, _, vt = np.linalg.svd(rotation)
    clean: Array = u @ vt
    clean.setflags(write=False)
    return clean
