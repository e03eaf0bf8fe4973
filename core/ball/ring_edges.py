# SPDX-License-Identifier: GPL-3.0-or-later
"""The strongest changes along rays from the middles of rough circles: a picture in, rays out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, Mask
from ..intrinsics import Intrinsics
from .circle_votes import Circle

PROFILES, SAMPLES = 72, 41
EDGES_PER_PROFILE = 3
# changes of fewer grey levels are none
LEAST_CHANGE = 4.0
# of a circle of which less than this is in the picture nothing can be said
LEAST_VISIBLE = 0.3
RIM = np.array([[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1]])
ANGLES = np.arange(PROFILES) * (2 * np.pi / PROFILES)
WAYS = np.stack([np.cos(ANGLES), np.sin(ANGLES)], axis=1)


@dataclass(frozen=True)
class Span:
    """How a ring is looked at: from where to where, in radii, on a level where it is how large.

    Edges within the share `agreement` of the radius agree with an outline; so many `trials` of
    three edges are made.
    """

    nearest: float
    farthest: float
    working_radius: float
    agreement: float
    trials: int = 120


# first far and coarse, then near and fine
WIDE, NARROW = Span(0.68, 1.36, 16.0, 0.03), Span(0.84, 1.18, 48.0, 0.012, 300)


class Pyramid:
    """A picture at halved sizes, each made when it is first asked for."""

    def __init__(self, picture: NDArray[np.uint8]) -> None:
        self._levels = [picture]

    def level(self, index: int) -> NDArray[np.uint8]:
        """The picture averaged over blocks of 2 ** index pixels, as far as it is large enough."""
        while len(self._levels) <= index:
            last = self._levels[-1]
            height, width = last.shape[0] // 2, last.shape[1] // 2
            even = last[: height * 2, : width * 2]
            self._levels.append(
                np.asarray(
                    cv2.resize(even, (width, height), interpolation=cv2.INTER_AREA), np.uint8
                )
            )
        return self._levels[index]


@dataclass(frozen=True, eq=False)
class RingEdges:
    """The strongest edges on the profiles of K circles, strongest first.

    `rays` (K, E * PROFILES, 3), all first edges before all second ones, and `weights` alike, 1 for
    a profile's strongest and 0 where there is none. `tangents` (K,) of the angular radius that a
    circle has, `visible` (K,) the share of its profiles that cross it within the picture.
    """

    rays: Array
    weights: Array
    tangents: Array
    visible: Array


def edges_around(
    pyramid: Pyramid, intrinsics: Intrinsics, circles: Sequence[Circle], span: Span
) -> RingEdges:
    """The strongest edges on the profiles of each circle, as rays."""
    count = len(circles)
    change = np.empty((count, PROFILES, SAMPLES - 2), np.float32)
    crossing = np.empty((count, PROFILES), np.bool_)
    middles = np.array([[circle.u, circle.v] for circle in circles])
    sizes = np.array([circle.radius for circle in circles])
    reach = np.linspace(span.nearest, span.farthest, SAMPLES)
    rim = int(np.argmin(np.abs(reach - 1)))
    at = middles[:, None, None] + sizes[:, None, None, None] * (WAYS[:, None] * reach[:, None])
    levels = np.maximum(0, np.floor(np.log2(sizes / span.working_radius))).astype(int)
    for index in set(levels.tolist()):
        on = levels == index
        change[on], seen = _changes(pyramid.level(index), at[on], 2.0**index)
        crossing[on] = seen[:, :, rim]
    places, strengths = _strongest(change)
    pixels = np.take_along_axis(at, places[..., None] + 1, axis=2)
    return _as_rays(intrinsics, pixels, strengths, middles, sizes, crossing.mean(axis=1))


def _changes(
    picture: NDArray[np.uint8], at: Array, scale: float
) -> tuple[NDArray[np.float32], Mask]:
    """How much the picture changes along profiles (K, P, S, 2), and which samples lie in it."""
    on_level = ((at - (scale - 1) / 2) / scale).astype(np.float32)
    x, y = (on_level[..., i].reshape(-1, SAMPLES) for i in (0, 1))
    sampled = cv2.remap(picture, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    change = cv2.absdiff(sampled[:, 2:], sampled[:, :-2])
    if change.ndim == 3:
        channels = cv2.split(change)
        change = cv2.max(channels[0], cv2.max(channels[1], channels[2]))
    changes = change.reshape(*on_level.shape[:2], -1).astype(np.float32)
    height, width = picture.shape[:2]
    seen = (x >= -0.5) & (x <= width - 0.5) & (y >= -0.5) & (y <= height - 0.5)
    seen = seen.reshape(on_level.shape[:3])
    changes *= seen[:, :, 1:-1]
    return changes, seen


def _strongest(change: NDArray[np.float32]) -> tuple[NDArray[np.intp], NDArray[np.float32]]:
    """The highest peaks of each profile, (K, P, E): their places, and heights, 0 where none is."""
    peak = change * (change > LEAST_CHANGE)
    peak[..., 1:] *= change[..., 1:] >= change[..., :-1]
    peak[..., :-1] *= change[..., :-1] > change[..., 1:]
    places, heights = [], []
    for _ in range(EDGES_PER_PROFILE):
        place = peak.argmax(axis=2)[..., None]
        places.append(place)
        heights.append(np.take_along_axis(peak, place, axis=2))
        np.put_along_axis(peak, place, 0, axis=2)
    return np.concatenate(places, axis=2), np.concatenate(heights, axis=2)


def _as_rays(
    intrinsics: Intrinsics,
    pixels: Array,
    strengths: NDArray[np.float32],
    middles: Array,
    sizes: Array,
    visible: Array,
) -> RingEdges:
    count = len(middles)
    rims = middles[:, None] + sizes[:, None, None] * RIM
    pixels = np.swapaxes(pixels, 1, 2).reshape(count, -1, 2)
    found = np.concatenate([pixels, rims], axis=1).reshape(-1, 2)
    rays = intrinsics.rays(found).reshape(count, -1, 3)
    rays, rims = rays[:, : -len(RIM)], rays[:, -len(RIM) :]
    weights = strengths / np.maximum(strengths[..., :1], 1e-6)
    weights = np.swapaxes(weights, 1, 2).reshape(count, -1)
    imaged = np.isfinite(rays).all(axis=2)
    cosine = np.clip(np.einsum("kri,ki->kr", rims[:, 1:], rims[:, 0]), -1, 1)
    seen = np.isfinite(cosine)
    # a circle at the end of what the lens images has its size from the rest of its rim
    angles = np.where(seen, np.arccos(np.where(seen, cosine, 1)), 0).sum(axis=1)
    tangents = np.tan(angles / np.maximum(seen.sum(axis=1), 1))
    return RingEdges(
        np.where(imaged[..., None], rays, 0),
        np.where(imaged, weights, 0).astype(float),
        np.where(seen.any(axis=1), tangents, np.nan),
        # what lies outside the picture can't agree, but does not disagree either
        np.maximum(visible, LEAST_VISIBLE),
    )
