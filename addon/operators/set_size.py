# SPDX-License-Identifier: GPL-3.0-or-later
"""Type a size of an object, or leave it to the picks again; what hangs on it follows."""

from typing import ClassVar

import bpy
from bpy.props import BoolProperty, StringProperty

from ..fields import length_property, object_property
from ..modelling.model_changes import change_model, name_of
from ..polls import NeedsPose
from ..refusals import refuses


class SetSize(NeedsPose, bpy.types.Operator):
    """Hold a size of an object at what was measured, or free it"""

    bl_idname = "monocell.set_size"
    bl_label = "Set Size"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    name: object_property()
    size: StringProperty(name="Size", description="Which size, as size_x, radius or height")
    known: BoolProperty(
        name="Known",
        description="Whether the size was measured and is held; otherwise the picks tell it",
        default=True,
        options={"SKIP_SAVE"},
    )
    metres: length_property("Value", "The size, metres")

    @refuses
    def execute(self, context):
        """Solve again with it."""
        from ..camera.place_inputs import decimals
        from ..modelling.editing import with_size

        name = name_of(context, self.name)
        value = float(decimals([self.metres])[0]) if self.known else None
        edited = change_model(
            context.scene, lambda cell, sigma: with_size(cell, name, self.size, value, sigma)
        )
        for warning in edited.warnings:
            self.report({"WARNING"}, warning)
        return {"FINISHED"}
