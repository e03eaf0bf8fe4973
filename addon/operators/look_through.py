# SPDX-License-Identifier: GPL-3.0-or-later
"""Look through the cell's camera: the viewport turns to it, and a moved camera is put back."""

from typing import ClassVar

import bpy

from ..background_job import OpensInBackground
from ..cell.cell_scene import (
    PLATE_STEPS,
    look_through,
    needs_picture_again,
    put_camera,
    show_picture,
)
from ..cell.document import bare_cell
from ..polls import NeedsCell
from ..waiting import waiting
from .show_picture import showing


class LookThrough(OpensInBackground, NeedsCell, bpy.types.Operator):
    """Put the Blender camera back where the document has it and look through it"""

    bl_idname = "monocell.look_through"
    bl_label = "Look Through the Camera"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    def invoke(self, context, event):
        """Look at once where there is nothing to read."""
        if needs_picture_again(context.scene):
            return self.start(context, event)
        return self.execute(context)

    def prepare(self, context):
        """Read the picture anew where it went with a camera that was deleted."""
        scene = context.scene
        if needs_picture_again(scene):
            return showing(bare_cell(scene), scene.monocell_cell.shown_picture)
        return "Showing", PLATE_STEPS, lambda watch: None

    def finish(self, context, plate):
        """Place the camera, then turn the view."""
        put_camera(context.scene)
        look_through(context)
        if plate is not None:
            with waiting(context):
                show_picture(context.scene, plate)
        return {"FINISHED"}
