# SPDX-License-Identifier: GPL-3.0-or-later
"""Cancel what runs in the background: a button goes in, the work ends at its next picture."""

from typing import ClassVar

import bpy


class CancelWork(bpy.types.Operator):
    """End the work that is running and change nothing"""

    bl_idname = "monocell.cancel_work"
    bl_label = "Cancel"
    bl_options: ClassVar = {"INTERNAL"}

    def execute(self, context):
        """Tell the operator that looks after it."""
        context.window_manager.monocell_work.cancel = True
        return {"FINISHED"}
