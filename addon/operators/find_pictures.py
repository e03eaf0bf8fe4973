# SPDX-License-Identifier: GPL-3.0-or-later
"""Find moved pictures: a folder goes in, the document's pictures are named as they lie there."""

from pathlib import Path
from typing import ClassVar

import bpy

from ..camera.sightings import rename_pictures
from ..fields import folder_property, shows_property
from ..polls import NeedsCell
from ..refusals import refuses


class FindPictures(NeedsCell, bpy.types.Operator):
    """Choose the folder that the cell's pictures were moved to"""

    bl_idname = "monocell.find_pictures"
    bl_label = "Find Moved Pictures"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    directory: folder_property()
    filter_folder: shows_property("folders")

    def invoke(self, context, event):
        """Let a folder be chosen."""
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    @refuses
    def execute(self, context):
        """Name every picture that is missing by what lies in the folder."""
        folder = Path(bpy.path.abspath(self.directory))
        count, missing = rename_pictures(context.scene, folder)
        self.report({"INFO"}, f"{count} pictures found in {folder}")
        if missing:
            told = ", ".join(missing[:3]) + (" ..." if len(missing) > 3 else "")
            self.report({"WARNING"}, f"{len(missing)} still missing: {told}")
        return {"FINISHED"}
