# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar's first step: which picture, taken by which camera."""

import bpy

from .document import bare_cell, has_cell
from .operators.look_through import LookThrough
from .operators.open_cell import OpenCell
from .operators.open_picture import OpenPicture
from .panel_parts import DONE, NEXT, CellPanel, numbers, paragraph, standing


class PicturePanel(CellPanel, bpy.types.Panel):
    """Opens a cell, and says which one is open."""

    bl_idname = "MONOCELL_PT_picture"
    bl_label = "Picture"

    def draw_header(self, context):
        """Blender's call."""
        standing(self.layout, DONE if has_cell(context.scene) else NEXT)

    def draw(self, context):
        """Blender's call."""
        layout, scene = self.layout, context.scene
        if has_cell(scene):
            self._draw_opened(layout, scene)
            return
        paragraph(layout, context, "Open a cell document, or start from a picture.")
        layout.operator(OpenCell.bl_idname, icon="FILE_FOLDER")
        column = layout.column(align=True)
        inputs = scene.monocell_inputs
        column.prop(inputs, "picture", text="", placeholder="Picture")
        column.prop(inputs, "camera", text="", placeholder="Camera file (YAML, XML, JSON)")
        ready = column.row()
        ready.enabled = bool(inputs.picture and inputs.camera)
        opened = ready.operator(OpenPicture.bl_idname, icon="IMAGE_DATA")
        opened.picture, opened.camera = inputs.picture, inputs.camera

    def _draw_opened(self, layout, scene):
        camera = bare_cell(scene).camera.intrinsics
        numbers(
            layout,
            (
                ("Shown", scene.monocell_cell.shown_picture or "no picture"),
                ("Size", f"{camera.width} × {camera.height} px"),
                ("Focal", f"{camera.fx:.1f}, {camera.fy:.1f} px"),
                ("Centre", f"{camera.cx:.1f}, {camera.cy:.1f} px"),
                ("Lens", camera.distortion.model.replace("_", " ")),
            ),
        )
        row = layout.row(align=True)
        row.operator(LookThrough.bl_idname, text="Look Through", icon="VIEW_CAMERA")
        row.operator(OpenCell.bl_idname, text="Open Another", icon="FILE_FOLDER")
