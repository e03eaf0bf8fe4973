# SPDX-License-Identifier: GPL-3.0-or-later
"""Clear a window: the active sighting goes in, it is searched in the whole picture from then on."""

from typing import ClassVar

import bpy

from ..camera.sightings import edit_sighting
from ..polls import NeedsSighting
from ..refusals import refuses


class ClearWindow(NeedsSighting, bpy.types.Operator):
    """Search the ball in the whole picture again"""

    bl_idname = "monocell.clear_window"
    bl_label = "Clear Window"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    @refuses
    def execute(self, context):
        """Forget it."""
        edit_sighting(context.scene, context.scene.monocell_cell.sighting_index, window=None)
        return {"FINISHED"}
