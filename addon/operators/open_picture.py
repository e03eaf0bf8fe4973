# SPDX-License-Identifier: GPL-3.0-or-later
"""Open a picture with its camera file: two paths go in, the scene of a new cell comes out."""

from pathlib import Path
from typing import ClassVar

import bpy
from bpy.props import StringProperty

from ..cell_scene import look_through, open_scene
from ..refusals import refuses


class OpenPicture(bpy.types.Operator):
    """Start a new cell from a picture and the file of the camera that took it"""

    bl_idname = "monocell.open_picture"
    bl_label = "Open Picture with Camera File"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    picture: StringProperty(name="Picture", subtype="FILE_PATH", options={"SKIP_SAVE"})
    camera: StringProperty(name="Camera file", subtype="FILE_PATH", options={"SKIP_SAVE"})

    @classmethod
    def description(cls, context, properties):
        """What is missing, where something is."""
        missing = [
            n
            for n, p in (("picture", properties.picture), ("camera file", properties.camera))
            if not p
        ]
        return f"Choose a {' and a '.join(missing)} above first" if missing else cls.__doc__

    @refuses
    def execute(self, context):
        """Read both, build, and look through the camera."""
        from ...core.cell import Cell
        from ...core.document.camera_file import read_camera
        from ...core.errors import DocumentError

        if not self.picture or not self.camera:
            raise DocumentError("a picture and its camera file are needed: choose both first")
        file = Path(bpy.path.abspath(self.picture)).resolve()
        camera = read_camera(bpy.path.abspath(self.camera))
        cell = Cell(camera, picture=file.name, folder=file.parent)
        scene = open_scene(context, cell, file.stem)
        look_through(context)
        self.report(
            {"INFO"}, f"{scene.name}: {camera.intrinsics.width} x {camera.intrinsics.height} px"
        )
        return {"FINISHED"}
