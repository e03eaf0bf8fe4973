# SPDX-License-Identifier: GPL-3.0-or-later
"""Segments and arcs in one form, so that all curves of a solid are followed at once.

`p(t) = origin + f first + g second`, with (f, g) = (t, 0) on a segment and (cos t, sin t) on a
circle.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, Mask


@dataclass(frozen=True, eq=False)
class CurveSet:
    """M curves of a solid with P parameters, in the solid's own frame.

    `origin`, `first`, `second` (M, 3) and their derivatives `*_by` (M, 3, P) by the parameters;
    `round` (M,) tells circles from segments; `ends` (M, 2) is the range of t. `visible` (M,) is
    False where the solid itself hides the curve (a non-convex prism may hide more), `outline` (M,)
    True where the solid lies on one side of the curve only, as seen. `names` tell which edge it is;
    a rim that is partly hidden comes as two curves of one name.

    On a silhouette `*_by` hold the touching line fixed: as it turns it moves in the plane of sight,
    so that the image moves along itself only.
    """

    names: tuple[str, ...]
    origin: Array
    first: Array
    second: Array
    origin_by: Array
    first_by: Array
    second_by: Array
    round: Mask
    ends: Array
    visible: Mask
    outline: Mask

    def __len__(self) -> int:
        return len(self.names)

    def factors(self, t: Array) -> tuple[Array, Array]:
        """f and g at parameters (..., M)."""
        return np.where(self.round, np.cos(t), t), np.where(self.round, np.sin(t), 0.0)

    def points(self, t: Array) -> Array:
        """Points (..., M, 3) at parameters (..., M)."""
        f, g = self.factors(t)
        at: Array = self.origin + f[..., None] * self.first + g[..., None] * self.second
        return at

    def tangents(self, t: Array) -> Array:
        """Derivatives (..., M, 3) of the points by t."""
        f, g = self.factors(t)
        along = np.where(self.round[:, None], self.second, self.first)
        turning = np.where(self.round, f, 1.0)[..., None] * along
        tangent: Array = turning - np.where(self.round, g, 0.0)[..., None] * self.first
        return tangent

    def points_by(self, t: Array) -> Array:
        """How the points at t (..., M) move with the parameters, (..., M, 3, P)."""
        f, g = self.factors(t)
        by: Array = (
            self.origin_by
            + f[..., None, None] * self.first_by
            + g[..., None, None] * self.second_by
        )
        return by

    def chosen(self, rows: NDArray[np.intp]) -> CurveSet:
        """The curves at indices `rows` (K,), in that order."""
        return CurveSet(
            tuple(self.names[int(i)] for i in rows),
            self.origin[rows],
            self.first[rows],
            self.second[rows],
            self.origin_by[rows],
            self.first_by[rows],
            self.second_by[rows],
            self.round[rows],
            self.ends[rows],
            self.visible[rows],
            self.outline[rows],
        )


Vector = Sequence[float] | Array


class CurveRow(NamedTuple):
    """One curve on its way into a set; what is not given is zero."""

    name: str
    origin: Vector
    first: Vector
    second: Vector
    # parameter index to the derivatives of origin, first and second
    by: Mapping[int, tuple[Vector, Vector, Vector]]
    is_round: bool
    ends: tuple[float, float]
    visible: bool
    outline: bool


def curve_set(rows: Sequence[CurveRow], parameters: int) -> CurveSet:
    """Rows of a solid with that many parameters, as one set."""
    by = np.zeros((3, len(rows), 3, parameters))
    for i, row in enumerate(rows):
        for j, derivatives in row.by.items():
            by[:, i, :, j] = derivatives
    return CurveSet(
        tuple(row.name for row in rows),
        np.array([row.origin for row in rows], dtype=float).reshape(-1, 3),
        np.array([row.first for row in rows], dtype=float).reshape(-1, 3),
        np.array([row.second for row in rows], dtype=float).reshape(-1, 3),
        by[0],
        by[1],
        by[2],
        np.array([row.is_round for row in rows], dtype=bool),
        np.array([row.ends for row in rows], dtype=float).reshape(-1, 2),
        np.array([row.visible for row in rows], dtype=bool),
        np.array([row.outline for row in rows], dtype=bool),
    )
