# SPDX-License-Identifier: GPL-3.0-or-later
"""Solids that Bullet has no shape for as convex pieces, never smaller than the solid.

A round side is replaced by planes that touch it from outside, and a hole's by chords of it: what is
kept clear of the pieces is kept clear of the solid. With 96 sides the outside is 0.05 % of the
radius too wide, the hole of a tube with 48 pieces 0.2 % of its radius too narrow.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...core.arrays import Array
from ...core.errors import InvalidValue
from ...core.primitives import Cone, Primitive, Prism, Tube
from ...core.shape.polygons import convex_pieces

SIDES, TUBE_PIECES = 96, 48


def pieces_of(thing: Primitive) -> list[Array]:
    """The corners (N, 3) of each convex piece of a cone, tube or prism, in the object's frame.

    Raises InvalidValue for another kind.
    """
    if isinstance(thing, Cone):
        half = thing.height / 2
        ends = [_around(thing.radius, -half), _around(thing.top_radius, half)]
        return [np.concatenate([ends[0], ends[1][: 1 if thing.top_radius == 0 else None]])]
    if isinstance(thing, Tube):
        return [_extruded(outline, thing.height) for outline in _sectors(thing)]
    if isinstance(thing, Prism):
        return [
            _extruded(thing.polygon[piece], thing.height) for piece in convex_pieces(thing.polygon)
        ]
    raise InvalidValue(f"{thing.name}: a {thing.kind} is not made of pieces; export it as a mesh")


def pieces_text(pieces: Sequence[Array]) -> str:
    """The pieces as Wavefront OBJ, one object each: PyBullet makes a convex hull of every one."""
    lines, before = [], 1
    for i, corners in enumerate(pieces):
        lines.append(f"o piece{i}")
        lines += [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in corners]
        # only the corners count for a hull; any faces that use them all will do
        count = len(corners)
        lines += [f"f {before} {before + j} {before + j + 1}" for j in range(1, count - 1)]
        before += count
    return "\n".join(lines) + "\n"


def _around(radius: float, level: float) -> Array:
    turn = np.arange(SIDES) * (2 * np.pi / SIDES)
    wide = radius / np.cos(np.pi / SIDES)
    return np.stack([wide * np.cos(turn), wide * np.sin(turn), np.full(SIDES, level)], axis=1)


def _sectors(tube: Tube) -> list[Array]:
    """Each piece's outline (5, 2): a chord of the hole, and two tangents of the outside."""
    step = 2 * np.pi / TUBE_PIECES
    wide = tube.radius / np.cos(step / 4)
    outlines = []
    for start in np.arange(TUBE_PIECES) * step:
        outer, inner = start + step * np.array([0, 0.5, 1]), start + step * np.array([1, 0])
        outlines.append(np.concatenate([wide * _unit(outer), tube.inner_radius * _unit(inner)]))
    return outlines


def _unit(turn: Array) -> Array:
    return np.stack([np.cos(turn), np.sin(turn)], axis=1)


def _extruded(outline: Array, height: float) -> Array:
    return np.concatenate(
        [np.column_stack([outline, np.full(len(outline), z)]) for z in (-height / 2, height / 2)]
    )
