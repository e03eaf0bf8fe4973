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

from .arrays import Array

LEVEL_RADII = 9.0 * 2 ** (np.arange(10) / 9)
# balls smaller than that are looked for in the full picture too
SMALL_RADII = np.array([6.0, 6.6, 7.3, 8.1])
# gradients below this many times the median one are texture or noise
EDGE_OVER_MEDIAN = 3.0
WEAKEST_EDGE, STRONGEST_THRESHOLD = 16.0, 48.0
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
                for c in _on_one_level(level, radii)
            ]
        half = (level.shape[1] // 2, level.shape[0] // 2)
        level = cv2.resize(level[: half[1] * 2, : half[0] * 2], half, interpolation=cv2.INTER_AREA)
        scale *= 2
    return _distinct(sorted(found, key=lambda c: -c.support))


def _on_one_level(picture: Grey, radii: Array) -> list[Circle]:
    u, v, nu, nv = _edge_pixels(picture)
    if len(u) < 8:
        return []
    height, width = picture.shape[:2]
    margin = int(radii[-1]) + 2
    size = (height + 2 * margin, width + 2 * margin)
    volume = np.empty((len(radii), *size), dtype=np.float32)
    for i, radius in enumerate(radii):
        votes = np.zeros(size[0] * size[1], dtype=np.float32)
        for sign in (radius, -radius):
            x = (u + sign * nu + (margin + 0.5)).astype(np.int32)
            y = (v + sign * nv + (margin + 0.5)).astype(np.int32)
            votes += np.bincount(y * size[1] + x, minlength=len(votes))
        # a centre gathers the votes that fall within a pixel and a half of it
        gathered = cv2.boxFilter(votes.reshape(size), -1, (3, 3), normalize=False)
        volume[i] = gathered / (2 * np.pi * radius)
    return _peaks(volume, radii, margin)


def _edge_pixels(picture: Grey) -> tuple[Array, Array, Array, Array]:
    """Thin edges: u, v and the unit gradient, of the channel that changes most."""
    smooth = cv2.GaussianBlur(picture, (0, 0), 0.9)
    du = cv2.Sobel(smooth, cv2.CV_16S, 1, 0, ksize=3)
    dv = cv2.Sobel(smooth, cv2.CV_16S, 0, 1, ksize=3)
    if du.ndim == 3:
        du, dv = _strongest_channel(du, dv)
    length = cv2.magnitude(du.astype(np.float32), dv.astype(np.float32))
    over_median = EDGE_OVER_MEDIAN * float(np.median(length[::4, ::4]))
    weakest = float(np.clip(over_median, WEAKEST_EDGE, STRONGEST_THRESHOLD))
    edges = cv2.Canny(du, dv, weakest, 1.5 * weakest, L2gradient=True)
    v, u = np.nonzero(edges)
    norm = length[v, u]
    return u.astype(float), v.astype(float), du[v, u] / norm, dv[v, u] / norm


def _strongest_channel(du: NDArray[Any], dv: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    strength = np.abs(du) + np.abs(dv)
    best_u, best_v, best = du[..., 0], dv[..., 0], strength[..., 0]
    for channel in range(1, du.shape[2]):
        stronger = strength[..., channel] > best
        best_u = np.where(stronger, du[..., channel], best_u)
        best_v = np.where(stronger, dv[..., channel], best_v)
        best = np.maximum(best, strength[..., channel])
    return np.ascontiguousarray(best_u), np.ascontiguousarray(best_v)


def _peaks(volume: NDArray[np.float32], radii: Array, margin: int) -> list[Circle]:
    flat = volume.max(axis=0)
    local = (flat == cv2.dilate(flat, np.ones((7, 7), np.uint8))) & (flat > 0.25)
    v, u = np.nonzero(local)
    order = np.argsort(-flat[v, u])[:CANDIDATES_PER_LEVEL]
    return [
        Circle(
            float(u[i] - margin),
            float(v[i] - margin),
            float(radii[np.argmax(volume[:, v[i], u[i]])]),
            float(flat[v[i], u[i]]),
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
