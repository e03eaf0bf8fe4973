# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture dropped on the view: its path goes in, the camera is asked for, a cell comes out."""

from pathlib import Path
from typing import ClassVar

import bpy
from bpy.props import StringProperty

from ..camera_inputs import stated_camera
from ..refusals import refuses
from .open_picture import open_picture


class DropPicture(bpy.types.Operator):
    """Start a new cell from the dropped picture"""

    bl_idname = "monocell.drop_picture"
    bl_label = "Start a Cell from the Picture"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    filepath: StringProperty(
        name="Picture",
        description="The picture that was dropped",
        subtype="FILE_PATH",
        options={"SKIP_SAVE", "HIDDEN"},
    )

    def invoke(self, context, event):
        """Ask which camera took it."""
        context.scene.monocell_inputs.picture = self.filepath
        return context.window_manager.invoke_props_dialog(self, width=420)

    def draw(self, context):
        """Blender's call."""
        from ..panel_lens import camera_inputs

        self.layout.label(text=Path(self.filepath).name, icon="IMAGE_DATA")
        camera_inputs(self.layout, context)

    @refuses
    def execute(self, context):
        """Open it with the camera that was stated."""
        file = Path(bpy.path.abspath(self.filepath)).resolve()
        return open_picture(self, context, file, stated_camera(context.scene.monocell_inputs, file))
