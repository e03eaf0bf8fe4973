# SPDX-License-Identifier: GPL-3.0-or-later
"""Entries in File > Import and File > Export, and the menu of all formats."""

import bpy

from .operators.export_gltf import ExportCell, format_of
from .operators.open_cell import OpenCell
from .operators.open_gltf import OpenGltf
from .operators.save_cell import SaveCell

# a line between what robot programs and what 3D programs read; second endings of one format are
# in the file browser alone
ROBOT_FORMATS = {
    ".urdf": "URDF",
    ".sdf": "Gazebo SDF",
    ".xml": "MuJoCo MJCF",
    ".scene": "MoveIt Scene",
}
FORMATS_3D = {
    ".glb": "glTF",
    ".gltf": "glTF, Separate Files",
    ".usd": "USD",
    ".usda": "USD, Text",
    ".usdz": "USD, Packed",
    ".obj": "Wavefront OBJ",
    ".stl": "STL",
    ".ply": "PLY",
}


class ExportMenu(bpy.types.Menu):
    """The formats that a cell can be exported to."""

    bl_idname = "MONOCELL_MT_export"
    bl_label = "Export"

    def draw(self, context):
        """Blender's call."""
        for formats in (ROBOT_FORMATS, FORMATS_3D):
            for ending, name in formats.items():
                entry = self.layout.operator(ExportCell.bl_idname, text=f"{name} ({ending})")
                entry.format = format_of(ending)
            self.layout.separator()


def _import_entries(menu, context):
    menu.layout.operator(OpenCell.bl_idname, text="monocell document (.cell.json)")
    menu.layout.operator(OpenGltf.bl_idname, text="monocell glTF (.glb)")


def _export_entries(menu, context):
    menu.layout.operator(SaveCell.bl_idname, text="monocell document (.cell.json)")
    menu.layout.operator(ExportCell.bl_idname, text="monocell glTF (.glb)").format = "GLB"
    menu.layout.menu(ExportMenu.bl_idname, text="monocell, other formats")


def register():
    """Append the entries."""
    bpy.types.TOPBAR_MT_file_import.append(_import_entries)
    bpy.types.TOPBAR_MT_file_export.append(_export_entries)


def unregister():
    """Remove them again."""
    bpy.types.TOPBAR_MT_file_export.remove(_export_entries)
    bpy.types.TOPBAR_MT_file_import.remove(_import_entries)
