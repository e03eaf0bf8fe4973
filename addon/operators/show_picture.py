# SPDX-License-Identifier: GPL-3.0-or-later
"""Show another of the cell's pictures behind the camera view."""

from typing import ClassVar

import bpy
from bpy.props import StringProperty

from ..background_job import OpensInBackground
from ..cell.cell_scene import PLATE_STEPS, show_picture
from ..cell.document import bare_cell
from ..polls import NeedsCell
from ..waiting import waiting


class ShowPicture(OpensInBackground, NeedsCell, bpy.types.Operator):
    """Show this picture behind the camera view"""

    bl_idname = "monocell.show_picture"
    bl_label = "Show Picture"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    picture: StringProperty(name="Picture", description="Its name as the document has it")

    def prepare(self, context):
        """What is done in the background."""
        scene = context.scene
        if scene.monocell_cell.shown_picture == self.picture:
            return "Showing", PLATE_STEPS, lambda watch: None
        return showing(bare_cell(scene), self.picture)

    def finish(self, context, plate):
        """Put it behind the view, if it is not there already."""
        if plate is not None:
            with waiting(context):
                show_picture(context.scene, plate)
        return {"FINISHED"}


def showing(cell, name):
    """The work that reads a picture of the cell. It raises PictureError."""
    from ...core.picture.plate import read_plate

    return "Showing", PLATE_STEPS, lambda watch: read_plate(cell, name, watch)
