# SPDX-License-Identifier: GPL-3.0-or-later
"""Open a cell document: a file path goes in, a scene of its own comes out."""

from typing import ClassVar

import bpy
from bpy.props import StringProperty
from bpy_extras.io_utils import ImportHelper

from ..background_job import OpensInBackground
from ..cell.cell_scene import PLATE_STEPS, first_plate, look_through, open_scene, title_of
from ..fields import endings_property


class OpenCell(OpensInBackground, bpy.types.Operator, ImportHelper):
    """Open a cell document (*.cell.json) in a scene of its own"""

    bl_idname = "monocell.open_cell"
    bl_label = "Open Cell Document"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    filename_ext = ".json"
    filter_glob: endings_property("*.json")
    # not remembered: a path that is there was dropped
    filepath: StringProperty(
        name="File",
        description="The cell document to open",
        subtype="FILE_PATH",
        options={"SKIP_SAVE", "HIDDEN"},
    )

    def invoke(self, context, event):
        """Open what was dropped at once; else let a file be chosen."""
        if self.filepath:
            return self.start(context, event)
        self.by_hand = True
        return ImportHelper.invoke(self, context, event)

    def state_of(self, scene):
        """A scene of its own is made, whatever happens to others meanwhile."""

    def prepare(self, context):
        """What is done in the background."""
        path = bpy.path.abspath(self.filepath)
        return "Opening", PLATE_STEPS, lambda watch: read_with_plate(path, watch)

    def finish(self, context, result):
        """Build, and look through the camera."""
        cell, plate = result
        scene = open_scene(context, cell, plate, title_of(self.filepath))
        scene.monocell_cell.path = self.filepath
        look_through(context)
        known = cell.camera.camera_from_world is not None
        state = "calibrated" if known else "the camera is not calibrated yet"
        self.report({"INFO"}, f"{scene.name}: {len(cell.sightings)} sightings, {state}")
        return {"FINISHED"}


def read_with_plate(path, watch):
    """The cell of a document and the picture to show of it. Raises DocumentError, PictureError."""
    from ...core.document.cell_file import read_cell

    cell = read_cell(path)
    return cell, first_plate(cell, watch)
