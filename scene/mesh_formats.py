# SPDX-License-Identifier: GPL-3.0-or-later
"""A cell to OBJ, STL, PLY and USD through Blender's own exporters: metres, z up, names kept."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import bpy
import numpy as np

from ..core.atomic import atomic_files
from ..core.cell import Cell
from ..core.errors import RenderFailed
from ..core.formats.identifiers import identifiers
from .export_scene import scene_of
from .materials import PLAIN
from .quiet import quiet_stdout

# the name under which a user's object waits while one of ours has its own
WAITING = "monocell waiting"
Z_UP = {"forward_axis": "Y", "up_axis": "Z"}
COLORS = "Col"


def export_meshes(cell: Cell, path: str | Path) -> None:
    """Write the cell's solved objects by the ending of `path`, one of `EXPORTERS`.

    Objects are called by plain names, as in the robot formats. The file and what goes beside it (an
    `.mtl`, textures) appear together or not at all. Raises DocumentError when they can't be
    written, PictureError for a texture that can't be read, RenderFailed when Blender's exporter
    gives none or is not in this Blender.
    """
    target = Path(path)
    export = EXPORTERS[target.suffix.lower()]
    with atomic_files(target) as temporary, scene_of(cell) as scene, _plain_names(scene):
        try:
            with quiet_stdout():
                export(temporary, scene)
        except RuntimeError as error:
            raise RenderFailed(f"{target}: {' '.join(str(error).split())}") from None
        if not temporary.is_file():
            raise RenderFailed(f"{target}: Blender's exporter wrote nothing; is anything modelled?")


@contextmanager
def _plain_names(scene: Any) -> Iterator[None]:
    """Give the scene's objects plain names, also where the user's objects have these."""
    ours = list(scene.collection.objects)
    names = identifiers([str(ob["monocell"]["name"]) for ob in ours])
    waiting = []
    for name in names:
        other = bpy.data.objects.get(name)
        if other is not None and other not in ours and other.library is None:
            waiting.append((other, name))
            other.name = WAITING
    try:
        # in two rounds, as one of ours may have the name of another
        for ob in ours:
            ob.name = WAITING
        for ob, name in zip(ours, names, strict=True):
            ob.name = name
            if ob.data is not None and ob.data.users == 1:
                ob.data.name = name
        yield
    finally:
        for ob in ours:
            ob.name = WAITING
        for other, name in waiting:
            other.name = name


def _obj(path: Path, scene: Any) -> None:
    bpy.ops.wm.obj_export(
        filepath=str(path), path_mode="COPY", export_triangulated_mesh=False, **Z_UP
    )
    if path.is_file():
        text = path.read_text(encoding="utf-8")
        path.write_text(f"# monocell: metres, z up\n{text}", encoding="utf-8")


def _stl(path: Path, scene: Any) -> None:
    bpy.ops.wm.stl_export(filepath=str(path), **Z_UP)


def _ply(path: Path, scene: Any) -> None:
    for ob in scene.collection.objects:
        if ob.type == "MESH":
            _color_vertices(ob.data)
    bpy.ops.wm.ply_export(
        filepath=str(path),
        export_colors="SRGB",
        export_uv=False,
        # many readers take faces of one length alone
        export_triangulated_mesh=True,
        **Z_UP,
    )


def _color_vertices(mesh: Any) -> None:
    """The uniform colour of a mesh as a colour of its vertices, in linear light."""
    if mesh.color_attributes.get(COLORS) is not None:
        return
    material = mesh.materials[0] if len(mesh.materials) else None
    color = (*PLAIN, 1.0) if material is None else tuple(material.diffuse_color)
    layer = mesh.color_attributes.new(COLORS, "FLOAT_COLOR", "POINT")
    layer.data.foreach_set("color", np.tile(np.array(color, np.float32), len(layer.data)))
    mesh.color_attributes.active_color = layer


def _usd(path: Path, scene: Any) -> None:
    if "usd_export" not in dir(bpy.ops.wm):
        raise RuntimeError("this Blender was built without USD; use one from blender.org")
    wanted = {
        "export_textures_mode": "NEW",
        "export_custom_properties": False,
        "export_animation": False,
        "generate_preview_surface": True,
        "relative_paths": True,
        "export_lights": False,
        "convert_world_material": False,
        "root_prim_path": "/cell",
    }
    there = bpy.ops.wm.usd_export.get_rna_type().properties.keys()
    bpy.ops.wm.usd_export(filepath=str(path), **{k: v for k, v in wanted.items() if k in there})


EXPORTERS: Mapping[str, Callable[[Path, Any], None]] = {
    ".obj": _obj,
    ".stl": _stl,
    ".ply": _ply,
    ".usd": _usd,
    ".usda": _usd,
    ".usdc": _usd,
    ".usdz": _usd,
}
