# SPDX-License-Identifier: GPL-3.0-or-later
"""Boxes, cylinders, balls and rods as triangles fine enough for a picture."""

from __future__ import annotations

import numpy as np

from ...core.arrays import Array
from ...core.errors import InvalidValue
from ...core.pose import Pose
from ...core.primitives import Box, Cylinder, Primitive
from .environment import WorldMesh

SIDES = 96


def triangles_of(thing: Primitive) -> WorldMesh:
    """A box exactly, a cylinder as a prism of 96 sides. Raises InvalidValue for other kinds."""
    if isinstance(thing, Box):
        return _box(thing)
    if isinstance(thing, Cylinder):
        return _turned(
            thing.name,
            thing.world_from_object,
            [0.0, thing.radius, thing.radius, 0.0],
            [-thing.height / 2, -thing.height / 2, thing.height / 2, thing.height / 2],
        )
    raise InvalidValue(f"{thing.name}: a {thing.kind} can't be drawn yet; export it as a mesh")


def ball(name: str, center_world: Array, radius: float, rings: int = 32) -> WorldMesh:
    """A ball of metres `radius` round `center_world` (3,)."""
    angle = np.linspace(0, np.pi, rings + 1)
    pose = Pose(np.eye(3), center_world)
    return _turned(name, pose, radius * np.sin(angle), -radius * np.cos(angle), max(12, 2 * rings))


def rod(name: str, start_world: Array, end_world: Array, radius: float) -> WorldMesh:
    """A cylinder of `radius` from one point (3,) to another."""
    middle, along = (start_world + end_world) / 2, end_world - start_world
    length = float(np.linalg.norm(along))
    if length < 1e-9:
        raise InvalidValue(f"{name}: a rod has no length from a point to the same point")
    # any frame whose z points along will do
    across = np.cross(along, np.eye(3)[int(np.argmin(np.abs(along)))])
    x, z = across / np.linalg.norm(across), along / length
    pose = Pose(np.stack([x, np.cross(z, x), z], axis=1), middle)
    half = length / 2
    return _turned(name, pose, [0.0, radius, radius, 0.0], [-half, -half, half, half], 24)


def _box(thing: Box) -> WorldMesh:
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    faces = [(a, b, c) for a, b, c, _ in quads] + [(a, c, d) for a, _, c, d in quads]
    return WorldMesh(thing.name, thing.corners_world(), np.array(faces))


def _turned(
    name: str,
    pose: Pose,
    radii: Array | list[float],
    heights: Array | list[float],
    sides: int = SIDES,
) -> WorldMesh:
    """The body a profile (radius, height), going up, makes when it turns about z."""
    angle = np.arange(sides) * 2 * np.pi / sides
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    rings = [
        np.column_stack([circle * r, np.full(sides, h)])
        for r, h in zip(radii, heights, strict=True)
    ]
    here = np.arange(sides)
    ahead = (here + 1) % sides
    faces = []
    for low in range(0, (len(rings) - 1) * sides, sides):
        high = low + sides
        faces.append(np.stack([low + here, low + ahead, high + ahead], axis=1))
        faces.append(np.stack([low + here, high + ahead, high + here], axis=1))
    return WorldMesh(name, pose.apply(np.vstack(rings)), np.vstack(faces))
