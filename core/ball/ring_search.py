# SPDX-License-Identifier: GPL-3.0-or-later
"""A rough circle made a rough sphere: a guess and a picture in, what most edges agree on out.

Along rays from the guess's middle the strongest changes of the picture are gathered, right and
wrong ones; three of them make a sphere in closed form; the sphere that most of the others agree
with wins (RANSAC, Fischler & Bolles 1981). Fingers before the ball, its highlights, and the texture
behind it are outvoted, not fitted.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, Mask
from ..errors import SphereNotFound
from ..intrinsics import Intrinsics
from .circle_votes import Circle
from .sphere import outline_pixels, sphere_at, sphere_from_rays

PROFILES, SAMPLES = 72, 41
EDGES_PER_PROFILE = 3
TRIALS = 120
AGREEMENT_PIXELS = 0.5
# of a circle of which less than this is in the picture nothing can be said
LEAST_VISIBLE = 0.3


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

    Only those within the picture count, the share `visible` of all.
    """

    centre_camera: Array
    agreement: float
    visible: float


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


def search_ring(
    pyramid: Pyramid,
    intrinsics: Intrinsics,
    circle: Circle,
    radius: float,
    span: Span = WIDE,
    seed: int = 0,
) -> RoughSphere:
    """The sphere of `radius` metres near a rough circle. Raises SphereNotFound when none agrees.

    From a middle that is off, the profiles cross the outline aslant: what `WIDE` finds is looked at
    again with `NARROW`.
    """
    edges = _edges_around(pyramid, circle, span)
    rays = intrinsics.rays(edges.pixels)
    good = np.isfinite(rays).all(axis=1)
    rays, edges = rays[good], edges.chosen(good)
    if len(rays) < 6:
        raise SphereNotFound(f"only {len(rays)} edges around ({circle.u:.0f}, {circle.v:.0f})")
    middle = sphere_at(intrinsics, (circle.u, circle.v), circle.radius, radius)
    share = max(span.agreement, AGREEMENT_PIXELS / circle.radius)
    tolerance = share * radius / float(np.linalg.norm(middle))
    rng = np.random.default_rng(seed)
    within = _best_consensus(rays, edges, tolerance, middle, radius, rng)
    for _ in range(2):
        centre = sphere_from_rays(rays[within], radius, edges.weights[within])
        off = _angles_outside(rays, centre, radius)
        within = np.abs(off) < tolerance
        if within.sum() < 6:
            raise SphereNotFound(f"edges around ({circle.u:.0f}, {circle.v:.0f}) form no outline")
    votes = float(_votes(off[None], edges, tolerance)[0])
    # what lies outside the picture can't agree, but does not disagree either
    visible = max(edges.visible, LEAST_VISIBLE)
    return RoughSphere(centre, votes / (visible * PROFILES), visible)


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
    """Edges along the profiles: pixels (M, 2), profile (M,), and weights (M,), 1 the strongest.

    `visible` is the share of the profiles that cross the circle within the picture.
    """

    pixels: Array
    profile: NDArray[np.intp]
    weights: Array
    visible: float

    def chosen(self, which: Mask) -> _Edges:
        return _Edges(self.pixels[which], self.profile[which], self.weights[which], self.visible)


def _votes(off: Array, edges: _Edges, tolerance: float) -> Array:
    """What the profiles give to each of T outlines, for angles off them (T, M): at most 1 each."""
    gain = edges.weights * np.maximum(0.0, 1 - (off / tolerance) ** 2)
    best = np.zeros((len(off), PROFILES))
    for rank in range(EDGES_PER_PROFILE):
        of_rank = np.flatnonzero(np.arange(len(edges.profile)) - _first(edges.profile) == rank)
        profile = edges.profile[of_rank]
        best[:, profile] = np.maximum(best[:, profile], gain[:, of_rank])
    votes: Array = best.sum(axis=1)
    return votes


