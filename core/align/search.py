# SPDX-License-Identifier: GPL-3.0-or-later
"""A rough solid in, the state whose outline parts colours and lies on edges best out.

States are drawn from a normal distribution, scored, and the best drawn from again (cross entropy:
Rubinstein 1999). Scores are sums along the outline: inside it colours should be the object's
(Green's theorem over the map of evidence), and across it light should change sharply.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from ..arrays import Array
from ..camera import Camera
from ..modelling.solid import Solid
from ..picture.pictures import Picture
from .color_models import Colors, evidence
from .draws import normals
from .freedom import Freedom
from .hypotheses import (
    CREASE_POINTS,
    Outlines,
    crease_points,
    hull_points,
    lines_of,
    moved_points,
    outlines,
)
from .sight import PictureSight
from .window import Window, looked_up

DRAWN, ELITE, ROUNDS = 96, 14, 16
POINTS = 56
# rounds before which colours are learnt again
LEARNT = (0, 2, 4, 6, 8, 10)
# blurs of the edges in pixels, from the first to the last time that colours are learnt
BLURS = (5.0, 1.2)
# how far beside an outline the colours of its two sides are looked at, pixels
BESIDE = 2.5
# an outline is better off where it has more of an edge than this; what creases are worth
EDGELESS, CREASES = 0.3, 0.5
MASKS, MARGIN = 28, 12.0
WIDENED, LEAST_SIGMA = 1.3, 0.03
# around what is in front its own edges reach so far
RIM = np.ones((7, 7), dtype=np.uint8)
# of the last rounds the best counts, of those before the newest
SETTLING = 3


@dataclass(frozen=True)
class Worth:
    """What a pixel inside, a point that parts colours, and a point on an edge are worth."""

    area: float
    sides: float
    edges: float

    def towards(self, other: Worth, share: float) -> Worth:
        """Between this and another."""
        return Worth(
            self.area + (other.area - self.area) * share,
            self.sides + (other.sides - self.sides) * share,
            self.edges + (other.edges - self.edges) * share,
        )


@dataclass(frozen=True, eq=False)
class Surroundings:
    """What stands about: `in_front` (H, W) is 1 where others are in front.

    `others` (H, W) each are the probabilities of what else is known to stand where.
    """

    in_front: Picture
    others: Sequence[Picture]


@dataclass(frozen=True, eq=False)
class Found:
    """The solid found; `region` (rows, columns) of `window` is the evidence for it, by colours."""

    solid: Solid
    window: Window
    region: Array


def search(
    start: Solid,
    freedom: Freedom,
    motions: Array,
    camera: Camera,
    sight: PictureSight,
    around: Surroundings,
    worth: tuple[Worth, Worth],
) -> Found | None:
    """Find the state over `motions` (6 + P, F), of one sigma each; None out of the picture.

    `worth` is what counts in the first and in the last round.
    """
    place = _Place.of(start, motions, camera, sight, around)
    if place is None:
        return None
    count = motions.shape[1]
    mean, root = np.zeros(count), np.eye(count)
    best, score, maps = mean, -np.inf, None
    for i in range(ROUNDS):
        states = mean + normals(DRAWN, count, i) @ root.T
        states[0] = mean
        hulls = place.hulls(states)
        if maps is None or i in LEARNT:
            maps = place.maps(hulls[:MASKS], BLURS[0] * (BLURS[1] / BLURS[0]) ** (i / LEARNT[-1]))
        scores = maps.scores(hulls, place.creases(states), worth[0].towards(worth[1], i / ROUNDS))
        scores = scores - 0.5 * (states**2).sum(axis=1)
        possible = freedom.possible(start.parameters + states @ motions[6:].T)
        scores = np.where(possible, scores, -np.inf)
        order = np.argsort(-scores)[:ELITE]
        if scores[order[0]] > score or i < ROUNDS - SETTLING:
            best, score = states[order[0]], float(scores[order[0]])
        mean = states[order].mean(axis=0)
        spread = WIDENED * np.cov(states[order].T).reshape(count, count)
        root = np.linalg.cholesky(spread + np.eye(count) * LEAST_SIGMA**2)
    region = place.fine_evidence(hulls[order])
    return Found(freedom.kept(start.moved(motions @ best)), place.fine, region)


@dataclass(frozen=True, eq=False)
class _Maps:
    """Evidence and its sums along rows in `window`, edges in the same window in `fine`."""

    window: Window
    fine: Window
    region: Array
    edges: Array

    def scores(self, hulls: Array, creases: Array, worth: Worth) -> Array:
        """What states are worth, (H,)."""
        drawn = outlines(hulls, POINTS)
        places, step = self.window.places(drawn.pixels), drawn.step / self.window.step
        sums = looked_up(self.region, places)[..., 0]
        area = Outlines(places, drawn.normals, step).integrals(sums)
        aside = [drawn.pixels + side * BESIDE * drawn.normals for side in (-1, 1)]
        own, other = looked_up(self.region, self.window.places(np.stack(aside)))[..., 1]
        sides = (own - other).sum(axis=1) * drawn.step
        at = looked_up(self.edges, self.fine.places(drawn.pixels))
        edges = (_across(at, drawn.normals) - EDGELESS).sum(axis=1) * drawn.step
        middles, turned, lengths = lines_of(creases)
        inner = _across(looked_up(self.edges, self.fine.places(middles)), turned) * lengths
        total: Array = (
            worth.area * area * self.window.step
            + worth.sides * sides
            + worth.edges * (edges + CREASES * inner.sum(axis=(1, 2)))
        )
        return total


@dataclass(frozen=True, eq=False)
class _Place:
    """One object's part of the picture, and how its states look there."""

    start: Solid
    motions: Array
    camera: Camera
    window: Window
    fine: Window
    colors: Colors
    around: Surroundings
    sight: PictureSight
    crease_maps: Array

    @staticmethod
    def of(
        start: Solid, motions: Array, camera: Camera, sight: PictureSight, around: Surroundings
    ) -> _Place | None:
        states = normals(DRAWN, motions.shape[1])[:MASKS]
        pixels = hull_points(start, states @ motions.T, camera).reshape(-1, 2)
        height, width = sight.encoded.shape[:2]
        pixels = pixels[np.isfinite(pixels).all(axis=1)]
        window = Window.around(pixels, MARGIN, width, height) if len(pixels) else None
        if window is None:
            return None
        creases = crease_points(start, camera)
        return _Place(
            start,
            motions,
            camera,
            window,
            window.finest,
            Colors.of(window.cut(sight.encoded), window.cut(sight.light)),
            around,
            sight,
            creases.reshape(-1, *creases.shape[2:]),
        )

    def hulls(self, states: Array) -> Array:
        """Extreme points (H, M, 2) of states (H, F) in pixels, far away where not imaged."""
        pixels = hull_points(self.start, states @ self.motions.T, self.camera)
        return np.where(np.isfinite(pixels), pixels, -1e3)

    def creases(self, states: Array) -> Array:
        """Pixels (H, C, K, 2) of the edges inside the outlines."""
        pixels = moved_points(self.start, states @ self.motions.T, self.camera, self.crease_maps)
        pixels = np.where(np.isfinite(pixels), pixels, -1e3)
        return pixels.reshape(len(states), -1, CREASE_POINTS, 2)

    def maps(self, hulls: Array, blur: float) -> _Maps:
        """What colours say once the object may be inside any of the hulls (K, M, 2)."""
        inside = np.mean([self.window.mask(hull) for hull in hulls], axis=0)
        region = self._evidence(self.window, self.colors, inside)
        sums = np.cumsum(region, axis=1) - 0.5 * region
        bare = 1.0 - cv2.dilate(self.fine.cut(self.around.in_front), RIM).astype(np.float32)
        edges = self.sight.edges.around(self.fine, bare, blur)
        return _Maps(self.window, self.fine, np.stack([sums, region], axis=2), edges)

    def fine_evidence(self, hulls: Array) -> Array:
        """The same at full resolution, for the states at the end."""
        colors = Colors.of(self.fine.cut(self.sight.encoded), self.fine.cut(self.sight.light))
        inside = cv2.blur(np.mean([self.fine.mask(hull) for hull in hulls], axis=0), (5, 5))
        return self._evidence(self.fine, colors, inside)

    def _evidence(self, window: Window, colors: Colors, inside: Picture) -> Array:
        free = 1.0 - np.minimum(window.cut(self.around.in_front).astype(np.float32), 1.0)
        beside: list[Picture] = [window.cut(other) for other in self.around.others]
        return evidence(colors, inside, [part for part in beside if part.any()], free)


def _across(structure: Array, normals: Array) -> Array:
    nx, ny = normals[..., 0], normals[..., 1]
    power: Array = (
        structure[..., 0] * nx**2 + 2 * structure[..., 1] * nx * ny + structure[..., 2] * ny**2
    )
    return power
