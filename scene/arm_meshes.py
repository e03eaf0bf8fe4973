# SPDX-License-Identifier: GPL-3.0-or-later
"""The links of a robot arm, OBJ or STL files, as Blender objects."""

from __future__ import annotations

from typing import Any

import bpy

from ..core.errors import DocumentError
from ..core.mesh_part import MeshPart
from .materials import surface
from .quiet import quiet_stdout

# coordinates as in the file: robots' meshes are z up
AXES = {"forward_axis": "Y", "up_axis": "Z"}


def import_mesh(scene: Any, part: MeshPart) -> tuple[Any, ...]:
    """Read the file of a part into `scene`, in the part's colour; its objects are returned.

    Raises DocumentError for a missing file or one that is neither OBJ nor STL.
    """
    if not part.path.is_file():
        raise DocumentError(f"{part.path}: no such mesh file; is the robot's package complete?")
    before, materials = set(bpy.data.objects), set(bpy.data.materials)
    _import(part)
    obs = [ob for ob in bpy.data.objects if ob not in before]
    if not obs:
        raise DocumentError(f"{part.path}: Blender found no mesh in it; is the file whole?")
    material = surface(part.path.stem, part.color.tolist(), roughness=0.34, coat=0.25)
    for ob in obs:
        for collection in ob.users_collection:
            collection.objects.unlink(ob)
        scene.collection.objects.link(ob)
        ob.data.materials.clear()
        ob.data.materials.append(material)
    # the file's own materials have lost their only user
    bpy.data.batch_remove([m for m in bpy.data.materials if m not in materials and m != material])
    return tuple(obs)


def _import(part: MeshPart) -> None:
    readers = {".obj": bpy.ops.wm.obj_import, ".stl": bpy.ops.wm.stl_import}
    kind = part.path.suffix.lower()
    if kind not in readers:
        raise DocumentError(f"{part.path}: {kind or 'no ending'} is neither .obj nor .stl")
    try:
        with quiet_stdout():
            readers[kind](filepath=str(part.path), **AXES)
    except RuntimeError:
        # newer Blenders raise where older ones import nothing
        raise DocumentError(
            f"{part.path}: Blender can't read this mesh; is the file whole?"
        ) from None
