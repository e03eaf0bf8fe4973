# SPDX-License-Identifier: GPL-3.0-or-later
"""Rays against solids: which face a ray meets first, what a camera sees, what hides a point."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..arrays import Array, Mask
from ..camera import Camera
from ..errors import InvalidValue
from ..primitives import Primitive
from .intervals import face_names, stretches

Indices = NDArray[np.int16]
Window = tuple[int, int, int, int]
# rays are cast in blocks that stay in the processor's cache
BLOCK = 8192
# points along an edge of a bounding box, between which a lens bends it by no pixel
POINTS_PER_EDGE = 9
MARGIN_PIXELS = 3


@dataclass(frozen=True, eq=False)
class Hits:
    """Where rays (N,) first meet a solid: `depth` in lengths of the ray, inf where they miss.

    `face` is an index into `face_names`, -1 where they miss.
    """

    depth: Array
    face: Indices


@dataclass(frozen=True, eq=False)
class SeenMap:
    """Which thing, and which of its faces, each pixel of a picture or of a window of it shows.

    `owner` (H, W) is an index into the things, -1 where none is seen; `face` (H, W) into
    `face_names` of that thing; `depth` (H, W) the distance from the optical centre in metres, inf
    where none is seen. The pixel of row i, column j is (x + step j, y + step i) with `window`
    (x, y, width, height).
    """

    owner: Indices
    face: Indices
    depth: Array
    window: Window
    step: int = 1


def hits(thing: Primitive, origin_world: ArrayLike, rays_world: ArrayLike) -> Hits:
    """Where rays (N, 3) of any length from `origin_world` (3,) first meet the surface of a solid.

    `origin + depth * ray` lies on the face. From inside a solid its far side is met. A ray of NaN
    (a pixel that no ray reaches) meets nothing.
    """
    object_from_world = thing.world_from_object.inverse()
    origin = object_from_world.apply(origin_world)
    rays = np.asarray(rays_world, dtype=float).reshape(-1, 3)
    depth = np.full(len(rays), np.inf)
    face = np.full(len(rays), -1, dtype=np.int16)
    for start in range(0, len(rays), BLOCK):
        part = slice(start, start + BLOCK)
        _first_met(thing, origin, object_from_world.rotate(rays[part]), depth[part], face[part])
    return Hits(depth, face)


def seen_map(
    things: Sequence[Primitive], camera: Camera, window: Window | None = None, step: int = 1
) -> SeenMap:
    """What each pixel of the picture as it came from the lens shows, by the ray of its centre.

    `window` (x, y, width, height) looks at a part of it, `step` at every second, third, ... of its
    rows and columns. Raises NoPose, and InvalidValue for a window outside the picture.
    """
    inner = camera.intrinsics
    window = (0, 0, inner.width, inner.height) if window is None else window
    _check_window(window, step, camera)
    x, y, width, height = window
    columns, rows = np.arange(x, x + width, step), np.arange(y, y + height, step)
    shape = len(rows), len(columns)
    owner, face = np.full(shape, -1, dtype=np.int16), np.full(shape, -1, dtype=np.int16)
    depth = np.full(shape, np.inf)
    for index, thing in enumerate(things):
        left, top, right, bottom = bounds(thing, camera)
        across = slice(*np.searchsorted(columns, (left, right)))
        down = slice(*np.searchsorted(rows, (top, bottom)))
        u, v = np.meshgrid(columns[across], rows[down])
        origin, rays = camera.rays_world(np.stack([u.ravel(), v.ravel()], axis=1))
        met = hits(thing, origin, rays)
        nearer = met.depth.reshape(u.shape) < depth[down, across]
        owner[down, across][nearer] = index
        face[down, across][nearer] = met.face.reshape(u.shape)[nearer]
        depth[down, across][nearer] = met.depth.reshape(u.shape)[nearer]
    return SeenMap(owner, face, depth, window, step)


def occluded(
    things: Sequence[Primitive],
    origin_world: ArrayLike,
    points_world: ArrayLike,
    owner_index: ArrayLike,
    tolerance: float = 1e-6,
) -> Mask:
    """Which points (N, 3), as seen from `origin_world` (3,), any OTHER thing hides, (N,).

    `owner_index` (N,) is the index of the thing that each point belongs to, -1 for none: then every
    thing may hide it. What hides a point is nearer to the eye by more than `tolerance` metres.
    """
    origin = np.asarray(origin_world, dtype=float)
    rays = np.asarray(points_world, dtype=float).reshape(-1, 3) - origin
    owner = np.broadcast_to(np.asarray(owner_index), len(rays))
    length = np.linalg.norm(rays, axis=1)
    hidden: Mask = np.zeros(len(rays), dtype=bool)
    for index, thing in enumerate(things):
        asked = np.flatnonzero((owner != index) & ~hidden & _near(thing, origin, rays, length))
        met = hits(thing, origin, rays[asked])
        hidden[asked] = (met.depth - 1) * length[asked] < -tolerance
    return hidden


def bounds(thing: Primitive, camera: Camera) -> Window:
    """The pixels (left, top, right, bottom) outside which nothing of a thing is seen.

    Right and bottom are one past the last. All of the picture where a part of the thing lies behind
    the camera or beyond what the lens images; nothing of it where all of the thing does.
    """
    inner = camera.intrinsics
    points = camera.pose.apply(thing.world_from_object.apply(_edges() * thing.half_extent))
    pixels = inner.project(points)
    if not np.isfinite(pixels).all():
        # a fisheye may see what lies behind it
        behind = (points[:, 2] <= 0).all() and inner.distortion.model != "equidistant"
        return (0, 0, 0, 0) if behind else (0, 0, inner.width, inner.height)
    size = [inner.width, inner.height]
    low = np.clip(np.floor(pixels.min(axis=0)) - MARGIN_PIXELS, 0, size).astype(int)
    high = np.clip(np.ceil(pixels.max(axis=0)) + MARGIN_PIXELS + 1, 0, size).astype(int)
    return int(low[0]), int(low[1]), int(high[0]), int(high[1])


def _first_met(thing: Primitive, origin: Array, rays: Array, depth: Array, face: Indices) -> None:
    """Write where rays of the object's frame first meet the solid into `depth` and `face`."""
    for part in stretches(thing, origin, rays):
        # a stretch behind the eye is none
        there = (part.enter < part.leave) & (part.leave > 0) & np.isinf(depth)
        outside = part.enter > 0
        np.copyto(depth, np.where(outside, part.enter, part.leave), where=there)
        np.copyto(face, np.where(outside, part.way_in, part.way_out), where=there)


