# SPDX-License-Identifier: GPL-3.0-or-later
"""Rough circles made rough spheres: guesses and a picture in, what most edges agree on out.

Along rays from each guess's middle the strongest changes of the picture are gathered, right and
wrong ones; three of them make a sphere in closed form; the sphere that most of the others agree
with wins (RANSAC, Fischler & Bolles 1981). Fingers before the ball, its highlights, and the texture
behind it are outvoted, not fitted. All guesses are searched at once.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, Mask
from ..errors import SphereNotFound
from ..intrinsics import Intrinsics
from .circle_votes import Circle
from .sphere import outline_pixels
from .triples import drawn_triples, outlines_through

PROFILES, SAMPLES = 72, 41
EDGES_PER_PROFILE = 3
TRIALS = 120
AGREEMENT_PIXELS = 0.5
# changes of fewer grey levels are none
LEAST_CHANGE = 4.0
# of a circle of which less than this is in the picture nothing can be said
LEAST_VISIBLE = 0.3
FEWEST_EDGES = 6
RIM = np.array([[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1]])
ANGLES = np.arange(PROFILES) * (2 * np.pi / PROFILES)
WAYS = np.stack([np.cos(ANGLES), np.sin(ANGLES)], axis=1)


@dataclass(frozen=True)
class Span:
    """How a ring is looked at: from where to where, in radii, on a level where it is how large.

    Edges within the share `agreement` of the radius agree with an outline.
    """

    nearest: float
    farthest: float
    working_radius: float
    agreement: float


# first far and coarse, then near and fine
WIDE, NARROW = Span(0.68, 1.36, 16.0, 0.03), Span(0.84, 1.18, 48.0, 0.012)


@dataclass(frozen=True, eq=False)
class RoughSphere:
    """A sphere's centre (3,) in the camera frame, and the share of profiles that agree with it.

    Only those within the picture count, the share `visible` of all. `circle` is where it was
    looked for.
    """

    centre_camera: Array
    agreement: float
    visible: float
    circle: Circle


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


def search_rings(
    pyramid: Pyramid,
    intrinsics: Intrinsics,
    circles: Sequence[Circle],
    radius: float,
    span: Span = WIDE,
) -> list[RoughSphere]:
    """The spheres of `radius` metres near rough circles; none for a circle that edges form none at.

    From a middle that is off, the profiles cross the outline aslant: what `WIDE` finds is looked at
    again with `NARROW`.
    """
    if not circles:
        return []
    edges = _edges_around(pyramid, intrinsics, circles, span)
    sizes = np.array([circle.radius for circle in circles])
    share = np.maximum(span.agreement, AGREEMENT_PIXELS / sizes)
    # tangents of the angles between the axis and the outline, as a ball of that circle has them
    tolerance = share * edges.tangents
    w = _best_consensus(edges, tolerance)
    for _ in range(2):
        w = _refitted(w, edges, tolerance)
    votes = _votes(_outside(w[:, None], edges.rays)[:, 0], edges.weights, tolerance)
    return [
        RoughSphere(centre, float(vote) / (seen * PROFILES), seen, circle)
        for centre, vote, seen, circle in zip(
            _centres(w, radius), votes, edges.visible.tolist(), circles, strict=True
        )
        if np.isfinite(centre).all()
    ]


def circle_of(intrinsics: Intrinsics, centre_camera: Array, radius: float) -> Circle:
    """The circle closest to a sphere's outline. Raises SphereNotFound if it is not seen."""
    outline = outline_pixels(intrinsics, centre_camera, radius, 36)
    outline = outline[np.isfinite(outline).all(axis=1)]
    if len(outline) < 12:
        raise SphereNotFound("the outline lies outside what the lens images")
    middle = outline.mean(axis=0)
    mean_radius = float(np.linalg.norm(outline - middle, axis=1).mean())
    return Circle(float(middle[0]), float(middle[1]), mean_radius, 0.0)


@dataclass(frozen=True, eq=False)
class _Edges:
    """The strongest edges on the profiles of K circles, strongest first.

    `rays` (K, E * PROFILES, 3), all first edges before all second ones, and `weights` alike, 1 for
    a profile's strongest and 0 where there is none. `tangents` (K,) of the angular radius that a
    circle has, `visible` (K,) the share of its profiles that cross it within the picture.
    """

    rays: Array
    weights: Array
    tangents: Array
    visible: Array


