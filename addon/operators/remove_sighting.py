# SPDX-License-Identifier: GPL-3.0-or-later
"""Remove a sighting: the active row goes in, the document comes out without it."""

from typing import ClassVar

import bpy

from ..camera.sightings import remove_sighting
from ..polls import NeedsSighting
from ..refusals import refuses


class RemoveSighting(NeedsSighting, bpy.types.Operator):
    """Remove the active sighting from the cell; its picture stays on the disk"""

    bl_idname = "monocell.remove_sighting"
    bl_label = "Remove Sighting"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    @refuses
    def execute(self, context):
        """Take it out."""
        index = context.scene.monocell_cell.sighting_index
        gone = remove_sighting(context.scene, index)
        self.report({"INFO"}, f"Sighting {index + 1} in {gone.picture} removed")
        return {"FINISHED"}
