# SPDX-License-Identifier: GPL-3.0-or-later
"""Where round things of any size may stand in a picture: pixels in, rough circles out, best first.

Every edge pixel votes along its gradient, both ways, for the centres of circles that it may lie
on (Ballard 1981, with the radius as third dimension). A pyramid keeps the radii between 9 and 18
pixels of its level, so that a ball of 8 pixels and one of 400 cost the same few passes.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from ..arrays import Array

LEVEL_RADII = 9.0 * 2 ** (np.arange(8) / 7)
# balls smaller than that are looked for in the full picture too
SMALL_RADII = np.array([6.0, 6.9, 7.9])
# gradients below this many times the median one are texture or noise
EDGE_OVER_MEDIAN = 3.0
WEAKEST_EDGE, STRONGEST_THRESHOLD = 16.0, 48.0
# more edges than this share of the pixels is texture: only the strongest vote
LARGEST_EDGE_SHARE = 0.04
# votes are gathered in bins of two pixels, over two bins by two
BIN, GATHERED = 2.0, 4.0
CANDIDATES_PER_LEVEL = 6

Grey = NDArray[Any]


@dataclass(frozen=True)
class Circle:
    """A rough circle in pixels; `support` is the share of its outline that has edges, up to 1."""

    u: float
    v: float
    radius: float
    support: float


def vote_for_circles(
    picture: Grey, smallest: float = 6.0, largest: float | None = None
) -> list[Circle]:
    """Rough circles in an 8-bit picture (H, W, 3), radii in pixels from `smallest` to `largest`."""
    biggest = largest or 0.6 * max(picture.shape[:2])
    found: list[Circle] = []
    scale, level = 1.0, np.asarray(picture)
    # the full picture votes by its brightness alone: colour is coarser, and costs three times more
    bright = cv2.cvtColor(level, cv2.COLOR_BGR2GRAY) if level.ndim == 3 else level
    while LEVEL_RADII[0] * scale <= biggest and min(level.shape[:2]) >= 16:
        if LEVEL_RADII[-1] * scale >= smallest:
            radii = np.concatenate([SMALL_RADII, LEVEL_RADII]) if scale == 1 else LEVEL_RADII
            found += [
                # a level's pixel (0, 0) covers the middle of the block it was averaged from
                Circle(
                    c.u * scale + (scale - 1) / 2,
                    c.v * scale + (scale - 1) / 2,
                    c.radius * scale,
                    c.support,
                )
                for c in _on_one_level(bright if scale == 1 else level, radii)
            ]
        half = (level.shape[1] // 2, level.shape[0] // 2)
        level = cv2.resize(level[: half[1] * 2, : half[0] * 2], half, interpolation=cv2.INTER_AREA)
        scale *= 2
    return _distinct(sorted(found, key=lambda c: -c.support * np.sqrt(c.radius)))


def _on_one_level(picture: Grey, radii: Array) -> list[Circle]:
    u, v, nu, nv = _edge_pixels(picture)
    if len(u) < 8:
        return []
    margin = int(radii[-1] / BIN) + 2
    height, width = (int(n / BIN) + 2 * margin + 1 for n in picture.shape[:2])
    best = np.zeros((height, width), dtype=np.float32)
    radius_of_best = np.zeros((height, width), dtype=np.float32)
    u, v, nu, nv = u / BIN + margin, v / BIN + margin, nu / BIN, nv / BIN
    for radius in radii.astype(np.float32):
        du, dv = radius * nu, radius * nv
        x = np.concatenate([u + du, u - du]).astype(np.int32)
        y = np.concatenate([v + dv, v - dv]).astype(np.int32)
        votes = np.bincount(y * width + x, minlength=height * width).astype(np.float32)
        support = cv2.boxFilter(
            votes.reshape(height, width), -1, (2, 2), anchor=(0, 0), normalize=False
        )
        support = np.divide(support, 2 * np.pi * radius, dtype=np.float32)
        better = support > best
        best[better], radius_of_best[better] = support[better], radius
    return _peaks(best, radius_of_best, margin)


def _edge_pixels(picture: Grey) -> tuple[NDArray[np.float32], ...]:
    """Thin edges: u, v and the unit gradient, of the channel that changes most."""
    smooth = cv2.GaussianBlur(picture, (5, 5), 0.9)
    du = cv2.Sobel(smooth, cv2.CV_16S, 1, 0, ksize=3)
    dv = cv2.Sobel(smooth, cv2.CV_16S, 0, 1, ksize=3)
    if du.ndim == 3:
        du, dv = _strongest_channel(du, dv)
    sampled = np.abs(du[::3, ::3].astype(np.float32)) + np.abs(dv[::3, ::3].astype(np.float32))
    over_median = EDGE_OVER_MEDIAN * float(np.median(sampled)) / np.sqrt(2)
    weakest = float(np.clip(over_median, WEAKEST_EDGE, STRONGEST_THRESHOLD))
    # an edge is about three pixels wide before it is thinned
    texture = float(np.quantile(sampled, 1 - 3 * LARGEST_EDGE_SHARE))
    weakest = max(weakest, texture / np.sqrt(2))
    edges = cv2.Canny(du, dv, weakest, 1.5 * weakest, L2gradient=True)
    v, u = np.nonzero(edges)
    gu, gv = du[v, u].astype(np.float32), dv[v, u].astype(np.float32)
    norm = np.maximum(np.hypot(gu, gv), 1e-6)
    return u.astype(np.float32), v.astype(np.float32), gu / norm, gv / norm


def _strongest_channel(du: NDArray[Any], dv: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    strength = np.abs(du) + np.abs(dv)
    best_u, best_v, best = du[..., 0], dv[..., 0], strength[..., 0]
    for channel in range(1, du.shape[2]):
        stronger = strength[..., channel] > best
        best_u = np.where(stronger, du[..., channel], best_u)
        best_v = np.where(stronger, dv[..., channel], best_v)
        best = np.maximum(best, strength[..., channel])
    return np.ascontiguousarray(best_u), np.ascontiguousarray(best_v)


def _peaks(
    best: NDArray[np.float32], radius_of_best: NDArray[np.float32], margin: int
) -> list[Circle]:
    local = (best == cv2.dilate(best, np.ones((5, 5), np.uint8))) & (best > 0.25)
    v, u = np.nonzero(local)
    # the longer the outline, the less its support is by chance
    strength = best[v, u] * np.sqrt(radius_of_best[v, u])
    order = np.argsort(-strength)[:CANDIDATES_PER_LEVEL]
    middle = GATHERED / 2 - 0.5
    return [
        Circle(
            float((u[i] - margin) * BIN + middle),
            float((v[i] - margin) * BIN + middle),
            float(radius_of_best[v[i], u[i]]),
            float(best[v[i], u[i]]),
        )
        for i in order
    ]


def _distinct(circles: list[Circle]) -> list[Circle]:
    """The same circle is found on two levels: keep the one with more support."""
    kept: list[Circle] = []
    for c in circles:
        if not any(
            np.hypot(c.u - k.u, c.v - k.v) < 0.2 * k.radius and 0.83 < c.radius / k.radius < 1.2
            for k in kept
        ):
            kept.append(c)
    return kept