def _first(profile: NDArray[np.intp]) -> NDArray[np.intp]:
    """For a sorted array, the index at which each value's run begins."""
    return np.searchsorted(profile, profile)


def _edges_around(pyramid: Pyramid, circle: Circle, span: Span) -> _Edges:
    """The strongest changes along each profile."""
    index = max(0, int(np.floor(np.log2(circle.radius / span.working_radius))))
    scale = 2.0**index
    picture = pyramid.level(index)
    phi = np.arange(PROFILES) * (2 * np.pi / PROFILES)
    way = np.stack([np.cos(phi), np.sin(phi)], axis=1)
    reach = np.linspace(span.nearest, span.farthest, SAMPLES) * circle.radius
    middle = np.array([circle.u, circle.v])
    at = middle + way[:, None] * reach[:, None]
    on_level = ((at - (scale - 1) / 2) / scale).astype(np.float32)
    sampled = cv2.remap(
        picture,
        on_level[..., 0],
        on_level[..., 1],
        cv2.INTER_LINEAR,
        borderMode=cv2.BORDER_REPLICATE,
    )
    sampled = sampled.reshape(PROFILES, SAMPLES, -1).astype(np.float32)
    change = np.abs(sampled[:, 2:] - sampled[:, :-2]).max(axis=2)
    seen = (on_level >= -0.5).all(axis=2) & (
        on_level <= np.array([picture.shape[1], picture.shape[0]]) - 0.5
    ).all(axis=2)
    change *= seen[:, 1:-1]
    peak = change.copy()
    peak[:, 1:] *= change[:, 1:] >= change[:, :-1]
    peak[:, :-1] *= change[:, :-1] > change[:, 1:]
    order = np.argsort(-peak, axis=1)[:, :EDGES_PER_PROFILE]
    strength = np.take_along_axis(peak, order, axis=1)
    profile, rank = np.nonzero(strength > 4.0)
    weights = strength[profile, rank] / strength[profile, 0]
    crossing = seen[:, int(np.argmin(np.abs(reach - circle.radius)))]
    visible = float(crossing.mean())
    return _Edges(at[profile, order[profile, rank] + 1], profile, weights, visible)


def _best_consensus(
    rays: Array,
    edges: _Edges,
    tolerance: float,
    middle: Array,
    radius: float,
    rng: np.random.Generator,
) -> Mask:
    """Which edges agree with the best of many spheres, each through three edges."""
    # the stronger an edge, the oftener it is drawn
    share = np.cumsum(edges.weights)
    triples = np.searchsorted(share[:-1], rng.random((TRIALS, 3)) * share[-1])
    triples = triples[np.abs(np.linalg.det(rays[triples])) > 1e-12]
    if not len(triples):
        raise SphereNotFound("the edges lie on one line")
    w = np.linalg.solve(rays[triples], np.ones((len(triples), 3, 1)))[..., 0]
    length = np.linalg.norm(w, axis=1)
    # |w| is 1 / cos of the sphere's angular radius; far from the guess's size it is another thing
    with np.errstate(invalid="ignore", divide="ignore"):
        size = np.sqrt(length**2 - 1) * float(np.linalg.norm(middle)) / radius
    w = w[(size > 0.7) & (size < 1.4)]
    if not len(w):
        raise SphereNotFound("no three edges make a ball of about the size looked for")
    length = np.linalg.norm(w, axis=1)
    cosine = np.clip((w @ rays.T) / length[:, None], -1, 1)
    outside = np.arccos(cosine) - np.arccos(1 / length)[:, None]
    winner = int(np.argmax(_votes(outside, edges, tolerance)))
    agrees: Mask = np.abs(outside[winner]) < tolerance
    return agrees


def _angles_outside(rays: Array, centre: Array, radius: float) -> Array:
    distance = float(np.linalg.norm(centre))
    outside: Array = np.arccos(np.clip(rays @ centre / distance, -1, 1)) - np.arcsin(
        min(1.0, radius / distance)
    )
    return outside