def _edges_around(
    pyramid: Pyramid, intrinsics: Intrinsics, circles: Sequence[Circle], span: Span
) -> _Edges:
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
) -> _Edges:
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
    return _Edges(
        np.where(imaged[..., None], rays, 0),
        np.where(imaged, weights, 0).astype(float),
        np.where(seen.any(axis=1), tangents, np.nan),
        # what lies outside the picture can't agree, but does not disagree either
        np.maximum(visible, LEAST_VISIBLE),
    )


def _best_consensus(edges: _Edges, tolerance: Array) -> Array:
    """The outlines (K, 3) that most edges agree with, of many, each through three edges."""
    triples = drawn_triples(edges.weights, TRIALS)
    w = outlines_through(np.take_along_axis(edges.rays[:, None], triples[..., None], axis=2))
    # far from the circle's own size it is another thing
    size = _tangents(w) / edges.tangents[:, None]
    w[~((size > 0.7) & (size < 1.4))] = np.nan
    # every second profile is enough to choose by
    rays, weights = edges.rays[:, ::2], edges.weights[:, None, ::2].astype(np.float32)
    votes = _votes(_outside(w, rays), weights, tolerance[:, None].astype(np.float32))
    winner = np.argmax(votes, axis=1)
    return w[np.arange(len(w)), winner]


def _refitted(w: Array, edges: _Edges, tolerance: Array) -> Array:
    """The least-squares outlines (K, 3) through the edges that agree; NaN where too few do."""
    within = np.abs(_outside(w[:, None], edges.rays)[:, 0]) < tolerance[:, None]
    within &= edges.weights > 0
    squares = np.where(within, edges.weights, 0) ** 2
    weighted = edges.rays * squares[..., None]
    matrix = np.swapaxes(weighted, 1, 2) @ edges.rays
    enough = within.sum(axis=1) >= FEWEST_EDGES
    enough &= np.isfinite(matrix).all(axis=(1, 2)) & (np.linalg.det(matrix) > 0)
    matrix[~enough] = np.eye(3)
    solved = np.linalg.solve(matrix, weighted.sum(axis=1)[..., None])[..., 0]
    return np.where(enough[:, None], solved, np.nan)


def _votes(outside: NDArray[Any], weights: NDArray[Any], tolerance: NDArray[Any]) -> NDArray[Any]:
    """What the profiles give to outlines whose edges are so far off: at most 1 each."""
    gain = outside / tolerance[..., None]
    np.multiply(gain, gain, out=gain)
    np.subtract(1, gain, out=gain)
    np.fmax(0, gain, out=gain)
    gain *= weights
    first, second, third = np.split(gain, EDGES_PER_PROFILE, axis=-1)
    np.maximum(first, second, out=first)
    votes: NDArray[Any] = np.maximum(first, third, out=first).sum(axis=-1)
    return votes


def _outside(w: Array, rays: Array) -> NDArray[np.float32]:
    """Angles (K, T, M) by which rays (K, M, 3) lie outside outlines (K, T, 3), to first order.

    `u . w` is 1 on the outline and falls outwards by the tangent of the angular radius. Seen from
    one of the rays the differences are small, and single precision keeps their digits.
    """
    origin = rays[:, :1]
    scaled = w / _tangents(w)[..., None]
    start = 1 / _tangents(w)[..., None] - scaled @ np.swapaxes(origin, 1, 2)
    offsets = np.swapaxes(rays - origin, 1, 2).astype(np.float32)
    outside = scaled.astype(np.float32) @ offsets
    return np.subtract(start.astype(np.float32), outside, out=outside)


def _tangents(w: Array) -> Array:
    """The tangents of the angular radii of outlines (..., 3): |w| is 1 over their cosine."""
    excess = (w * w).sum(axis=-1) - 1
    return np.sqrt(np.where(excess > 1e-12, excess, np.nan))


def _centres(w: Array, radius: float) -> Array:
    centres: Array = w * (radius / _tangents(w))[..., None]
    return centres
