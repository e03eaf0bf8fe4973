# SPDX-License-Identifier: GPL-3.0-or-later
"""What solid a mesh is now: the solid it was built as and its vertices in, the edited solid out.

A mesh is read by its own extent, then held against the solid that this makes it: every vertex has
to lie on the surface, and the surface's own vertices have to be reached.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np

from ..core.arrays import Array
from ..core.errors import InvalidValue
from ..core.pose import Pose
from ..core.primitives import Box, Cone, Primitive, Prism, Sphere, Tube, polygon_centre
from ..core.shape.polygons import polygon_area
from ..core.shape.tessellation import tessellated

# a turned cylinder's facets reach 0.05 % less far
KIND_TOLERANCE = 2e-3
ROUND_TOLERANCE = 1e-3
# an end narrower than this share of the other is a point
POINTED = 1e-4
MOST_DIRECTIONS = 400


def shape_of_mesh(built: Primitive, vertices: Array) -> Primitive:
    """The solid whose surface the `vertices` (N, 3) are, in the frame that `built` stands in.

    Its pose is `mesh_from_object`: where it stands in the mesh's own frame. Raises InvalidValue
    for a mesh that is empty, flat, or no longer of the kind of `built`.
    """
    if len(vertices) < 3:
        raise InvalidValue(f"{built.name}: its mesh is empty; undo the edit, or delete the object")
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    centre, half = (low + high) / 2, (high - low) / 2
    if (half <= 0).any():
        raise InvalidValue(f"{built.name}: its mesh is flat; undo the edit, or delete the object")
    if isinstance(built, Prism):
        return _prism(built, vertices)
    read = replace(_by_extent(built, vertices - centre, half), world_from_object=_at(centre))
    own = read.world_from_object.inverse().apply(vertices)
    worst = max(_off_surface(read, own), _not_reached(read, own))
    if worst > KIND_TOLERANCE * half.max():
        _refuse(built, worst)
    return read


def scaled(thing: Primitive, scale: Array) -> Primitive:
    """A solid scaled by (3,) along its own axes.

    Raises InvalidValue where it would be no longer round.
    """
    if isinstance(thing, Box):
        return replace(thing, size=thing.size * scale)
    height = scale[2]
    if isinstance(thing, Prism):
        polygon = thing.polygon * scale[:2]
        return replace(thing, polygon=polygon, height=thing.height * height)
    across = _round(thing.name, thing.half_extent * scale, isinstance(thing, Sphere))
    sizes = {
        name: getattr(thing, name) * (height if name == "height" else across / thing.half_extent[0])
        for name in thing.size_names
    }
    return replace(thing, **sizes)


def _at(centre: Array) -> Pose:
    return Pose(np.eye(3), centre)


def _by_extent(built: Primitive, centred: Array, half: Array) -> Primitive:
    """The solid of the kind of `built` that reaches as far as the mesh does."""
    if isinstance(built, Box):
        return replace(built, size=2 * half)
    radius = _round(built.name, half, isinstance(built, Sphere))
    if isinstance(built, Sphere):
        return replace(built, radius=radius)
    away, height = np.hypot(centred[:, 0], centred[:, 1]), 2 * float(half[2])
    if isinstance(built, Tube):
        inner = float(away.min())
        if inner < POINTED * radius:
            _refuse(built, built.inner_radius)
        return replace(built, radius=radius, inner_radius=inner, height=height)
    if isinstance(built, Cone):
        ends = np.abs(np.abs(centred[:, 2]) - half[2]) < POINTED * half[2]
        low = float(away[ends & (centred[:, 2] < 0)].max())
        high = float(away[ends & (centred[:, 2] > 0)].max())
        pointed = high < POINTED * radius
        if low < POINTED * radius:
            _refuse(built, radius, "standing on its point is a rotation, not an edit of the mesh")
        return replace(built, radius=low, top_radius=0.0 if pointed else high, height=height)
    return replace(built, radius=radius, height=height)


def _prism(built: Prism, vertices: Array) -> Prism:
    """A prism keeps its vertices' order: any move of its upright edges makes another prism."""
    count = len(built.polygon)
    if len(vertices) != 2 * count:
        raise InvalidValue(
            f"{built.name}: its mesh has {len(vertices)} vertices, a prism of {count} corners has "
            f"{2 * count}; undo the edit, or build the shape from several objects"
        )
    low, high = vertices[:count], vertices[count:]
    height = abs(float((high[:, 2] - low[:, 2]).mean()))
    corners = (low[:, :2] + high[:, :2]) / 2
    # a mirrored mesh goes round the other way
    if polygon_area(corners) < 0:
        corners = corners[::-1]
    levels = np.concatenate([low[:, 2] - low[:, 2].mean(), high[:, 2] - high[:, 2].mean()])
    worst = max(float(np.abs(levels).max()), float(np.abs(low - high)[:, :2].max()))
    if worst > KIND_TOLERANCE * float(np.ptp(vertices, axis=0).max()):
        _refuse(built, worst)
    centre = polygon_centre(corners)
    place = np.array([*centre, vertices[:, 2].mean()])
    return replace(built, polygon=corners - centre, height=height, world_from_object=_at(place))


