# SPDX-License-Identifier: GPL-3.0-or-later
"""Simple polygons (N, 2), anticlockwise, in; triangles, convex pieces and what crosses out."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, Mask
from ..errors import InvalidValue

Indices = NDArray[np.int32]


def crossing_sides(polygon: Array) -> tuple[int, int] | None:
    """Two sides that cross, touch or fold back on each other; None for a simple polygon.

    Side i goes from corner i to corner i + 1. A corner given twice folds back on itself.
    """
    count = len(polygon)
    after = np.roll(polygon, -1, axis=0)
    along = after - polygon
    turn, ahead = _cross(along, np.roll(along, -1, axis=0)), (along * np.roll(along, -1, 0)).sum(1)
    folded = np.flatnonzero((turn == 0) & (ahead <= 0))
    if len(folded):
        return int(folded[0]), (int(folded[0]) + 1) % count
    # [i, j]: on which side of side i the ends of side j lie
    starts = _cross(along[:, None], polygon[None] - polygon[:, None])
    ends = _cross(along[:, None], after[None] - polygon[:, None])
    parted = np.sign(starts) * np.sign(ends) <= 0
    index = np.arange(count)
    apart = np.abs(index[:, None] - index[None])
    far = (apart > 1) & (apart < count - 1)
    met = parted & parted.T & far & _boxes_meet(polygon, after)
    if not met.any():
        return None
    i, j = np.argwhere(met)[0]
    return int(i), int(j)


def polygon_area(polygon: Array) -> float:
    """The area, negative for a clockwise polygon."""
    return float(_cross(polygon, np.roll(polygon, -1, axis=0)).sum() / 2)


def is_convex(polygon: Array) -> bool:
    """Whether no corner of an anticlockwise polygon turns clockwise."""
    along = np.roll(polygon, -1, axis=0) - polygon
    return bool((_cross(along, np.roll(along, -1, axis=0)) >= 0).all())


def triangulated(polygon: Array) -> Indices:
    """Triangles (N - 2, 3) of corner numbers, anticlockwise, by cutting ears (Meisters 1975).

    The ear of the widest smallest angle goes first, which leaves no slivers where there is a
    choice. Raises InvalidValue for a polygon that crosses itself.
    """
    left, found = list(range(len(polygon))), []
    while len(left) > 3:
        ear = _best_ear(polygon[left])
        before, after = left[ear - 1], left[(ear + 1) % len(left)]
        found.append((before, left.pop(ear), after))
    return np.array([*found, tuple(left)], dtype=np.int32)


def convex_pieces(polygon: Array) -> list[list[int]]:
    """The polygon cut into convex ones, each as corner numbers in order round.

    Triangles are joined across their diagonals as long as that leaves a convex piece, which makes
    at most four times as many as the fewest (Hertel and Mehlhorn 1983).
    """
    if is_convex(polygon):
        return [list(range(len(polygon)))]
    pieces = [triangle.tolist() for triangle in triangulated(polygon)]
    joined = True
    while joined:
        joined = False
        for i in range(len(pieces)):
            for j in range(i + 1, len(pieces)):
                union = _joined(pieces[i], pieces[j])
                if union is not None and is_convex(polygon[union]):
                    pieces[i] = union
                    del pieces[j]
                    joined = True
                    break
            if joined:
                break
    return pieces


def _best_ear(polygon: Array) -> int:
    before, after = np.roll(polygon, 1, axis=0), np.roll(polygon, -1, axis=0)
    quality = _smallest_sine(before, polygon, after)
    for i in np.argsort(-quality):
        if quality[i] > 0 and not _covers_a_corner(polygon, int(i)):
            return int(i)
    raise InvalidValue("polygon: has no ear to cut, so it crosses itself; give a simple polygon")


def _smallest_sine(a: Array, b: Array, c: Array) -> Array:
    """The smallest sine of the angles of triangles (N, 2) each; negative for clockwise ones."""
    area = _cross(b - a, c - b)
    lengths = np.sort([np.linalg.norm(v, axis=1) for v in (b - a, c - b, a - c)], axis=0)
    # the smallest angle lies between the two longest sides
    sine: Array = area / np.maximum(lengths[1] * lengths[2], 1e-300)
    return sine


def _covers_a_corner(polygon: Array, ear: int) -> bool:
    """Whether another corner lies in the ear's triangle or on its border."""
    count = len(polygon)
    corners = polygon[[ear - 1, ear, (ear + 1) % count]]
    others = np.delete(polygon, [(ear - 1) % count, ear, (ear + 1) % count], axis=0)
    inside = np.ones(len(others), bool)
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        inside &= _cross(b - a, others - a) >= 0
    return bool(inside.any())


def _joined(one: list[int], other: list[int]) -> list[int] | None:
    """Two pieces that share a side as one; None when they share none."""
    for i, a in enumerate(one):
        b = one[(i + 1) % len(one)]
        if b in other and other[(other.index(b) + 1) % len(other)] == a:
            start = other.index(a)
            beyond = other[start + 1 :] + other[:start]
            # from b round `one` to a, then round `other` back to b
            return [*one[i + 1 :], *one[: i + 1], *beyond[: len(other) - 2]]
    return None


def _boxes_meet(starts: Array, ends: Array) -> Mask:
    low, high = np.minimum(starts, ends), np.maximum(starts, ends)
    meet: Mask = ((low[:, None] <= high[None]) & (low[None] <= high[:, None])).all(axis=-1)
    return meet


def _cross(a: Array, b: Array) -> Array:
    product: Array = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    return product
