# SPDX-License-Identifier: GPL-3.0-or-later
"""Several objects and a camera in, all their curves in world coordinates as flat arrays out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, Mask
from ..camera import Camera
from ..primitives import Primitive
from .curve_set import CurveSet
from .curves import curves_seen


@dataclass(frozen=True, eq=False)
class WorldCurves:
    """M curves of all objects, `p(t) = origin + f first + g second` in the world (see CurveSet).

    `sets` are the objects' own curves; curve `i` belongs to object `owner[i]`, in the order given.
    """

    sets: tuple[CurveSet, ...]
    owner: NDArray[np.intp]
    origin: Array
    first: Array
    second: Array
    round: Mask
    ends: Array
    visible: Mask
    outline: Mask

    def points(self, curve: NDArray[np.intp], t: Array) -> Array:
        """World points (N, 3) of curves (N,) at parameters (N,)."""
        turning = self.round[curve]
        f, g = np.where(turning, np.cos(t), t), np.where(turning, np.sin(t), 0.0)
        at: Array = (
            self.origin[curve] + f[:, None] * self.first[curve] + g[:, None] * self.second[curve]
        )
        return at


def world_curves(things: Sequence[Primitive], camera: Camera) -> WorldCurves:
    """All curves of the objects as the camera sees them. Raises NoPose."""
    sets = tuple(curves_seen(thing, camera) for thing in things)
    poses = [thing.world_from_object for thing in things]

    def gathered(name: str, shape: tuple[int, ...] = (0, 3)) -> Array:
        parts = [getattr(s, name) for s in sets]
        return np.concatenate(parts) if parts else np.zeros(shape)

    def turned(name: str) -> Array:
        parts = [p.rotate(getattr(s, name)) for s, p in zip(sets, poses, strict=True)]
        return np.concatenate(parts) if parts else np.zeros((0, 3))

    owner = np.repeat(np.arange(len(sets)), [len(s) for s in sets])
    places = np.array([p.translation for p in poses]).reshape(-1, 3)
    return WorldCurves(
        sets,
        owner,
        turned("origin") + places[owner],
        turned("first"),
        turned("second"),
        gathered("round", (0,)).astype(bool),
        gathered("ends", (0, 2)),
        gathered("visible", (0,)).astype(bool),
        gathered("outline", (0,)).astype(bool),
    )
