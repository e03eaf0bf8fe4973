# SPDX-License-Identifier: GPL-3.0-or-later
"""Lines of equal value: a field on a grid and a level in, the line's segments out."""

from __future__ import annotations

import numpy as np

from ..arrays import Array


def iso_segments(field: Array, level: float, columns: Array, rows: Array) -> Array:
    """The segments (N, 2, 2), ends (u, v), along which a field (R, C) has the value `level`.

    Each cell of the grid is cut into two triangles, in which the field is linear and the line
    straight: no case is ambiguous. Nodes that are NaN are not crossed. The line is where the field
    is seen as equal to the level, or about to exceed it.
    """
    u, v = np.meshgrid(columns, rows)
    nodes = np.stack([u, v], axis=-1)
    corners = [(slice(0, -1), slice(0, -1)), (slice(0, -1), slice(1, None))]
    corners += [(slice(1, None), slice(1, None)), (slice(1, None), slice(0, -1))]
    values = [field[c].ravel() for c in corners]
    places = [nodes[c].reshape(-1, 2) for c in corners]
    cut = [
        _cut([values[i] for i in three], [places[i] for i in three], level)
        for three in ((0, 1, 2), (0, 2, 3))
    ]
    return np.concatenate(cut)


def _cut(values: list[Array], places: list[Array], level: float) -> Array:
    """The segments across triangles of which one corner lies on the other side than two."""
    value, place = np.stack(values, axis=1), np.stack(places, axis=1)
    whole = np.isfinite(value).all(axis=1)
    value, place = value[whole], place[whole]
    above = value > level
    alone = above.sum(axis=1)
    mixed = (alone == 1) | (alone == 2)
    value, place, above, alone = value[mixed], place[mixed], above[mixed], alone[mixed]
    # the corner that stands alone, above or below
    first = np.argmax(above == (alone == 1)[:, None], axis=1)
    index = np.arange(len(first))
    ends = []
    for step in (1, 2):
        other = (first + step) % 3
        rise = value[index, other] - value[index, first]
        share = ((level - value[index, first]) / rise)[:, None]
        ends.append(place[index, first] + share * (place[index, other] - place[index, first]))
    return np.stack(ends, axis=1)
