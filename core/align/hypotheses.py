# SPDX-License-Identifier: GPL-3.0-or-later
"""Many states of one solid in, the outline of each in the picture out, all at once."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..arrays import Array
from ..camera import Camera
from ..modelling.solid import Solid
from ..rotation import hat
from ..shape.anchors import anchor_names, anchors
from ..shape.curves import curves

RIM_POINTS = 20
BALL_POINTS = 200
DIRECTIONS = 40
CREASE_POINTS = 9
# how far inside its rim a polygon of so many corners lies, halved
RIM_SCALE = 0.5 + 0.5 / np.cos(np.pi / RIM_POINTS)


@dataclass(frozen=True, eq=False)
class Outlines:
    """H outlines as N points (H, N, 2) at equal distances, with outward unit normals.

    `step` (H,) is the distance between neighbours in pixels.
    """

    pixels: Array
    normals: Array
    step: Array

    def integrals(self, sums: Array) -> Array:
        """What a map holds inside each outline, (H,), given its `sums` along rows at the points.

        Green's theorem. The heights' differences add up to nothing round an outline, so that what
        lies to the left of it all drops out.
        """
        v = self.pixels[:, :, 1]
        height = 0.5 * (np.roll(v, -1, axis=1) - np.roll(v, 1, axis=1))
        inside: Array = (sums * height).sum(axis=1)
        return inside


def hull_points(solid: Solid, steps: Array, camera: Camera) -> Array:
    """Pixels (H, M, 2) of the solid's extreme points after each of the steps (H, 6 + P)."""
    return moved_points(solid, steps, camera, surface(solid.kind, len(solid.parameters)))


def moved_points(solid: Solid, steps: Array, camera: Camera, by: Array) -> Array:
    """Pixels (H, M, 2) of points, linear in the parameters by (M, 3, P), after each step."""
    rotations = _rotations(steps[:, :3]) @ solid.rotation
    places, parameters = solid.place + steps[:, 3:6], solid.parameters + steps[:, 6:]
    local = (parameters @ by.reshape(-1, by.shape[2]).T).reshape(len(steps), -1, 3)
    world = local @ np.swapaxes(rotations, 1, 2) + places[:, None]
    return camera.project(world.reshape(-1, 3)).reshape(len(steps), -1, 2)


def crease_points(solid: Solid, camera: Camera) -> Array:
    """Points (C, CREASE_POINTS, 3, P) along each visible edge inside the outline, as linear maps.

    A crease keeps its part of a rim while the solid moves a little.
    """
    seen = curves(solid.kind, solid.parameters, solid.eye(camera.centre_world))
    inner = seen.chosen(np.flatnonzero(seen.visible & ~seen.outline))
    start, end = inner.ends.T
    t = start + (np.linspace(0.03, 0.97, CREASE_POINTS)[:, None]) * (end - start)
    return np.swapaxes(inner.points_by(t), 0, 1)


def lines_of(pixels: Array) -> tuple[Array, Array, Array]:
    """Middles, unit normals (..., 2) and lengths of the pieces of polylines (..., K, 2)."""
    piece = np.diff(pixels, axis=-2)
    length = np.linalg.norm(piece, axis=-1)
    unit = piece / np.maximum(length, 1e-9)[..., None]
    normals = np.stack([unit[..., 1], -unit[..., 0]], axis=-1)
    return 0.5 * (pixels[..., 1:, :] + pixels[..., :-1, :]), normals, length


def outlines(hulls: Array, count: int) -> Outlines:
    """The convex outlines of point sets (H, M, 2) at `count` places each, clockwise on the screen.

    NaN where a point of the set is not imaged.
    """
    angles = 2 * np.pi * np.arange(DIRECTIONS) / DIRECTIONS
    directions = np.stack([np.cos(angles), np.sin(angles)])
    farthest = (hulls @ directions).argmax(axis=1)
    corners = np.take_along_axis(hulls, farthest[:, :, None], axis=1)
    closed = np.concatenate([corners, corners[:, :1]], axis=1)
    sides = np.diff(closed, axis=1)
    lengths = np.sqrt((sides**2).sum(axis=2))
    reached = np.concatenate([np.zeros((len(hulls), 1)), lengths.cumsum(axis=1)], axis=1)
    whole = reached[:, -1:]
    wanted = (np.arange(count) + 0.5) / count * whole
    # the side that each place lies on: how many corners were passed before it
    on = (wanted[:, :, None] >= reached[:, None, 1:-1]).sum(axis=2)
    length = np.take_along_axis(lengths, on, axis=1)
    along = (wanted - np.take_along_axis(reached, on, axis=1)) / np.maximum(length, 1e-9)
    side = np.take_along_axis(sides, on[:, :, None], axis=1)
    pixels = np.take_along_axis(closed, on[:, :, None], axis=1) + along[:, :, None] * side
    unit = side / np.maximum(length, 1e-9)[:, :, None]
    # sides run with growing angle of their normal, which lies a quarter turn back
    normals = np.stack([unit[:, :, 1], -unit[:, :, 0]], axis=2)
    return Outlines(pixels, normals, whole[:, 0] / count)


@lru_cache(maxsize=32)
def surface(kind: str, parameters: int) -> Array:
    """Points of a solid as linear maps of its parameters, (M, 3, P): their hull is the solid's."""
    if kind in ("box", "prism"):
        names = [n for n in anchor_names(kind, parameters) if not n.endswith("centre")]
        return anchors(kind, np.ones(parameters), names)[1]
    if kind == "sphere":
        return _ball_points()[:, :, None]
    around = 2 * np.pi * np.arange(RIM_POINTS) / RIM_POINTS
    ring = RIM_SCALE * np.stack([np.cos(around), np.sin(around)], axis=1)
    by = np.zeros((2, RIM_POINTS, 3, parameters))
    by[0, :, :2, 0] = ring
    by[1, :, :2, 1 if kind == "cone" else 0] = ring
    by[0, :, 2, -1], by[1, :, 2, -1] = -0.5, 0.5
    return by.reshape(-1, 3, parameters)


def _ball_points() -> Array:
    """Points evenly over a unit ball: a spiral of golden steps."""
    i = np.arange(BALL_POINTS) + 0.5
    z, turn = 1 - 2 * i / BALL_POINTS, np.pi * (1 + 5**0.5) * i
    around = np.sqrt(1 - z * z)
    return np.stack([around * np.cos(turn), around * np.sin(turn), z], axis=1)


def _rotations(vectors: Array) -> Array:
    """Rodrigues' formula for many rotation vectors (H, 3) at once, (H, 3, 3)."""
    angle = np.linalg.norm(vectors, axis=1)[:, None, None]
    k = hat(vectors)
    versine = 0.5 * np.sinc(angle / (2 * np.pi)) ** 2
    rotations: Array = np.eye(3) + np.sinc(angle / np.pi) * k + versine * (k @ k)
    return rotations
