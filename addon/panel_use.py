# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar's last step: what robot programs take, and the document."""

import bpy

from .document import has_cell
from .operators.export_gltf import ExportCell
from .operators.save_cell import SaveCell
from .panel_parts import NEXT, WAITING, CellPanel, paragraph, standing


class UsePanel(CellPanel, bpy.types.Panel):
    """Exports and saves."""

    bl_idname = "MONOCELL_PT_use"
    bl_label = "Use"

    def draw_header(self, context):
        """Blender's call."""
        standing(self.layout, NEXT if _count(context.scene) else WAITING)

    def draw(self, context):
        """Blender's call."""
        layout, scene = self.layout, context.scene
        if not has_cell(scene):
            paragraph(layout, context, "Comes after the model.")
            return
        count = _count(scene)
        said = "1 object" if count == 1 else f"{count} objects"
        paragraph(layout, context, f"The cell has {said} to export." if count else "Nothing yet.")
        column = layout.column(align=True)
        column.operator(ExportCell.bl_idname, text="Export glTF", icon="EXPORT")
        column.operator(SaveCell.bl_idname, icon="FILE_TICK")


def _count(scene):
    collection = scene.monocell_cell.collection
    return len(collection.objects) if has_cell(scene) and collection is not None else 0
