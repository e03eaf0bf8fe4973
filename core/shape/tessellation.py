# SPDX-License-Identifier: GPL-3.0-or-later
"""The solids as vertices and flat faces, for Blender and the robot alike.

All vertices lie on the true surface: what is round is inscribed. Faces are convex and go
anticlockwise seen from outside.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..arrays import Array, Mask
from ..primitives import Box, Cone, Cylinder, Primitive, Prism, Sphere, Tube
from .polygons import is_convex, triangulated

Indices = NDArray[np.int32]
# a side of 96 facets is 0.05 % of the radius away from the true one
SEGMENTS = 96
# a ball's facets are 0.03 % of the radius away from the true one
SPHERE_SEGMENTS = 128
# a point's normal has no direction: rings this much smaller each keep the error of the shading
# within the last of them
TIP_SHRINK, TIP_RINGS = 0.2, 3


@dataclass(frozen=True, eq=False)
class Tessellation:
    """Vertices (N, 3); the corners of all faces in a row, where each starts, which are smooth."""

    vertices: Array
    corners: Indices
    starts: Indices
    smooth: Mask

    @property
    def triangles(self) -> Indices:
        """The faces cut into triangles, (M, 3) vertex numbers."""
        counts = np.diff([*self.starts, len(self.corners)])
        fans = [np.zeros((0, 3), np.int32)]
        for count in np.unique(counts):
            places = self.starts[counts == count][:, None] + np.arange(count)
            faces = self.corners[places]
            fans += [faces[:, [0, i, i + 1]] for i in range(1, count - 1)]
        return np.concatenate(fans)


def tessellated(thing: Primitive) -> Tessellation:
    """A primitive in its own frame. Raises TypeError for a kind that is none of ours."""
    if isinstance(thing, Box):
        return box(thing.size)
    if isinstance(thing, Cylinder):
        return cylinder(thing.radius, thing.height)
    if isinstance(thing, Sphere):
        return sphere(thing.radius)
    if isinstance(thing, Cone):
        return cone(thing.radius, thing.top_radius, thing.height)
    if isinstance(thing, Tube):
        return tube(thing.radius, thing.inner_radius, thing.height)
    if isinstance(thing, Prism):
        return prism(thing.polygon, thing.height)
    raise TypeError(f"{thing.kind}: no mesh is known for this kind")


def box(size: ArrayLike) -> Tessellation:
    """A box of full edge lengths (3,); vertex i is at +x, +y, +z where bit 0, 1, 2 of i is set."""
    signs = np.array([[i >> axis & 1 for axis in range(3)] for i in range(8)]) * 2 - 1
    faces = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ]
    return _joined(signs * np.asarray(size) / 2, [(np.array(faces), False)])


def cylinder(radius: float, height: float, segments: int = SEGMENTS) -> Tessellation:
    """A cylinder along z with smooth sides and flat ends, its rims sharp."""
    rings = [_ring(radius, z, segments) for z in (-height / 2, height / 2)]
    low, high = (np.arange(segments) + i * segments for i in range(2))
    return _joined(
        np.concatenate(rings), [(_band(low, high), True), (low[None, ::-1], False), (high, False)]
    )


def cone(
    radius: float,
    top_radius: float,
    height: float,
    segments: int = SEGMENTS,
    tip_rings: int = TIP_RINGS,
) -> Tessellation:
    """A cone or frustum along z: `radius` at the bottom, `top_radius`, or 0, at the top."""
    if top_radius > 0:
        shape = cylinder(1.0, height, segments)
        wide = np.where(shape.vertices[:, 2:] < 0, radius, top_radius)
        around = shape.vertices * np.concatenate([wide, wide, np.ones_like(wide)], axis=1)
        return Tessellation(around, shape.corners, shape.starts, shape.smooth)
    shrunk = TIP_SHRINK ** np.arange(tip_rings)
    rings = [_ring(radius * s, height * (0.5 - s), segments) for s in shrunk]
    levels = [np.arange(segments) + i * segments for i in range(tip_rings)]
    bands = [_band(a, b) for a, b in pairwise(levels)]
    tip = np.full(segments, tip_rings * segments)
    last = np.stack([levels[-1], np.roll(levels[-1], -1), tip], axis=1)
    vertices = np.concatenate([*rings, [[0, 0, height / 2]]])
    sides = [(band, True) for band in (*bands, last)]
    return _joined(vertices, [*sides, (levels[0][None, ::-1], False)])


def tube(
    radius: float, inner_radius: float, height: float, segments: int = SEGMENTS
) -> Tessellation:
    """A hollow cylinder along z, open at both ends: round inside and outside, its ends flat."""
    half = height / 2
    profile = ((radius, -half), (radius, half), (inner_radius, half), (inner_radius, -half))
    rings = [np.arange(segments) + i * segments for i in range(4)]
    bands = [_band(rings[i], rings[(i + 1) % 4]) for i in range(4)]
    vertices = np.concatenate([_ring(r, z, segments) for r, z in profile])
    return _joined(vertices, [(band, i % 2 == 0) for i, band in enumerate(bands)])


def prism(polygon: ArrayLike, height: float) -> Tessellation:
    """A polygon (N, 2) extruded along z: vertex i is its corner i below, vertex N + i above."""
    corners = np.asarray(polygon, dtype=float)
    low = np.arange(len(corners))
    vertices = np.concatenate(
        [np.column_stack([corners, np.full(len(low), z)]) for z in (-height / 2, height / 2)]
    )
    caps = low[None] if is_convex(corners) else triangulated(corners)
    return _joined(
        vertices,
        [(_band(low, low + len(low)), False), (caps[:, ::-1], False), (caps + len(low), False)],
    )


def sphere(radius: float, segments: int = SPHERE_SEGMENTS) -> Tessellation:
    """A sphere of `segments` meridians and half as many rings, smooth all over."""
    unit = _unit_sphere(segments)
    return Tessellation(unit.vertices * radius, unit.corners, unit.starts, unit.smooth)


# thousands of faces that are the same for every ball
@lru_cache(maxsize=8)
def _unit_sphere(segments: int) -> Tessellation:
    rings = segments // 2
    turn = np.arange(segments) * (2 * np.pi / segments)
    polar = np.arange(1, rings) * (np.pi / rings)
    x, y = np.outer(np.sin(polar), np.cos(turn)), np.outer(np.sin(polar), np.sin(turn))
    z = np.repeat(np.cos(polar), segments)
    poles = np.array([[0, 0, 1.0], [0, 0, -1.0]])
    vertices = np.concatenate([np.stack([x.ravel(), y.ravel(), z], axis=1), poles])
    ids = np.arange((rings - 1) * segments).reshape(rings - 1, segments)
    after = np.roll(ids, -1, axis=1)
    quads = np.stack([ids[:-1], ids[1:], after[1:], after[:-1]], axis=2).reshape(-1, 4)
    north, south = ids.size, ids.size + 1
    tops = np.stack([np.full(segments, north), ids[0], after[0]], axis=1)
    ends = np.stack([ids[-1], np.full(segments, south), after[-1]], axis=1)
    made = _joined(vertices, [(quads, True), (np.concatenate([tops, ends]), True)])
    for array in (made.vertices, made.corners, made.starts, made.smooth):
        array.setflags(write=False)
    return made


def _ring(radius: float, level: float, segments: int) -> Array:
    turn = np.arange(segments) * (2 * np.pi / segments)
    flat = np.full(segments, level)
    return np.stack([np.cos(turn) * radius, np.sin(turn) * radius, flat], axis=1)


def _band(low: Indices, high: Indices) -> Indices:
    """Quads between two rings of vertex numbers, facing outwards when `high` is above."""
    quads: Indices = np.stack([low, np.roll(low, -1), np.roll(high, -1), high], axis=1)
    return quads


def _joined(vertices: Array, groups: list[tuple[Indices, bool]]) -> Tessellation:
    """Groups of faces (F, K) of as many corners each, smooth or not."""
    faces = [(np.atleast_2d(group), smooth) for group, smooth in groups]
    counts = np.concatenate([np.full(len(group), group.shape[1]) for group, _ in faces])
    starts = np.concatenate([[0], np.cumsum(counts)[:-1]])
    corners = np.concatenate([group.ravel() for group, _ in faces])
    smooth = np.concatenate([np.full(len(group), is_smooth) for group, is_smooth in faces])
    return Tessellation(vertices, corners.astype(np.int32), starts.astype(np.int32), smooth)
