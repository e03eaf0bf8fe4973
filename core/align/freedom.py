# SPDX-License-Identifier: GPL-3.0-or-later
"""What holds an object in, the directions in which it may still move and change out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, Mask
from ..modelling.holding import Hold, References, holds_of
from ..modelling.solid import Solid
from ..primitives import Primitive
from ..rotation import hat

# steps of Newton's method back onto what holds an object, and when it has arrived, metres
RETURNS, ARRIVED = 4, 1e-10
# of the largest singular value, below which two conditions are one
SAME_CONDITION = 1e-9
# by which factors an alignment may change a size: beyond, the rough model was another object's
LEAST_SHARE, MOST_SHARE = 0.72, 1.3


@dataclass(frozen=True, eq=False)
class Freedom:
    """The conditions on one object while all others stand still.

    `holds` are its relations, `known` the values of the sizes that were typed, by their place in
    the tangent (6 + P,).
    """

    thing: Primitive
    holds: tuple[Hold, ...]
    known: Mapping[int, float]
    others: Mapping[str, Primitive]
    references: References

    @staticmethod
    def of(thing: Primitive, things: Sequence[Primitive], references: References) -> Freedom:
        """Of an object among all. Raises InvalidValue for a relation to what is not there."""
        holds = holds_of(thing, references, [t.name for t in things])
        places = {6 + i: name for i, name in enumerate(thing.size_names)}
        known = {i: thing.known[name] for i, name in places.items() if name in thing.known}
        return Freedom(thing, holds, known, {t.name: t for t in things}, references)

    def basis(self, solid: Solid) -> Array:
        """Orthonormal columns (6 + P, F): the motions that keep every condition, to first order."""
        conditions = np.vstack([self._rows(solid)[1], _idle(solid)])
        extent = _extent(solid)
        scale = np.concatenate([np.full(3, 1 / extent), np.ones(len(conditions[0]) - 3)])
        _, values, vt = np.linalg.svd(conditions * scale)
        rank = int((values > SAME_CONDITION * max(values.max(initial=0.0), 1e-300)).sum())
        basis: Array = scale[:, None] * vt[rank:].T
        return basis

    def basis_like(self, solid: Solid, other: Array) -> Array:
        """The basis of `solid` whose columns are nearest to those of another (6 + P, F)."""
        own = self.basis(solid)
        if own.shape != other.shape:
            return own
        nearest: Array = own @ np.linalg.lstsq(own, other, rcond=None)[0]
        return nearest

    def possible(self, parameters: Array) -> Mask:
        """Which parameters (..., P) have sizes not far from the object's own."""
        share = parameters[..., : len(self.thing.sizes)] / np.maximum(self.thing.sizes, 1e-9)
        near: Mask = ((share > LEAST_SHARE) & (share < MOST_SHARE)).all(axis=-1)
        return near

    def kept(self, solid: Solid) -> Solid:
        """The nearest solid that keeps every condition."""
        for _ in range(RETURNS):
            values, rows = self._rows(solid)
            if not len(values) or np.abs(values).max() < ARRIVED:
                break
            solid = solid.moved(-np.linalg.lstsq(rows, values, rcond=1e-9)[0])
        return solid

    def _rows(self, solid: Solid) -> tuple[Array, Array]:
        count = 6 + len(solid.parameters)
        values, rows = [np.zeros(0)], [np.zeros((0, count))]
        if self.holds:
            things = {**self.others, self.thing.name: solid.applied(self.thing)}
            for hold in self.holds:
                held = hold.rows(things, self.references)
                values.append(held.values)
                rows.append(held.by_own)
        for place, value in self.known.items():
            values.append(np.array([solid.parameters[place - 6] - value]))
            rows.append(np.eye(count)[[place]])
        return np.concatenate(values), np.vstack(rows)


def _idle(solid: Solid) -> Array:
    """Motions (K, 6 + P) that change nothing: a round thing turning about itself."""
    count = 6 + len(solid.parameters)
    if solid.kind == "sphere":
        return np.eye(count)[:3]
    if solid.kind in ("cylinder", "cone", "tube"):
        row = np.zeros((1, count))
        row[0, :3] = solid.rotation[:, 2]
        return row
    if solid.kind == "prism":
        return _idle_polygon(solid)
    return np.zeros((0, count))


def _idle_polygon(solid: Solid) -> Array:
    """A polygon is moved and turned by its pose alone."""
    corners = solid.parameters[1:].reshape(-1, 2)
    rows = np.zeros((3, 6 + len(solid.parameters)))
    rows[0, 7::2] = rows[1, 8::2] = 1.0
    rows[2, 7:] = (corners @ hat([0.0, 0.0, 1.0])[:2, :2].T).ravel()
    return rows


def _extent(solid: Solid) -> float:
    return float(max(np.abs(solid.parameters).max(), 1e-6))
