# SPDX-License-Identifier: GPL-3.0-or-later
"""Look through the cell's camera: the viewport turns to it, and a moved camera is put back."""

from typing import ClassVar

import bpy

from ..cell.cell_scene import look_through, put_camera, show_picture_again
from ..polls import NeedsCell
from ..refusals import refuses


class LookThrough(NeedsCell, bpy.types.Operator):
    """Put the Blender camera back where the document has it and look through it"""

    bl_idname = "monocell.look_through"
    bl_label = "Look Through the Camera"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    @refuses
    def execute(self, context):
        """Place the camera, then turn the view."""
        put_camera(context.scene)
        look_through(context)
        show_picture_again(context.scene)
        return {"FINISHED"}
