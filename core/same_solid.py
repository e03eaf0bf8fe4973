# SPDX-License-Identifier: GPL-3.0-or-later
"""Two descriptions of a solid in, the second told the way the first is out.

A box turned by a right angle with its sizes exchanged, a drum upside down and a prism whose polygon
begins at another corner are the same solids as before.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import permutations, product

import numpy as np

from .arrays import Array
from .primitives import Box, Cone, Cylinder, Primitive, Prism, Tube

UPSIDE_DOWN = np.diag([1.0, -1.0, -1.0])


@dataclass(frozen=True, eq=False)
class Retold:
    """The axes (3, 3), as columns, and the order of sizes by which `estimate` is most like `truth`.

    `tilt` is the angle between their axes in radians, 0 for a ball, which has none. `rotation` is
    the angle of all that is left of the rotation, None for what shows no turn about its axis.
    """

    axes: Array
    order: list[int]
    tilt: float
    rotation: float | None = None


def retold(truth: Primitive, estimate: Primitive) -> Retold:
    """How to tell `estimate` so that it is most like `truth`; both are of the same kind."""
    true, found = truth.world_from_object.rotation, estimate.world_from_object.rotation
    order = list(range(len(estimate.size_names)))
    if isinstance(estimate, Box):
        return _nearest_box(true, found)
    if estimate.kind == "sphere":
        return Retold(found, order, 0.0)
    upside_down = float(found[:, 2] @ true[:, 2]) < 0
    if upside_down and _turns_over(estimate):
        found = found @ UPSIDE_DOWN
        order = [1, 0, 2] if isinstance(estimate, Cone) else order
    return Retold(found, order, _angle(found[:, 2], true[:, 2]))


def corner_errors(truth: Prism, estimate: Prism) -> Array | None:
    """How far each corner, of the base and then of the top, is from the true one, (2 N,) metres.

    The corners are matched in the order round that fits best, upside down if need be. None for
    another number of corners.
    """
    if len(truth.polygon) != len(estimate.polygon):
        return None
    wanted = _corners(truth)
    base, top = _corners(estimate)
    candidates = [
        np.roll(np.stack(ends), shift, axis=1)
        for ends in ((base, top), (top[::-1], base[::-1]))
        for shift in range(len(base))
    ]
    errors = [np.linalg.norm(found - wanted, axis=2) for found in candidates]
    best: Array = min(errors, key=lambda error: float((error**2).sum()))
    return best.ravel()


def _turns_over(thing: Primitive) -> bool:
    """Whether the solid can be told upside down: a cone that ends in a point can't."""
    return isinstance(thing, Cylinder | Tube | Prism) or (
        isinstance(thing, Cone) and thing.top_radius > 0
    )


def _nearest_box(true: Array, found: Array) -> Retold:
    best = None
    for order in permutations(range(3)):
        for signs in product((1.0, -1.0), repeat=3):
            turned = found[:, order] * signs
            if np.linalg.det(turned) < 0:
                continue
            rotation = _rotation_angle(turned @ true.T)
            if best is None or rotation < (best.rotation or 0.0):
                tilt = _angle(turned[:, 2], true[:, 2])
                best = Retold(turned, list(order), tilt, rotation)
    assert best is not None
    return best


def _corners(prism: Prism) -> tuple[Array, Array]:
    """The corners of the base and those above them, (N, 3) each, in the world."""
    ends = (
        np.column_stack([prism.polygon, np.full(len(prism.polygon), side * prism.height / 2)])
        for side in (-1, 1)
    )
    base, top = (prism.world_from_object.apply(end) for end in ends)
    return base, top


def _rotation_angle(rotation: Array) -> float:
    # the sine by the skew part, the cosine by the trace: exact at both ends
    skew = [
        rotation[2, 1] - rotation[1, 2],
        rotation[0, 2] - rotation[2, 0],
        rotation[1, 0] - rotation[0, 1],
    ]
    return float(np.arctan2(np.linalg.norm(skew), np.trace(rotation) - 1))


def _angle(one: Array, other: Array) -> float:
    return float(np.arctan2(np.linalg.norm(np.cross(one, other)), one @ other))
