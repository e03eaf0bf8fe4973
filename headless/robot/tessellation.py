# SPDX-License-Identifier: GPL-3.0-or-later
"""Solids, balls and rods as triangles standing in the world, fine enough for a picture."""

from __future__ import annotations

import numpy as np

from ...core.arrays import Array
from ...core.errors import InvalidValue
from ...core.pose import Pose
from ...core.primitives import Primitive
from ...core.shape.tessellation import Tessellation, cylinder, sphere, tessellated
from .environment import WorldMesh

BALL_RINGS, ROD_SEGMENTS = 32, 24


def triangles_of(thing: Primitive) -> WorldMesh:
    """A solid where it stands: what is flat exactly, what is round inscribed."""
    return _standing(thing.name, tessellated(thing), thing.world_from_object)


def ball(name: str, center_world: Array, radius: float, rings: int = BALL_RINGS) -> WorldMesh:
    """A ball of metres `radius` round `center_world` (3,)."""
    return _standing(name, sphere(radius, max(12, 2 * rings)), Pose(np.eye(3), center_world))


def rod(name: str, start_world: Array, end_world: Array, radius: float) -> WorldMesh:
    """A cylinder of `radius` from one point (3,) to another. Raises InvalidValue for one point."""
    middle, along = (start_world + end_world) / 2, end_world - start_world
    length = float(np.linalg.norm(along))
    if length < 1e-9:
        raise InvalidValue(f"{name}: a rod has no length from a point to the same point")
    # any frame whose z points along will do
    across = np.cross(along, np.eye(3)[int(np.argmin(np.abs(along)))])
    x, z = across / np.linalg.norm(across), along / length
    pose = Pose(np.stack([x, np.cross(z, x), z], axis=1), middle)
    return _standing(name, cylinder(radius, length, ROD_SEGMENTS), pose)


def _standing(name: str, shape: Tessellation, world_from_shape: Pose) -> WorldMesh:
    return WorldMesh(name, world_from_shape.apply(shape.vertices), shape.triangles)
