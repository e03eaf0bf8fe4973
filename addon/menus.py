# SPDX-License-Identifier: GPL-3.0-or-later
"""Entries in File > Import and File > Export."""

import bpy

from .operators.export_gltf import ExportCell
from .operators.open_cell import OpenCell
from .operators.open_gltf import OpenGltf
from .operators.save_cell import SaveCell


def _import_entries(menu, context):
    menu.layout.operator(OpenCell.bl_idname, text="monocell document (.cell.json)")
    menu.layout.operator(OpenGltf.bl_idname, text="monocell glTF (.glb)")


def _export_entries(menu, context):
    menu.layout.operator(SaveCell.bl_idname, text="monocell document (.cell.json)")
    menu.layout.operator(ExportCell.bl_idname, text="monocell glTF (.glb)")


def register():
    """Append the entries."""
    bpy.types.TOPBAR_MT_file_import.append(_import_entries)
    bpy.types.TOPBAR_MT_file_export.append(_export_entries)


def unregister():
    """Remove them again."""
    bpy.types.TOPBAR_MT_file_export.remove(_export_entries)
    bpy.types.TOPBAR_MT_file_import.remove(_import_entries)
