# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture dropped on the view: its path goes in, the camera is asked for, a cell comes out."""

from pathlib import Path
from typing import ClassVar

import bpy
from bpy.props import StringProperty

from ..background_job import OpensInBackground
from ..camera.camera_inputs import stated_camera
from ..fields import files_property, folder_property
from .open_picture import opened, opening


class DropPicture(OpensInBackground, bpy.types.Operator):
    """Start a new cell from the dropped picture, or the first by name of several"""

    bl_idname = "monocell.drop_picture"
    bl_label = "Start a Cell from the Picture"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    filepath: StringProperty(
        name="Picture",
        description="The picture that was dropped",
        subtype="FILE_PATH",
        options={"SKIP_SAVE", "HIDDEN"},
    )

    directory: folder_property()
    files: files_property()

    def invoke(self, context, event):
        """Ask which camera took it."""
        self.by_hand = True
        names = sorted(file.name for file in self.files if file.name)
        if names:
            self.filepath = str(Path(self.directory) / names[0])
        context.scene.monocell_inputs.picture = self.filepath
        return context.window_manager.invoke_props_dialog(self, width=420)

    def draw(self, context):
        """Blender's call."""
        from ..panels.panel_lens import camera_inputs

        self.layout.label(text=Path(self.filepath).name, icon="IMAGE_DATA")
        if len(self.files) > 1:
            told = f"{len(self.files) - 1} more: drop them on the open cell, as its sightings"
            self.layout.label(text=told, icon="INFO")
        camera_inputs(self.layout, context)

    def state_of(self, scene):
        """A scene of its own is made, whatever happens to others meanwhile."""

    def prepare(self, context):
        """What is done in the background, with the camera that was stated."""
        from ...core.errors import PictureError

        if not self.filepath:
            raise PictureError("no picture was dropped: drop one on the view")
        file = Path(bpy.path.abspath(self.filepath)).resolve()
        return opening(context, file, stated_camera(context.scene.monocell_inputs, file))

    def finish(self, context, result):
        """Build, and look through the camera."""
        return opened(self, context, result)
