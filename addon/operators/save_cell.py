# SPDX-License-Identifier: GPL-3.0-or-later
"""Save the scene's cell as a document."""

from pathlib import Path
from typing import ClassVar

import bpy
from bpy_extras.io_utils import ExportHelper

from ..cell.document import doubts_of
from ..fields import endings_property
from ..polls import NeedsCell
from ..refusals import refuses


class SaveCell(NeedsCell, bpy.types.Operator, ExportHelper):
    """Save all of the cell, hidden objects too, as one cell document, the scene's own"""

    bl_idname = "monocell.save_cell"
    bl_label = "Save Cell Document"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    filename_ext = ".json"
    filter_glob: endings_property("*.json")

    def invoke(self, context, event):
        """Offer the name that it was opened from or last saved by."""
        stored = context.scene.monocell_cell
        self.filepath = stored.path or bpy.path.clean_name(context.scene.name) + ".cell.json"
        return super().invoke(context, event)

    @refuses
    def execute(self, context):
        """Write it whole or not at all."""
        from ..cell.saving import save_scene

        path = Path(bpy.path.abspath(self.filepath))
        cell = save_scene(context.scene, path)
        self.report({"INFO"}, f"{path}: {len(cell.objects)} objects saved")
        for doubt in doubts_of(context.scene):
            self.report({"WARNING"}, doubt)
        return {"FINISHED"}
