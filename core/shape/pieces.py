# SPDX-License-Identifier: GPL-3.0-or-later
"""Cones, tubes and prisms as convex pieces, never smaller than the solid, for collision checks.

A round side is replaced by planes that touch it from outside, and a hole's by chords of it: what is
kept clear of the pieces is kept clear of the solid. With 96 sides the outside is 0.05 % of the
radius too wide, the hole of a tube with 48 pieces 0.2 % of its radius too narrow.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..errors import InvalidValue
from ..pose import Pose
from ..primitives import Cone, Primitive, Prism, Tube
from .polygons import convex_pieces
from .tessellation import Tessellation, cone, prism

SIDES, TUBE_PIECES = 96, 48


@dataclass(frozen=True, eq=False)
class Pieces:
    """The different `shapes` of the pieces, and which of them stands where in the object's frame.

    A tube's sectors are all of one shape.
    """

    shapes: tuple[Tessellation, ...]
    placed: tuple[tuple[int, Pose], ...]

    def corners(self) -> list[Array]:
        """The corners (N, 3) of each piece in the object's frame."""
        return [pose.apply(self.shapes[number].vertices) for number, pose in self.placed]


def pieces_of(thing: Primitive) -> Pieces:
    """The convex pieces of a cone, tube or prism. Raises InvalidValue for another kind."""
    here = Pose.identity()
    if isinstance(thing, Cone):
        wide = 1 / np.cos(np.pi / SIDES)
        ends = thing.radius * wide, thing.top_radius * wide
        return Pieces((cone(*ends, thing.height, SIDES, tip_rings=1),), ((0, here),))
    if isinstance(thing, Tube):
        turns = np.arange(TUBE_PIECES) * (2 * np.pi / TUBE_PIECES)
        placed = (Pose.from_rotation_vector([0, 0, turn], np.zeros(3)) for turn in turns)
        return Pieces((prism(_sector(thing), thing.height),), tuple((0, pose) for pose in placed))
    if isinstance(thing, Prism):
        shapes = tuple(
            prism(thing.polygon[piece], thing.height) for piece in convex_pieces(thing.polygon)
        )
        return Pieces(shapes, tuple((i, here) for i in range(len(shapes))))
    raise InvalidValue(f"{thing.name}: a {thing.kind} is not made of pieces; export it as a mesh")


def _sector(tube: Tube) -> Array:
    """A piece's outline (5, 2): two tangents of the outside, and a chord of the hole."""
    step = 2 * np.pi / TUBE_PIECES
    wide = tube.radius / np.cos(step / 4)
    outer, inner = step * np.array([0, 0.5, 1]), step * np.array([1, 0])
    return np.concatenate([wide * _unit(outer), tube.inner_radius * _unit(inner)])


def _unit(turn: Array) -> Array:
    return np.stack([np.cos(turn), np.sin(turn)], axis=1)
