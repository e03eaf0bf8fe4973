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

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..errors import SphereNotFound
from ..intrinsics import Intrinsics
from .circle_votes import Circle
from .ring_edges import (
    EDGES_PER_PROFILE,
    PROFILES,
    WIDE,
    Pyramid,
    RingEdges,
    Span,
    edges_around,
)
from .sphere import outline_pixels
from .triples import drawn_triples, outlines_through

AGREEMENT_PIXELS = 0.5
FEWEST_EDGES = 6


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
    edges = edges_around(pyramid, intrinsics, circles, span)
    sizes = np.array([circle.radius for circle in circles])
    share = np.maximum(span.agreement, AGREEMENT_PIXELS / sizes)
    # tangents of the angles between the axis and the outline, as a ball of that circle has them
    tolerance = share * edges.tangents
    w = _best_consensus(edges, tolerance, span.trials)
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


def _best_consensus(edges: RingEdges, tolerance: Array, trials: int) -> Array:
    """The outlines (K, 3) that most edges agree with, of many, each through three edges."""
    triples = drawn_triples(edges.weights, trials)
    w = outlines_through(np.take_along_axis(edges.rays[:, None], triples[..., None], axis=2))
    # far from the circle's own size it is another thing
    size = _tangents(w) / edges.tangents[:, None]
    w[~((size > 0.7) & (size < 1.4))] = np.nan
    weights = edges.weights[:, None].astype(np.float32)
    votes = _votes(_outside(w, edges.rays), weights, tolerance[:, None].astype(np.float32))
    winner = np.argmax(votes, axis=1)
    return w[np.arange(len(w)), winner]


def _refitted(w: Array, edges: RingEdges, tolerance: Array) -> Array:
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
