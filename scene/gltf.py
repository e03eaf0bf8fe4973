# SPDX-License-Identifier: GPL-3.0-or-later
"""A cell to glTF, made by Blender's exporter from real objects, z up turned to y up.

Every node's `extras.monocell` is its object's entry of the document without picks, still z up, and
the scene's extras hold the camera with all that a glTF camera can't: principal point, distortion,
covariance. So nothing is lost, and robot programs get exact shapes instead of meshes. A composite
is a node without mesh above the nodes of its parts.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import bpy

from ..core.atomic import atomic_files, atomic_path
from ..core.cell import Cell
from ..core.document.cell_file import picture_from
from ..core.errors import InvalidValue, RenderFailed
from ..core.primitives import Primitive
from .export_scene import scene_of
from .glb_names import glb_named_by_entries, gltf_named_by_entries
from .quiet import quiet_stdout


def export_gltf(cell: Cell, path: str | Path) -> None:
    """Write the cell's objects and camera as `.glb`, one file, or `.gltf` with files beside it.

    Everything is built in a Blender scene of its own that is gone afterwards; the user's scene
    stays as it was, and active. Textures are embedded in a `.glb`; a `.gltf` has them in a folder
    `NAME_textures`. Files are written whole or not at all. Raises InvalidValue for another ending,
    DocumentError when a file can't be written, PictureError for a texture that can't be read,
    RenderFailed when the exporter gives none.
    """
    ending = Path(path).suffix.lower()
    if ending == ".gltf":
        _export_separate(cell, Path(path))
    elif ending == ".glb":
        _export_binary(cell, Path(path))
    else:
        raise InvalidValue(f"{path}: no glTF; name it .glb for one file, .gltf for several")


def _export_binary(cell: Cell, path: Path) -> None:
    with atomic_path(path) as temporary, scene_of(_beside(cell, path.parent)):
        temporary.unlink()
        _export(temporary, export_format="GLB")
        if not temporary.is_file():
            raise RenderFailed(f"{path}: Blender's glTF exporter wrote nothing")
        temporary.write_bytes(glb_named_by_entries(temporary.read_bytes()))


def _export_separate(cell: Cell, path: Path) -> None:
    with atomic_files(path) as temporary, scene_of(_beside(cell, path.parent)):
        textures = f"{path.stem}_textures"
        _export(temporary, export_format="GLTF_SEPARATE", export_texture_dir=textures)
        if not temporary.is_file():
            raise RenderFailed(f"{path}: Blender's glTF exporter wrote nothing")
        temporary.write_text(gltf_named_by_entries(temporary.read_text("utf-8")), encoding="utf-8")


def _beside(cell: Cell, folder: Path) -> Cell:
    """Textures named from where the file will stand, so that whoever opens it finds them."""

    def dressed(thing: Primitive) -> Primitive:
        if thing.appearance is None:
            return thing
        look = thing.appearance.with_pictures(lambda name: picture_from(name, cell.folder, folder))
        return replace(thing, appearance=look)

    return replace(cell.with_objects(map(dressed, cell.objects)), folder=folder)


def _export(path: Path, **options: str) -> None:
    with quiet_stdout():
        bpy.ops.export_scene.gltf(
            filepath=str(path),
            use_active_scene=True,
            export_extras=True,
            export_cameras=True,
            export_yup=True,
            export_apply=False,
            export_image_format="AUTO",
            export_animations=False,
            export_skins=False,
            export_morph=False,
            export_texcoords=True,
            **options,
        )
