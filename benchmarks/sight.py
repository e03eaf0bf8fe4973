# SPDX-License-Identifier: GPL-3.0-or-later
"""Eyes for an honest hand: an eye point and solids in, which points of the cell it can see out.

A tester of its own, sharing nothing with what is measured: rays against boxes, cylinders and balls.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from monocell.core.primitives import Box, Cylinder, Primitive, Sphere

# what lies this little behind a point's place counts as that point, metres
SKIN = 3e-4


def seen(eye: np.ndarray, points: np.ndarray, things: Sequence[Primitive]) -> np.ndarray:
    """Which points (N, 3) no thing stands in front of, (N,)."""
    way = points - eye
    distance = np.linalg.norm(way, axis=1)
    first = first_hits(eye, way / distance[:, None], things)[0]
    return first > distance - SKIN


def first_hits(
    eye: np.ndarray, rays: np.ndarray, things: Sequence[Primitive]
) -> tuple[np.ndarray, np.ndarray]:
    """How far along unit rays (N, 3) the first thing is met, and its index; infinity and -1."""
    nearest, which = np.full(len(rays), np.inf), np.full(len(rays), -1)
    for i, thing in enumerate(things):
        hit = _entered(thing, eye, rays)
        closer = hit < nearest
        nearest[closer], which[closer] = hit[closer], i
    return nearest, which


def seen_shares(
    eye: np.ndarray, rays: np.ndarray, things: Sequence[Primitive]
) -> tuple[np.ndarray, np.ndarray]:
    """Of each thing: the rays (N, 3) that would meet it, and the share that no other is before."""
    _, which = first_hits(eye, rays, things)
    alone = np.array([np.isfinite(_entered(thing, eye, rays)).sum() for thing in things])
    kept = np.array([(which == i).sum() for i in range(len(things))])
    return alone, kept / np.maximum(alone, 1)


def _entered(thing: Primitive, eye: np.ndarray, rays: np.ndarray) -> np.ndarray:
    """Where rays enter a solid that the eye is outside of; infinity for a miss."""
    object_from_world = thing.world_from_object.inverse()
    start, way = object_from_world.apply(eye), object_from_world.rotate(rays)
    with np.errstate(divide="ignore", invalid="ignore"):
        if isinstance(thing, Box):
            spans = [_slab(start[i], way[:, i], thing.half_extent[i]) for i in range(3)]
        elif isinstance(thing, Cylinder):
            spans = [_round(start[:2], way[:, :2], thing.radius)]
            spans.append(_slab(start[2], way[:, 2], thing.height / 2))
        elif isinstance(thing, Sphere):
            spans = [_round(start, way, thing.radius)]
        else:
            raise TypeError(f"{thing.name}: a {thing.kind} can't be looked at here")
    enter = np.max([low for low, _ in spans], axis=0)
    leave = np.min([high for _, high in spans], axis=0)
    return np.where((enter < leave) & (enter > 0), enter, np.inf)


def _slab(start: float, way: np.ndarray, half: float) -> tuple[np.ndarray, np.ndarray]:
    a, b = (-half - start) / way, (half - start) / way
    return np.minimum(a, b), np.maximum(a, b)


def _round(start: np.ndarray, way: np.ndarray, radius: float) -> tuple[np.ndarray, np.ndarray]:
    """In two dimensions a cylinder's side, in three a ball."""
    square, half = (way**2).sum(axis=1), way @ start
    root = np.sqrt(half**2 - square * (start @ start - radius**2))
    missed = np.isnan(root)
    low, high = (-half - root) / square, (-half + root) / square
    return np.where(missed, np.inf, low), np.where(missed, -np.inf, high)
