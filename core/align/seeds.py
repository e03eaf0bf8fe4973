# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture in, the parts that edges enclose and what neighbouring parts make together out.

A face of a thing is enclosed by sharp edges; two or three faces that lie beside each other may be
one thing, and so may all the squares of its pattern.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import cv2
import numpy as np

from ..arrays import Mask
from ..picture.pictures import Picture
from .sight import PictureSight
from .window import Window

# seeds are looked for at so much less than the picture's resolution
STEP = 2
# an edge from this weight on; edges have gaps so wide that are none, pixels
EDGE = 0.1
GAPS = np.ones((5, 5), dtype=np.uint8)
# a seed is so large, in pixels of the picture, and at most this share of it
LEAST_PIXELS, MOST_SHARE = 60, 0.06
RIM = 3
# parts this near are neighbours: an edge is between them
BETWEEN = np.ones((5, 5), dtype=np.uint8)
# a thing is so large, pixels, and covers so much of its hull
LEAST_THING, CONVEX = 300, 0.9


@dataclass(frozen=True, eq=False)
class Seed:
    """Where a thing may be: `mask` (rows, columns) of `window`, and how it was found."""

    mask: Mask
    window: Window
    why: str


def seeds(sight: PictureSight, taken: Picture) -> list[Seed]:
    """What things may cover; `taken` (H, W) is 1 where they are known already."""
    height, width = sight.encoded.shape[:2]
    window = Window(0, 0, STEP, width // STEP, height // STEP)
    weight = sight.edges.structure[..., 0] + sight.edges.structure[..., 2]
    lines = cv2.dilate((weight > EDGE).astype(np.uint8), GAPS)
    parts = _parts(((lines == 0) & (taken == 0)).astype(np.uint8), window)
    found = []
    for chosen in _together(_neighbours(parts)):
        mask = _joined([parts[i] for i in chosen])
        if _convex(mask):
            many = f"edges enclose its {len(chosen)} parts"
            found.append(Seed(mask, window, "edges enclose it" if len(chosen) == 1 else many))
    return found


def _parts(mask: Picture, window: Window) -> list[Mask]:
    """Connected parts of fitting size that do not touch the picture's rim, in the window."""
    height, width = mask.shape
    count, labels, stats, _ = cv2.connectedComponentsWithStats(mask, connectivity=4)
    small = labels[: window.rows * STEP : STEP, : window.columns * STEP : STEP]
    parts = []
    for i in range(1, count):
        x, y, wide, tall, area = stats[i]
        inside = x > RIM and y > RIM and x + wide < width - RIM and y + tall < height - RIM
        if inside and LEAST_PIXELS <= area <= MOST_SHARE * mask.size:
            parts.append(np.asarray(small == i))
    return parts


def _neighbours(parts: list[Mask]) -> dict[int, set[int]]:
    """Of each part, those beside it."""
    wide = [cv2.dilate(part.astype(np.uint8), BETWEEN) > 0 for part in parts]
    beside: dict[int, set[int]] = {i: set() for i in range(len(parts))}
    for i, j in combinations(range(len(parts)), 2):
        if (wide[i] & wide[j]).any():
            beside[i].add(j)
            beside[j].add(i)
    return beside


def _together(beside: dict[int, set[int]]) -> list[tuple[int, ...]]:
    """Which parts may be one thing: each, connected twos and threes, and all that hang together."""
    chosen: set[tuple[int, ...]] = {(i,) for i in beside}
    chosen |= {(i, j) for i in beside for j in beside[i] if i < j}
    chosen |= {
        (a, b, c)
        for i in beside
        for j in beside[i]
        for k in (beside[i] | beside[j]) - {i, j}
        for a, b, c in [sorted((i, j, k))]
    }
    left = set(beside)
    while left:
        group, edge = set[int](), {left.pop()}
        while edge:
            group |= edge
            edge = {j for i in edge for j in beside[i]} - group
        left -= group
        chosen.add(tuple(sorted(group)))
    return sorted(chosen)


def _convex(mask: Mask) -> bool:
    """Whether a part of the picture is about as large as its hull, as boxes and cylinders are."""
    contours, _ = cv2.findContours(
        mask.astype(np.uint8), cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_SIMPLE
    )
    corners = np.concatenate(contours)
    hull = np.zeros(mask.shape, dtype=np.uint8)
    cv2.fillConvexPoly(hull, cv2.convexHull(corners), (1,))
    area = int(hull.sum())
    return area * STEP**2 >= LEAST_THING and bool(mask.sum() >= CONVEX * area)


def _joined(parts: list[Mask]) -> Mask:
    """Parts as one, with the edges between and half of those around."""
    whole = np.any(parts, axis=0).astype(np.uint8)
    closed = cv2.morphologyEx(whole, cv2.MORPH_CLOSE, BETWEEN)
    return np.asarray(cv2.dilate(closed, BETWEEN) > 0)
