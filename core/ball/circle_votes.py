# SPDX-License-Identifier: GPL-3.0-or-later
"""Where round things of any size may stand in a picture: pixels in, rough circles out, best first.

Every edge pixel votes along its gradient, both ways, for the centres of circles that it may lie
on (Ballard 1981, with the radius as third dimension). A pyramid keeps the radii between 6 and 18
pixels of its level, so that a ball of 8 pixels and one of 400 cost the same few passes.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from ..arrays import Array

# a step of two pixels keeps all of a circle's votes within two bins
LEVEL_RADII = np.arange(6.0, 19.0, 2.0)
# gradients below this many times the median one are texture or noise
EDGE_OVER_MEDIAN = 3.0
WEAKEST_EDGE, STRONGEST_THRESHOLD = 16.0, 48.0
# more edges than this share of the pixels is texture: only the strongest vote
LARGEST_EDGE_SHARE = 0.04
# votes are gathered in bins of two pixels, over two bins by two
BIN, GATHERED = 2.0, 4.0
CANDIDATES_PER_LEVEL, MOST_PER_LEVEL = 10, 200
# radii whose votes are within this share of the most are a peak's
RADII_ALIKE = 0.6
# cells and votes that stay in the processor's cache
MOST_AT_ONCE = 1 << 18
# pixels that tell how strong edges are
SAMPLED = 40000

Grey = NDArray[Any]


@dataclass(frozen=True)
class Circle:
    """A rough circle in pixels; `support` is the share of its outline that has edges, up to 1."""

    u: float
    v: float
    radius: float
    support: float


def vote_for_circles(
    picture: Grey,
    smallest: float = 6.0,
    largest: float | None = None,
    per_level: int = CANDIDATES_PER_LEVEL,
) -> list[Circle]:
    """Rough circles in an 8-bit picture (H, W, 3), radii in pixels from `smallest` to `largest`.

    Of each level of the pyramid the best `per_level` are kept, whatever others hold.
    """
    biggest = largest or 0.6 * max(picture.shape[:2])
    found: list[Circle] = []
    scale, level = 1.0, np.asarray(picture)
    # the full picture votes by its brightness alone: colour is coarser, and costs three times more
    bright = cv2.cvtColor(level, cv2.COLOR_BGR2GRAY) if level.ndim == 3 else level
    while LEVEL_RADII[0] * scale <= biggest and min(level.shape[:2]) >= 16:
        if LEVEL_RADII[-1] * scale >= smallest:
            found += [
                # a level's pixel (0, 0) covers the middle of the block it was averaged from
                Circle(
                    c.u * scale + (scale - 1) / 2,
                    c.v * scale + (scale - 1) / 2,
                    c.radius * scale,
                    c.support,
                )
                for c in _on_one_level(bright if scale == 1 else level, per_level)
            ]
        half = (level.shape[1] // 2, level.shape[0] // 2)
        level = cv2.resize(level[: half[1] * 2, : half[0] * 2], half, interpolation=cv2.INTER_AREA)
        scale *= 2
    return _distinct(sorted(found, key=lambda c: -c.support * np.sqrt(c.radius)))


def _on_one_level(picture: Grey, count: int) -> list[Circle]:
    radii = LEVEL_RADII
    u, v, nu, nv = edge_pixels(picture)
    if len(u) < 8:
        return []
    margin = int(radii[-1] / BIN) + 2
    height, width = (int(n / BIN) + 2 * margin + 1 for n in picture.shape[:2])
    u, v = (np.concatenate([at, at]) / BIN + margin for at in (u, v))
    nu, nv = (np.concatenate([way, -way]) / BIN for way in (nu, nv))
    layers = np.empty((len(radii), height, width), np.uint8)
    best = np.zeros((height, width), np.float32)
    at_once = max(1, MOST_AT_ONCE // max(len(u), height * width))
    for first in range(0, len(radii), at_once):
        some = radii[first : first + at_once, None].astype(np.float32)
        cells = (v + some * nv).astype(np.int32)
        cells += np.arange(len(some), dtype=np.int32)[:, None] * height
        cells *= width
        cells += (u + some * nu).astype(np.int32)
        votes = np.bincount(cells.ravel(), minlength=len(some) * height * width)
        layers[first : first + at_once] = votes.astype(np.uint8).reshape(-1, height, width)
    for layer, radius in zip(layers, radii, strict=True):
        cv2.boxFilter(layer, -1, (2, 2), dst=layer, anchor=(0, 0), normalize=False)
        cv2.max(best, cv2.multiply(layer, 1 / (2 * np.pi * radius), dtype=cv2.CV_32F), dst=best)
    return _peaks(best, layers, margin)[:count]


def edge_pixels(picture: Grey) -> tuple[NDArray[np.float32], ...]:
    """Thin edges: u, v and the unit gradient, of the channel that changes most."""
    smooth = cv2.GaussianBlur(picture, (5, 5), 0.9)
    du = cv2.Sobel(smooth, cv2.CV_16S, 1, 0, ksize=3)
    dv = cv2.Sobel(smooth, cv2.CV_16S, 0, 1, ksize=3)
    if du.ndim == 3:
        du, dv = _strongest_channel(du, dv)
    weakest = _threshold(du, dv)
    edges = cv2.Canny(du, dv, weakest, 1.5 * weakest, L2gradient=True)
    places = np.flatnonzero(edges.ravel().view(np.bool_))
    v, u = np.divmod(places.astype(np.int32), np.int32(edges.shape[1]))
    gu, gv = du.ravel()[places].astype(np.float32), dv.ravel()[places].astype(np.float32)
    norm = np.maximum(np.sqrt(gu * gu + gv * gv), np.float32(1e-6))
    return u.astype(np.float32), v.astype(np.float32), gu / norm, gv / norm


def _threshold(du: NDArray[Any], dv: NDArray[Any]) -> float:
    """The weakest gradient that counts as an edge's, from a sample of the picture."""
    step = max(1, int(np.sqrt(du.size / SAMPLED)))
    sampled = np.abs(du[::step, ::step].astype(np.float32))
    sampled += np.abs(dv[::step, ::step].astype(np.float32))
    count = sampled.size
    # an edge is about three pixels wide before it is thinned
    ranks = count // 2, min(count - 1, int((1 - 3 * LARGEST_EDGE_SHARE) * count))
    middle, texture = np.partition(sampled.ravel(), ranks)[list(ranks)] / np.sqrt(2)
    over_median = np.clip(EDGE_OVER_MEDIAN * middle, WEAKEST_EDGE, STRONGEST_THRESHOLD)
    return float(max(over_median, texture))


