# SPDX-License-Identifier: GPL-3.0-or-later
"""Open a cell document: a file path goes in, a scene of its own comes out."""

from typing import ClassVar

import bpy
from bpy.props import StringProperty
from bpy_extras.io_utils import ImportHelper

from ..cell.cell_scene import look_through, open_scene, title_of
from ..fields import endings_property
from ..refusals import refuses


class OpenCell(bpy.types.Operator, ImportHelper):
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
        return self.execute(context) if self.filepath else super().invoke(context, event)

    @refuses
    def execute(self, context):
        """Read, build, and look through the camera."""
        from ...core.document.cell_file import read_cell

        cell = read_cell(bpy.path.abspath(self.filepath))
        scene = open_scene(context, cell, title_of(self.filepath))
        scene.monocell_cell.path = self.filepath
        look_through(context)
        known = cell.camera.camera_from_world is not None
        state = "calibrated" if known else "the camera is not calibrated yet"
        self.report({"INFO"}, f"{scene.name}: {len(cell.sightings)} sightings, {state}")
        return {"FINISHED"}
