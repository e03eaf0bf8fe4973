# SPDX-License-Identifier: GPL-3.0-or-later
"""Find moved pictures: a folder goes in, the document's pictures are named as they lie there."""

from pathlib import Path
from typing import ClassVar

import bpy

from ..background_job import OpensInBackground
from ..camera.sightings import found_pictures, missing_pictures, rename_pictures
from ..cell.document import bare_cell
from ..fields import folder_property, shows_property
from ..polls import NeedsCell


class FindPictures(OpensInBackground, NeedsCell, bpy.types.Operator):
    """Choose the folder that the cell's pictures were moved to"""

    bl_idname = "monocell.find_pictures"
    bl_label = "Find Moved Pictures"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    directory: folder_property()
    filter_folder: shows_property("folders")

    def invoke(self, context, event):
        """Let a folder be chosen."""
        self.by_hand = True
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def prepare(self, context):
        """What is done in the background: every picture that is missing is looked for and read."""
        folder, cell = Path(bpy.path.abspath(self.directory)), bare_cell(context.scene)
        missing = missing_pictures(cell)

        def work(watch):
            return folder, missing, found_pictures(cell, missing, folder, watch)

        return "Finding pictures", len(missing), work

    def finish(self, context, result):
        """Name them by what lies in the folder."""
        folder, missing, there = result
        rename_pictures(context.scene, folder, there)
        self.report({"INFO"}, f"{len(there)} pictures found in {folder}")
        lost = [name for name in missing if name not in there]
        if lost:
            told = ", ".join(lost[:3]) + (" ..." if len(lost) > 3 else "")
            self.report({"WARNING"}, f"{len(lost)} still missing: {told}")
        return {"FINISHED"}
