# SPDX-License-Identifier: GPL-3.0-or-later
"""Points with weights in, the plane or line nearest to them with derivatives and residuals out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..rotation import hat


@dataclass(frozen=True, eq=False)
class PointFit:
    """A plane or line through points (N, 3).

    `by_points` (6, 3N) is how (rotation vector about `point`, motion of `point`) follows the
    points, exact where they lie on the fit. `residuals` (N,) are distances in metres, signed for a
    plane. `length` and `width` are the points' extent along their first and second direction.
    """

    point: Array
    direction: Array
    by_points: Array
    residuals: Array
    length: float
    width: float


def fit_plane(points: Array, weights: Array) -> PointFit:
    """The plane with the least sum of `weights` times squared distances; its side is arbitrary."""
    middle, arms, axes = _principal(points, weights)
    normal = axes[2]
    # a plane turned by w and moved by v rises by n.(v + w x q) at its point q
    across = np.cross(arms, normal)
    design = np.column_stack([across @ axes[0], across @ axes[1], np.ones(len(points))])
    weighted = design.T * weights
    solved = np.linalg.pinv(weighted @ design) @ weighted
    basis = np.zeros((6, 3))
    basis[:3, 0], basis[:3, 1], basis[3:, 2] = axes[0], axes[1], normal
    by_points = (basis @ solved)[:, :, None] * normal
    return PointFit(middle, normal, by_points.reshape(6, -1), arms @ normal, *_extent(arms, axes))


def fit_line(points: Array, weights: Array) -> PointFit:
    """The line with the least sum of `weights` times squared distances, towards the last point."""
    middle, arms, axes = _principal(points, weights)
    direction = axes[0] if (points[-1] - points[0]) @ axes[0] >= 0 else -axes[0]
    along = arms @ direction
    across = np.eye(3) - np.outer(direction, direction)
    lever, whole = weights * along, weights.sum()
    turned = (lever / max(float(lever @ along), 1e-300))[:, None, None] * hat(direction)
    moved = (weights / whole)[:, None, None] * across
    by_points = np.concatenate([turned, moved], axis=1).transpose(1, 0, 2).reshape(6, -1)
    residuals = np.linalg.norm(arms @ across, axis=1)
    return PointFit(middle, direction, by_points, residuals, *_extent(arms, axes))


def _principal(points: Array, weights: Array) -> tuple[Array, Array, Array]:
    """The weighted middle, the points about it, and their principal axes as rows, widest first."""
    middle: Array = weights @ points / weights.sum()
    arms = points - middle
    _, axes = np.linalg.eigh(arms.T @ (arms * weights[:, None]))
    return middle, arms, axes.T[::-1]


def _extent(arms: Array, axes: Array) -> tuple[float, float]:
    length, width = np.ptp(arms @ axes[:2].T, axis=0)
    return float(length), float(width)
