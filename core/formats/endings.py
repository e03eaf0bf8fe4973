# SPDX-License-Identifier: GPL-3.0-or-later
"""Which endings a cell can be exported to, and what each is."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from ..errors import InvalidValue

# in the order in which they are offered
FORMATS: Mapping[str, str] = {
    ".glb": "glTF in one file: textures, and the exact sizes and camera in its extras",
    ".gltf": "glTF as text, its textures beside it",
    ".urdf": "URDF for ROS, PyBullet, MuJoCo: a link each, joints, inertia, exact collision shapes",
    ".sdf": "SDF world for Gazebo: models, joints, inertia, and the camera as a sensor",
    ".world": "the same, as Gazebo Classic names it",
    ".xml": "MJCF for MuJoCo: bodies, joints, inertia, and the camera",
    ".mjcf": "the same under its own name",
    ".scene": "MoveIt planning scene: boxes, cylinders, spheres, cones, meshes",
    ".usd": "USD, binary: meshes, colours, textures, the camera; z up, metres",
    ".usda": "USD as text",
    ".usdc": "USD, binary",
    ".usdz": "USD with its textures in one file",
    ".obj": "Wavefront OBJ with its .mtl and textures; z up, metres",
    ".stl": "STL, binary: all in one mesh; z up, metres",
    ".ply": "PLY, binary: all in one mesh, with colours; z up, metres",
}


def known_ending(path: str | Path) -> str:
    """The ending of a path, in small letters. Raises InvalidValue for one that is no format's."""
    ending = Path(path).suffix.lower()
    if ending not in FORMATS:
        told = f"no format ends in {ending}" if ending else "has no ending that tells the format"
        raise InvalidValue(f"{path}: {told}; name it one of {' '.join(FORMATS)}")
    return ending
