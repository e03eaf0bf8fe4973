# SPDX-License-Identifier: GPL-3.0-or-later
"""Start a cell from a picture: its file and its camera go in, a new scene comes out."""

from pathlib import Path
from typing import ClassVar

import bpy
from bpy.props import StringProperty

from ..camera.camera_inputs import stated_camera
from ..cell.cell_scene import look_through, open_scene
from ..refusals import refuses


class OpenPicture(bpy.types.Operator):
    """Start a new cell from a picture and the camera that took it"""

    bl_idname = "monocell.open_picture"
    bl_label = "Open Picture"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    picture: StringProperty(
        name="Picture",
        description="The picture of the cell, as it came from the camera",
        subtype="FILE_PATH",
        options={"SKIP_SAVE"},
    )
    camera: StringProperty(
        name="Camera file",
        description="Empty: the camera that is stated in the panel",
        subtype="FILE_PATH",
        options={"SKIP_SAVE"},
    )

    @classmethod
    def description(cls, context, properties):
        """What is missing, where something is."""
        return cls.__doc__ if properties.picture else "Choose a picture above first"

    @refuses
    def execute(self, context):
        """Read both, build, and look through the camera."""
        from ...core.document.camera_file import read_camera
        from ...core.errors import PictureError

        if not self.picture:
            raise PictureError("no picture chosen: a cell starts from one")
        file = Path(bpy.path.abspath(self.picture)).resolve()
        if self.camera:
            camera = read_camera(bpy.path.abspath(self.camera))
        else:
            camera = stated_camera(context.scene.monocell_inputs, file)
        return open_picture(self, context, file, camera)


def open_picture(operator, context, file, camera):
    """Open a cell of one picture file with its camera, and look through it."""
    from ...core.cell import Cell

    cell, lens = Cell(camera, picture=file.name, folder=file.parent), context.scene.monocell_lens
    scene = open_scene(context, cell, file.stem)
    # what was told of the lens goes with it
    for known in lens.bl_rna.properties:
        if not known.is_readonly:
            setattr(scene.monocell_lens, known.identifier, getattr(lens, known.identifier))
    look_through(context)
    inner = camera.intrinsics
    operator.report({"INFO"}, f"{scene.name}: {inner.width} x {inner.height} px")
    return {"FINISHED"}