def _strongest_channel(du: NDArray[Any], dv: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    zero = np.zeros_like(du)
    strengths = cv2.split(cv2.add(cv2.absdiff(du, zero), cv2.absdiff(dv, zero)))
    best_u, best_v, best = cv2.extractChannel(du, 0), cv2.extractChannel(dv, 0), strengths[0]
    for channel in range(1, du.shape[2]):
        stronger = cv2.compare(strengths[channel], best, cv2.CMP_GT)
        cv2.copyTo(cv2.extractChannel(du, channel), stronger, best_u)
        cv2.copyTo(cv2.extractChannel(dv, channel), stronger, best_v)
        best = cv2.max(best, strengths[channel])
    return np.asarray(best_u), np.asarray(best_v)


def _peaks(best: NDArray[np.float32], layers: NDArray[np.uint8], margin: int) -> list[Circle]:
    local = (best == cv2.dilate(best, np.ones((5, 5), np.uint8))) & (best > 0.25)
    v, u = np.divmod(np.flatnonzero(local), best.shape[1])
    radius = _radii_between(layers[:, v, u])
    # the longer the outline, the less its support is by chance
    order = np.argsort(-best[v, u] * np.sqrt(radius))[:MOST_PER_LEVEL]
    middle = GATHERED / 2 - 0.5
    return [
        Circle(
            float((u[i] - margin) * BIN + middle),
            float((v[i] - margin) * BIN + middle),
            float(radius[i]),
            float(best[v[i], u[i]]),
        )
        for i in order
    ]


def _radii_between(votes: NDArray[np.uint8]) -> Array:
    """The radii (P,) of peaks from their votes for each radius (R, P).

    Two bins hold the votes of several radii alike: the middle of these is taken.
    """
    share = votes / np.maximum(votes.max(axis=0), 1)
    weights = np.square(np.maximum(share - RADII_ALIKE, 0))
    radii: Array = LEVEL_RADII @ weights / weights.sum(axis=0)
    return radii


def _distinct(circles: list[Circle]) -> list[Circle]:
    """The same circle is found on two levels: keep the one with more support."""
    u, v, radius = np.array([[c.u, c.v, c.radius] for c in circles]).reshape(-1, 3).T
    kept: list[int] = []
    for i in range(len(circles)):
        near = np.hypot(u[i] - u[kept], v[i] - v[kept]) < 0.2 * radius[kept]
        larger = radius[i] / radius[kept]
        if not (near & (larger > 0.83) & (larger < 1.2)).any():
            kept.append(i)
    return [circles[i] for i in kept]
