# SPDX-License-Identifier: GPL-3.0-or-later
"""Take the active reference out of the list, if nothing needs it."""

from typing import ClassVar

import bpy
from bpy.props import StringProperty

from ..modelling.model_changes import change_model
from ..polls import NeedsCell
from ..refusals import refuses


class RemoveReference(NeedsCell, bpy.types.Operator):
    """Take the active reference out of the list, if nothing stands on it"""

    bl_idname = "monocell.remove_reference"
    bl_label = "Remove Reference"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    name: StringProperty(
        name="Reference", description="Empty: the active one", options={"SKIP_SAVE"}
    )

    @refuses
    def execute(self, context):
        """Take it out."""
        from ..modelling.editing import without_reference

        stored = context.scene.monocell_cell
        name = self.name or stored.references[stored.reference_index].name
        change_model(context.scene, lambda cell, sigma: without_reference(cell, name))
        return {"FINISHED"}
