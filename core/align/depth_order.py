# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects and a camera in, which of them stand before which others in the picture out."""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np

from ..arrays import Array
from ..camera import Camera
from ..modelling.solid import Solid
from ..primitives import Primitive
from ..shape.hits import hits
from .hypotheses import hull_points

# a rough outline may be this far off, pixels
NEAR_PIXELS = 12.0


def hull_of(solid: Solid, camera: Camera) -> Array | None:
    """The corners (M, 2) of a solid's outline in pixels, float32; None where it is not imaged."""
    points = hull_points(solid, np.zeros((1, 6 + len(solid.parameters))), camera)[0]
    if not np.isfinite(points).all():
        return None
    return np.asarray(cv2.convexHull(points.astype(np.float32))[:, 0])


def in_front(things: Sequence[Primitive], camera: Camera) -> list[set[int]]:
    """Of each object, the indices of those that may hide a part of it."""
    hulls = [hull_of(Solid.of(thing), camera) for thing in things]
    away = [float(np.linalg.norm(camera.pose.apply(_foot(thing)))) for thing in things]
    before: list[set[int]] = [set() for _ in things]
    for i in range(len(things)):
        for j in range(i):
            one, other = hulls[i], hulls[j]
            if one is None or other is None or not _near(one, other):
                continue
            nearer = _nearer(things[i], things[j], one, other, camera)
            if nearer == 0:
                nearer = -1 if away[i] < away[j] else 1
            if nearer < 0:
                before[j].add(i)
            else:
                before[i].add(j)
    return before


def nearest_first(before: Sequence[set[int]], away: Sequence[float]) -> list[int]:
    """An order in which those in front come first; a circle is cut where it is nearest."""
    left, order = set(range(len(before))), list[int]()
    while left:
        free = [i for i in left if not (before[i] & left)] or list(left)
        chosen = min(free, key=lambda i: away[i])
        order.append(chosen)
        left.remove(chosen)
    return order


def _foot(thing: Primitive) -> Array:
    return thing.world_from_object.translation


def _near(one: Array, other: Array) -> bool:
    """Whether two outlines may touch."""
    low = np.maximum(one.min(axis=0), other.min(axis=0)) - NEAR_PIXELS
    high = np.minimum(one.max(axis=0), other.max(axis=0)) + NEAR_PIXELS
    return bool((low < high).all())


def _nearer(
    one: Primitive, other: Primitive, hull: Array, other_hull: Array, camera: Camera
) -> int:
    """-1 where the one is nearer on the rays that meet both, 1 the other, 0 where none does."""
    area, shared = cv2.intersectConvexConvex(hull, other_hull)
    if area <= 0 or shared is None:
        return 0
    corners = shared.reshape(-1, 2).astype(float)
    middle = corners.mean(axis=0)
    pixels = np.concatenate([middle + share * (corners - middle) for share in (0.0, 0.5, 0.9)])
    eye, rays = camera.rays_world(pixels)
    depth, other_depth = hits(one, eye, rays).depth, hits(other, eye, rays).depth
    both = np.isfinite(depth) & np.isfinite(other_depth)
    return int(np.sign(np.median((depth - other_depth)[both]))) if both.any() else 0
