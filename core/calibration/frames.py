# SPDX-License-Identifier: GPL-3.0-or-later
"""Pose from points known in both frames: the paper's three-point triads, and rigid alignment."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array, frozen
from ..errors import DegeneratePositions
from ..pose import Pose


def pose_from_triads(three_world: ArrayLike, three_camera: ArrayLike) -> Pose:
    """`camera_from_world` from three points (3, 3), one a row, in both frames (paper eq. 1-8).

    In each frame the same right-handed triad is built on the points: `i = AB / |AB|`,
    `k = AB x AC / |AB x AC|`, `j = k x i`. With W and M their columns in the world and in the
    camera, the rotation is `M W^T`, and A goes to A.

    Raises DegeneratePositions when the points lie on a line.
    """
    world = frozen(three_world, (3, 3), "three_world")
    camera = frozen(three_camera, (3, 3), "three_camera")
    rotation = _triad(camera) @ _triad(world).T
    return Pose(rotation, camera[0] - rotation @ world[0])


def pose_from_points(
    points_world: ArrayLike, points_camera: ArrayLike, weights: ArrayLike | None = None
) -> Pose:
    """The rigid motion (Kabsch 1976) that brings points (N, 3) closest to those in the camera.

    Raises DegeneratePositions when the points lie on a line.
    """
    world, camera = (np.asarray(p, dtype=float) for p in (points_world, points_camera))
    share = np.ones(len(world)) if weights is None else np.asarray(weights, dtype=float)
    share = share / share.sum()
    middle_world, middle_camera = share @ world, share @ camera
    mixed = (camera - middle_camera).T @ ((world - middle_world) * share[:, None])
    u, s, vt = np.linalg.svd(mixed)
    if s[1] < 1e-12 * max(float(s[0]), 1e-300):
        raise DegeneratePositions(f"the {len(world)} positions lie on a line or in one place")
    handed = np.diag([1.0, 1.0, float(np.sign(np.linalg.det(u @ vt)))])
    rotation = u @ handed @ vt
    return Pose(rotation, middle_camera - rotation @ middle_world)


def _triad(points: Array) -> Array:
    """The columns i, j, k of equations 1-6."""
    a, b, c = points
    ab, ac = b - a, c - a
    across = np.cross(ab, ac)
    if np.linalg.norm(across) < 1e-9 * max(float(np.linalg.norm(ab) * np.linalg.norm(ac)), 1e-300):
        raise DegeneratePositions("the three positions lie on a line, so they make no frame")
    i = ab / np.linalg.norm(ab)
    k = across / np.linalg.norm(across)
    return np.stack([i, np.cross(k, i), k], axis=1)
