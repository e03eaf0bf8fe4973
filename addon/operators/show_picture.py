# SPDX-License-Identifier: GPL-3.0-or-later
"""Show another of the cell's pictures behind the camera view."""

from typing import ClassVar

import bpy
from bpy.props import StringProperty

from ..cell.cell_scene import show_named_picture
from ..polls import NeedsCell
from ..refusals import refuses
from ..waiting import waiting


class ShowPicture(NeedsCell, bpy.types.Operator):
    """Show this picture behind the camera view"""

    bl_idname = "monocell.show_picture"
    bl_label = "Show Picture"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    picture: StringProperty(name="Picture", description="Its name as the document has it")

    @refuses
    def execute(self, context):
        """Read the picture, then undistort and show it."""
        with waiting(context):
            show_named_picture(context.scene, self.picture)
        return {"FINISHED"}
