# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar's last step: what robot programs take, and the document."""

import bpy

from ..cell.document import has_cell
from ..menus import ExportMenu
from ..operators.export_gltf import ExportCell
from ..operators.save_cell import SaveCell
from ..operators.take_colors import TakeColors
from ..operators.take_textures import TakeTextures
from .panel_parts import CellPanel, next_thing, standing
from .steps import use_step


class UsePanel(CellPanel, bpy.types.Panel):
    """Exports and saves."""

    bl_idname = "MONOCELL_PT_use"
    bl_label = "Use"

    def draw_header(self, context):
        """Blender's call."""
        standing(self.layout, use_step(context.scene))

    def draw(self, context):
        """Blender's call."""
        layout, scene = self.layout, context.scene
        next_thing(layout, context, use_step(scene))
        if has_cell(scene):
            row = layout.row(align=True)
            row.operator(
                TakeColors.bl_idname, text="All Colours", icon="EYEDROPPER"
            ).everything = True
            row.operator(
                TakeTextures.bl_idname, text="All Textures", icon="TEXTURE"
            ).everything = True
            column = layout.column(align=True)
            row = column.row(align=True)
            row.operator(ExportCell.bl_idname, text="Export glTF", icon="EXPORT").format = "GLB"
            row.menu(ExportMenu.bl_idname, text="Export ...")
            column.operator(SaveCell.bl_idname, icon="FILE_TICK")
