# SPDX-License-Identifier: GPL-3.0-or-later
"""What a loaded URDF looks like: its visual shapes as mesh files fixed to links, for a renderer."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...core.arrays import Array
from ...core.errors import DocumentError
from ...core.pose import Pose
from .bullet import pose_of, pybullet
from .light import linear_from_srgb

if TYPE_CHECKING:
    from .arm import Arm

READABLE = (".obj", ".stl")


@dataclass(frozen=True, eq=False)
class Visual:
    """A mesh file fixed to a link: `p_link = link_from_mesh(scale * p_mesh)`; colour linear."""

    link: int
    path: Path
    link_from_mesh: Pose
    scale: Array
    color: Array


def visuals(arm: Arm, folder: Path) -> tuple[Visual, ...]:
    """Every visual shape of the arm; boxes, cylinders and spheres are written as OBJ to `folder`.

    PyBullet states a visual's pose relative to the link's own (URDF) frame, other than that of a
    collision shape, which is relative to the inertial frame. URDF does not say what its colours
    are; viewers show them as they stand, so they are taken as sRGB.

    Raises DocumentError for a mesh that is neither OBJ nor STL.
    """
    shapes = pybullet().getVisualShapeData(arm.body, physicsClientId=arm.client)
    return tuple(_visual(shape, arm, folder, i) for i, shape in enumerate(shapes))


def _visual(shape: Any, arm: Arm, folder: Path, number: int) -> Visual:
    _, link, kind, dimensions, mesh_file, position, quaternion, rgba = shape[:8]
    p = pybullet()
    scale = np.ones(3)
    if kind == p.GEOM_MESH:
        path, scale = Path(mesh_file.decode()), np.array(dimensions, dtype=float)
        if path.suffix.lower() not in READABLE:
            raise DocumentError(
                f"{arm.urdf}: link {arm.link_name(link)} is drawn by {path.name}; "
                f"convert it to {' or '.join(READABLE)} first"
            )
    else:
        path = folder / f"visual_{number}.obj"
        _primitive(kind, dimensions, arm, link).export(path)
    color = linear_from_srgb(rgba[:3])
    return Visual(link, path, pose_of(position, quaternion), scale, color)


def _primitive(kind: int, dimensions: tuple[float, ...], arm: Arm, link: int) -> Any:
    import trimesh

    p = pybullet()
    if kind == p.GEOM_BOX:
        return trimesh.creation.box(extents=dimensions)
    if kind == p.GEOM_CYLINDER:
        return trimesh.creation.cylinder(height=dimensions[0], radius=dimensions[1], sections=64)
    if kind == p.GEOM_CAPSULE:
        height, radius = dimensions[:2]
        return trimesh.creation.capsule(height=height, radius=radius).apply_translation(
            [0, 0, -height / 2]
        )
    if kind == p.GEOM_SPHERE:
        return trimesh.creation.icosphere(subdivisions=4, radius=dimensions[0])
    raise DocumentError(
        f"{arm.urdf}: link {arm.link_name(link)} has a visual of PyBullet's kind {kind}, which has "
        "no mesh; use a mesh, box, cylinder, capsule or sphere"
    )
