# SPDX-License-Identifier: GPL-3.0-or-later
"""What holds an object in, the orientations worth trying out.

One direction held leaves a turn about it, a right angle two turns, nothing all three.
"""

from __future__ import annotations

import numpy as np

from ...arrays import Array
from .held import ROUND, Grip, Held
from .own_parts import own_part
from .seen import HEIGHT

TURNS = 36
# directions all over the sphere, about 20 degrees apart
DIRECTIONS = 72
AXIS = np.array([0.0, 0.0, 1.0])


def orientations(held: Held, turns: int = TURNS) -> Array:
    """Rotations (M, 3, 3) of the object in the world."""
    # what a turn about the axis changes, a prism's polygon takes up
    is_round = held.kind in (*ROUND, "prism")
    for grip in held.grips:
        pairs = _parallels(held, grip)
        if pairs:
            count = 1 if is_round else turns
            return np.concatenate([_about(own, to, count) for own, to in pairs])
    about = 1 if is_round else turns // 2
    for grip in held.grips:
        across = _across(held, grip)
        if across is not None:
            own, ring = across
            return np.concatenate([_about(own, to, about) for to in ring])
    return np.concatenate([_about(AXIS, to, about) for to in sphere(DIRECTIONS)])


def sphere(count: int) -> Array:
    """Unit vectors (count, 3) evenly over the sphere (a Fibonacci lattice)."""
    i = np.arange(count) + 0.5
    z = 1 - 2 * i / count
    turn = np.pi * (1 + np.sqrt(5)) * i
    flat = np.sqrt(1 - z**2)
    return np.stack([flat * np.cos(turn), flat * np.sin(turn), z], axis=1)


def ring(direction: Array, count: int) -> Array:
    """Unit vectors (count, 3) at right angles to a direction."""
    frame = turned_to(AXIS, direction)
    angle = 2 * np.pi * np.arange(count) / count
    flat = np.stack([np.cos(angle), np.sin(angle), np.zeros(count)], axis=1)
    around: Array = flat @ frame.T
    return around


def turned_to(own: Array, to: Array) -> Array:
    """A rotation (3, 3) that takes unit `own` to unit `to` by the shortest way."""
    cosine = float(own @ to)
    if cosine < -1 + 1e-12:
        side = np.cross(own, np.eye(3)[int(np.argmin(np.abs(own)))])
        side = side / np.linalg.norm(side)
        return 2 * np.outer(side, side) - np.eye(3)
    total = own + to
    rotation: Array = np.outer(total, total) / (1 + cosine) - np.eye(3)
    # two half turns: about own, then about the middle of the two
    return rotation @ (2 * np.outer(own, own) - np.eye(3))


def _about(own: Array, to: Array, count: int) -> Array:
    """`own` turned to `to`, then in `count` steps about that, (count, 3, 3)."""
    first, frame = turned_to(own, to), turned_to(AXIS, to)
    angle = 2 * np.pi * np.arange(count) / count
    turns = np.zeros((count, 3, 3))
    turns[:, 0, 0] = turns[:, 1, 1] = np.cos(angle)
    turns[:, 1, 0], turns[:, 0, 1] = np.sin(angle), -np.sin(angle)
    turns[:, 2, 2] = 1.0
    result: Array = frame @ turns @ frame.T @ first
    return result


def _parallels(held: Held, grip: Grip) -> list[tuple[Array, Array]]:
    """Pairs (own direction, direction in the world) that a grip holds together."""
    to = grip.to.direction
    if grip.flush is not None:
        own = own_part(held.kind, held.parameters, grip.flush).direction
        if own is None:
            return []
        # a floor's normal points up; a wall's may point into the room or out of it
        return [(own, -to)] if grip.kind == "stands_on" else [(own, -to), (own, to)]
    if grip.kind == "parallel":
        own = own_part(held.kind, held.parameters, grip.own or "axis").direction
        return [] if own is None else [(own, to), (own, -to)]
    return []


def _across(held: Held, grip: Grip) -> tuple[Array, Array] | None:
    """An own direction and those it may take, for a grip that holds it at a right angle."""
    to = grip.to.direction
    if grip.kind == "perpendicular":
        own = own_part(held.kind, held.parameters, grip.own or "axis").direction
        return None if own is None else (own, ring(to, TURNS // 2))
    if grip.kind == "lies_on" and held.kind in HEIGHT:
        return AXIS, ring(to, TURNS // 2)
    side = None if grip.flush is None else own_part(held.kind, held.parameters, grip.flush)
    if held.kind == "prism" and side is not None and side.direction is None:
        return AXIS, ring(to, TURNS)
    return None
