# SPDX-License-Identifier: GPL-3.0-or-later
"""Rotation vectors to rotation matrices and back, exact from zero to half a turn; other forms."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from .arrays import Array


def hat(vector: ArrayLike) -> Array:
    """The matrix of the cross product, `hat(a) @ b == cross(a, b)`; (..., 3) to (..., 3, 3)."""
    v = np.asarray(vector, dtype=float)
    matrix = np.zeros((*v.shape, 3))
    matrix[..., 2, 1], matrix[..., 0, 2], matrix[..., 1, 0] = v[..., 0], v[..., 1], v[..., 2]
    return matrix - np.swapaxes(matrix, -1, -2)


def rotation_from_vector(vector: ArrayLike) -> Array:
    """Rodrigues' formula: the rotation by |vector| radians about `vector`, shape (3, 3).

    >>> import numpy as np
    >>> (rotation_from_vector([0, 0, np.pi / 2]) @ [1, 0, 0]).round(12).tolist()
    [0.0, 1.0, 0.0]
    """
    v = np.asarray(vector, dtype=float)
    angle = float(np.linalg.norm(v))
    k = hat(v)
    # sinc keeps both factors exact down to an angle of zero
    sine = np.sinc(angle / np.pi)
    versine = 0.5 * np.sinc(angle / (2 * np.pi)) ** 2
    rotation: Array = np.eye(3) + sine * k + versine * (k @ k)
    return rotation


def vector_from_rotation(rotation: ArrayLike) -> Array:
    """The rotation vector (3,) of a rotation matrix, of length at most pi.

    Goes through the quaternion (Shepperd 1978: the largest component is computed first), which
    stays exact near half a turn, where the arc cosine of the trace does not.
    """
    w, *v = quaternion_from_rotation(rotation)
    vector = np.array(v)
    sine = float(np.linalg.norm(vector))
    if sine < 1e-12:
        # to first order the vector part is half the angle; w is +1 or -1 here
        return 2.0 * vector * (1.0 if w >= 0 else -1.0)
    angle = 2.0 * np.arctan2(sine, abs(w)) * (1.0 if w >= 0 else -1.0)
    return vector * (angle / sine)


def quaternion_from_rotation(rotation: ArrayLike) -> Array:
    """The quaternion (w, x, y, z) of unit length of a rotation matrix."""
    r = np.asarray(rotation, dtype=float)
    squares = np.array(
        [
            1 + r[0, 0] + r[1, 1] + r[2, 2],
            1 + r[0, 0] - r[1, 1] - r[2, 2],
            1 - r[0, 0] + r[1, 1] - r[2, 2],
            1 - r[0, 0] - r[1, 1] + r[2, 2],
        ]
    )
    products = np.array(
        [
            [0, r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]],
            [r[2, 1] - r[1, 2], 0, r[0, 1] + r[1, 0], r[0, 2] + r[2, 0]],
            [r[0, 2] - r[2, 0], r[0, 1] + r[1, 0], 0, r[1, 2] + r[2, 1]],
            [r[1, 0] - r[0, 1], r[0, 2] + r[2, 0], r[1, 2] + r[2, 1], 0],
        ]
    )
    largest = int(np.argmax(squares))
    row = products[largest].copy()
    row[largest] = squares[largest]
    unit: Array = row / np.linalg.norm(row)
    return unit


def roll_pitch_yaw(rotation: ArrayLike) -> Array:
    """The angles (3,) of URDF and SDF: `rotation == Rz(yaw) @ Ry(pitch) @ Rx(roll)`, radians.

    Roll is taken from what is left when yaw is undone, which stays exact where pitch is a quarter
    turn and only the two together are determined.
    """
    r = np.asarray(rotation, dtype=float)
    yaw = float(np.arctan2(r[1, 0], r[0, 0]))
    sine, cosine = np.sin(yaw), np.cos(yaw)
    pitch = np.arctan2(-r[2, 0], cosine * r[0, 0] + sine * r[1, 0])
    roll = np.arctan2(sine * r[0, 2] - cosine * r[1, 2], cosine * r[1, 1] - sine * r[0, 1])
    return np.array([roll, pitch, yaw])
