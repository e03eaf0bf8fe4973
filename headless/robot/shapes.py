# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects of a virtual environment to collision bodies in a PyBullet world.

Bullet rounds the corners of a box by its collision margin of 1 mm, which makes distances up to
0.73 mm too large, the unsafe side (0.41 mm for a cylinder). With a margin of zero a box is exact to
rounding and a cylinder to 0.02 mm, and neither is ever smaller than it should be on its faces. A
ball is exact. Cones, tubes and prisms are the hulls of their pieces (`core/shape/pieces.py`), to
0.02 mm as well.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from ...core.errors import InvalidValue
from ...core.pose import Pose
from ...core.primitives import Box, Cylinder, Primitive, Sphere
from ...core.shape.pieces import pieces_of
from .bullet import position_and_quaternion, pybullet
from .environment import WorldMesh
from .pieces import pieces_text

# at some 100 000 Bullet's shared memory is full; a query goes through all of them
MOST_HULL_VERTICES = 30_000


def table_top(
    size: Sequence[float] = (1.6, 1.2),
    center: Sequence[float] = (0.0, 0.0),
    top: float = 0.0,
    thickness: float = 0.04,
) -> Box:
    """A level board called "table" with its upper face at z = `top`; all in metres."""
    pose = Pose(np.eye(3), np.array([center[0], center[1], top - thickness / 2]))
    return Box("table", pose, size=np.array([size[0], size[1], thickness]))


def add_obstacle(client: int, thing: Primitive | WorldMesh) -> int:
    """Put a solid, or the convex hull of a mesh, into the world, never to move; its body id."""
    if isinstance(thing, WorldMesh):
        return _body(client, _hull(client, thing), Pose.identity())
    return _body(client, collision_shape(client, thing), thing.world_from_object)


def collision_shape(client: int, thing: Primitive, frame_from_object: Pose | None = None) -> int:
    """The shape of a solid, to make bodies of: `frame_from_object` puts it into a link's frame."""
    p: Any = pybullet()
    at, turn = position_and_quaternion(frame_from_object or Pose.identity())
    place = {
        "collisionFramePosition": at,
        "collisionFrameOrientation": turn,
        "physicsClientId": client,
    }
    if isinstance(thing, Box):
        half = (thing.size / 2).tolist()
        shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=half, **place)
    elif isinstance(thing, Sphere):
        shape = p.createCollisionShape(p.GEOM_SPHERE, radius=thing.radius, **place)
    elif isinstance(thing, Cylinder):
        size = {"radius": thing.radius, "height": thing.height}
        shape = p.createCollisionShape(p.GEOM_CYLINDER, **size, **place)
    else:
        with TemporaryDirectory(prefix="monocell-") as folder:
            file = Path(folder) / "pieces.obj"
            file.write_text(pieces_text(pieces_of(thing).corners()), encoding="ascii")
            shape = p.createCollisionShape(p.GEOM_MESH, fileName=str(file), **place)
    # Bullet sets margins through the base of a body alone; the shape keeps what it was given there
    p.removeBody(_body(client, shape, Pose.identity()), physicsClientId=client)
    return int(shape)


def add_sphere(client: int, radius: float) -> int:
    """A ball at the origin, to be moved about; its body id."""
    p = pybullet()
    shape = p.createCollisionShape(p.GEOM_SPHERE, radius=radius, physicsClientId=client)
    return _body(client, shape, Pose.identity())


def add_rod(client: int, radius: float, length: float) -> int:
    """A rod with round ends, centred at the origin along z, to be moved about; its body id."""
    p = pybullet()
    shape = p.createCollisionShape(
        p.GEOM_CAPSULE, radius=radius, height=length, physicsClientId=client
    )
    return _body(client, shape, Pose.identity())


def _hull(client: int, mesh: WorldMesh) -> Any:
    p: Any = pybullet()
    corners = np.unique(mesh.vertices[np.unique(mesh.faces)], axis=0)
    if len(corners) > MOST_HULL_VERTICES:
        raise InvalidValue(
            f"{mesh.name}: has {len(corners)} vertices, more than the {MOST_HULL_VERTICES} that a "
            "collision shape can have; simplify the mesh"
        )
    return p.createCollisionShape(p.GEOM_MESH, vertices=corners.tolist(), physicsClientId=client)


def _body(client: int, shape: int, pose: Pose) -> int:
    p: Any = pybullet()
    position, quaternion = position_and_quaternion(pose)
    body = p.createMultiBody(0, shape, -1, position, quaternion, physicsClientId=client)
    p.changeDynamics(body, -1, collisionMargin=0.0, physicsClientId=client)
    return int(body)
