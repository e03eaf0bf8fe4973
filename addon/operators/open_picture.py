# SPDX-License-Identifier: GPL-3.0-or-later
"""Start a cell from a picture: its file and its camera go in, a new scene comes out."""

from pathlib import Path
from typing import ClassVar

import bpy
from bpy.props import StringProperty

from ..background_job import OpensInBackground
from ..camera.camera_inputs import stated_camera
from ..cell.cell_scene import PLATE_STEPS, first_plate, look_through, open_scene


class OpenPicture(OpensInBackground, bpy.types.Operator):
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

    def state_of(self, scene):
        """A scene of its own is made, whatever happens to others meanwhile."""

    def prepare(self, context):
        """What is done in the background."""
        from ...core.document.camera_file import read_camera
        from ...core.errors import PictureError

        if not self.picture:
            raise PictureError("no picture chosen: a cell starts from one")
        file = Path(bpy.path.abspath(self.picture)).resolve()
        if self.camera:
            known = read_camera(bpy.path.abspath(self.camera))
            return opening(context, file, lambda: known)
        return opening(context, file, stated_camera(context.scene.monocell_inputs, file))

    def finish(self, context, result):
        """Build, and look through the camera."""
        return opened(self, context, result)


def opening(context, file, camera):
    """The work that reads one picture file for the camera that a function gives."""
    from ...core.cell import Cell

    lens = context.scene.monocell_lens
    names = [known.identifier for known in lens.bl_rna.properties if not known.is_readonly]
    told_of_lens = {name: getattr(lens, name) for name in names}

    def work(watch):
        cell = Cell(camera(), picture=file.name, folder=file.parent)
        return cell, first_plate(cell, watch), told_of_lens

    return "Opening", PLATE_STEPS, work


def opened(operator, context, result):
    """Open the cell of one picture, and look through its camera."""
    cell, plate, told_of_lens = result
    scene = open_scene(context, cell, plate, Path(cell.picture).stem)
    # what was told of the lens goes with it
    for name, value in told_of_lens.items():
        setattr(scene.monocell_lens, name, value)
    look_through(context)
    inner = cell.camera.intrinsics
    operator.report({"INFO"}, f"{scene.name}: {inner.width} x {inner.height} px")
    return {"FINISHED"}