def _near(thing: Primitive, origin: Array, rays: Array, length: Array) -> Mask:
    """Which rays pass the ball round a thing on their way to their points."""
    radius = float(np.linalg.norm(thing.half_extent))
    towards = thing.world_from_object.translation - origin
    unit = rays / np.maximum(length, 1e-300)[:, None]
    along = unit @ towards
    aside = np.cross(unit, towards)
    near: Mask = (np.einsum("ij,ij->i", aside, aside) <= radius**2) & (along - radius < length)
    return near & (along > -radius)


def _check_window(window: Window, step: int, camera: Camera) -> None:
    x, y, width, height = window
    inner = camera.intrinsics
    inside = x >= 0 and y >= 0 and x + width <= inner.width and y + height <= inner.height
    if not inside or width < 1 or height < 1 or step < 1:
        raise InvalidValue(
            f"window: {list(window)} in steps of {step} is no part of a picture of "
            f"{inner.width} x {inner.height} px"
        )


def _edges() -> Array:
    """Points (N, 3) along the twelve edges of the cube from -1 to 1."""
    along = np.linspace(-1.0, 1.0, POINTS_PER_EDGE)
    edges = []
    for axis in range(3):
        for a in (-1.0, 1.0):
            for b in (-1.0, 1.0):
                points = np.empty((POINTS_PER_EDGE, 3))
                points[:, axis] = along
                points[:, (axis + 1) % 3], points[:, (axis + 2) % 3] = a, b
                edges.append(points)
    return np.concatenate(edges)


__all__ = ["Hits", "SeenMap", "bounds", "face_names", "hits", "occluded", "seen_map"]
