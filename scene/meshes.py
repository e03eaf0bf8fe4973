# SPDX-License-Identifier: GPL-3.0-or-later
"""Boxes, cylinders and spheres as Blender meshes, about their centre of volume, sizes in metres."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.arrays import Array
from ..core.primitives import Box, Cylinder, Primitive

Indices = NDArray[np.int32]
# a side of 96 facets is 0.05 % of the radius away from the true cylinder
CYLINDER_SEGMENTS = 96
# the outline is within 0.01 px of a true sphere's up to a radius of 460 px in the picture
SPHERE_SEGMENTS = 512


@dataclass(frozen=True, eq=False)
class Shape:
    """Vertices (N, 3); the corners of all faces in a row, where each starts, which are smooth."""

    vertices: Array
    corners: Indices
    starts: Indices
    smooth: NDArray[np.bool_]


def shape_of(thing: Primitive) -> Shape:
    """The shape of a primitive in its own frame."""
    if isinstance(thing, Box):
        return box(thing.size)
    if isinstance(thing, Cylinder):
        return cylinder(thing.radius, thing.height)
    raise TypeError(f"{thing.kind}: no mesh is known for this kind")


def box(size: ArrayLike) -> Shape:
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
    return _shape(signs * np.asarray(size) / 2, np.array(faces), np.zeros(6, bool))


def cylinder(radius: float, height: float, segments: int = CYLINDER_SEGMENTS) -> Shape:
    """A cylinder along z with smooth sides and flat ends, its rims sharp."""
    turn = np.arange(segments) * (2 * np.pi / segments)
    ring = np.stack([np.cos(turn) * radius, np.sin(turn) * radius], axis=1)
    ends = [np.column_stack([ring, np.full(segments, z)]) for z in (-height / 2, height / 2)]
    low = np.arange(segments)
    after = np.roll(low, -1)
    sides = np.stack([low, after, after + segments, low + segments], axis=1)
    corners = np.concatenate([sides.ravel(), low[::-1], low + segments])
    starts = np.concatenate([np.arange(segments) * 4, segments * 4 + np.array([0, segments])])
    smooth = np.arange(segments + 2) < segments
    return Shape(np.concatenate(ends), corners.astype(np.int32), starts.astype(np.int32), smooth)


def sphere(radius: float, segments: int = SPHERE_SEGMENTS) -> Shape:
    """A sphere of `segments` meridians and half as many rings, smooth all over."""
    rings = segments // 2
    turn = np.arange(segments) * (2 * np.pi / segments)
    polar = np.arange(1, rings) * (np.pi / rings)
    x, y = np.outer(np.sin(polar), np.cos(turn)), np.outer(np.sin(polar), np.sin(turn))
    z = np.repeat(np.cos(polar), segments)
    poles = np.array([[0, 0, 1.0], [0, 0, -1.0]])
    vertices = np.concatenate([np.stack([x.ravel(), y.ravel(), z], axis=1), poles]) * radius
    ids = np.arange((rings - 1) * segments).reshape(rings - 1, segments)
    after = np.roll(ids, -1, axis=1)
    quads = np.stack([ids[:-1], ids[1:], after[1:], after[:-1]], axis=2).reshape(-1, 4)
    north, south = ids.size, ids.size + 1
    tops = np.stack([np.full(segments, north), ids[0], after[0]], axis=1)
    ends = np.stack([ids[-1], np.full(segments, south), after[-1]], axis=1)
    triangles = np.concatenate([tops, ends])
    corners = np.concatenate([quads.ravel(), triangles.ravel()])
    starts = np.concatenate([np.arange(len(quads)) * 4, quads.size + np.arange(len(triangles)) * 3])
    smooth = np.ones(len(starts), bool)
    return Shape(vertices, corners.astype(np.int32), starts.astype(np.int32), smooth)


def fill_mesh(mesh: Any, shape: Shape) -> None:
    """Replace a mesh's geometry by a shape; its materials stay."""
    mesh.clear_geometry()
    mesh.vertices.add(len(shape.vertices))
    mesh.vertices.foreach_set("co", shape.vertices.astype(np.float32).ravel())
    mesh.loops.add(len(shape.corners))
    mesh.loops.foreach_set("vertex_index", shape.corners)
    mesh.polygons.add(len(shape.starts))
    mesh.polygons.foreach_set("loop_start", shape.starts)
    mesh.polygons.foreach_set("use_smooth", shape.smooth)
    mesh.update(calc_edges=True)


def mesh_vertices(mesh: Any) -> Array:
    """The vertices of a mesh, (N, 3)."""
    values = np.empty(len(mesh.vertices) * 3, np.float32)
    mesh.vertices.foreach_get("co", values)
    return values.reshape(-1, 3).astype(float)


def _shape(vertices: Array, quads: Array, smooth: NDArray[np.bool_]) -> Shape:
    starts = np.arange(len(quads), dtype=np.int32) * 4
    return Shape(vertices, quads.ravel().astype(np.int32), starts, smooth)