def _off_surface(thing: Primitive, vertices: Array) -> float:
    """How far the farthest vertex lies from the solid's surface, metres."""
    if isinstance(thing, Box):
        unit = np.abs(vertices) / thing.half_extent
        return float(np.abs(unit.max(axis=1) - 1.0).max() * thing.half_extent.max())
    if isinstance(thing, Sphere):
        return float(np.abs(np.linalg.norm(vertices, axis=1) - thing.radius).max())
    profile = _profile(thing)
    points = np.stack([np.hypot(vertices[:, 0], vertices[:, 1]), vertices[:, 2]], axis=1)
    off = [_from_segment(points, a, b) for a, b in pairwise(profile)]
    return float(np.min(off, axis=0).max())


def _profile(thing: Primitive) -> list[Array]:
    """The outline (radius, height) that makes a round solid when it turns."""
    half = thing.half_extent[2]
    radius = float(thing.sizes[0])
    inner, top = 0.0, radius
    if isinstance(thing, Cone):
        top = thing.top_radius
    if isinstance(thing, Tube):
        inner = thing.inner_radius
    corners = [(inner, -half), (radius, -half), (top, half), (inner, half)]
    if isinstance(thing, Tube):
        corners.append(corners[0])
    return [np.array(corner) for corner in corners]


def _from_segment(points: Array, start: Array, end: Array) -> Array:
    along = end - start
    length = float(along @ along)
    share = (
        np.clip((points - start) @ along / length, 0, 1) if length > 0 else np.zeros(len(points))
    )
    return np.linalg.norm(points - start - share[:, None] * along, axis=1)


def _not_reached(thing: Primitive, vertices: Array) -> float:
    """How much less far than the solid the vertices reach, in any direction, metres."""
    ideal = tessellated(thing).vertices
    if not isinstance(thing, Tube):
        return _falls_short(ideal, vertices)
    # the wall between two convex bodies: the outer one and the hole
    middle = (thing.radius + thing.inner_radius) / 2
    wanted, there = (np.hypot(v[:, 0], v[:, 1]) > middle for v in (ideal, vertices))
    return max(
        _falls_short(ideal[wanted], vertices[there]), _falls_short(ideal[~wanted], vertices[~there])
    )


def _falls_short(ideal: Array, vertices: Array) -> float:
    # a convex shape is known by how far it reaches in each direction; some hundred tell it
    some = ideal[:: max(1, len(ideal) // MOST_DIRECTIONS)]
    direction = (some / np.linalg.norm(some, axis=1, keepdims=True)).T
    reach = (ideal @ direction).max(axis=0) - (vertices @ direction).max(axis=0)
    return float(np.abs(reach).max())


def _round(name: str, half: Array, ball: bool) -> float:
    across = half if ball else half[:2]
    if np.ptp(across) > ROUND_TOLERANCE * across.max():
        told = " x ".join(f"{value:.4f}" for value in across)
        alike = "x, y and z" if ball else "x and y"
        raise InvalidValue(
            f"{name}: stretched to {told} m across, so it is no longer round; scale {alike} alike"
        )
    return float(across.mean())


def _refuse(built: Primitive, worst: float, told: str = "") -> None:
    more = told or "undo the edit, or build the shape from several objects"
    raise InvalidValue(f"{built.name}: its mesh is {worst * 1e3:.1f} mm off a {built.kind}; {more}")
