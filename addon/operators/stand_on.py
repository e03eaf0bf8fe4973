# SPDX-License-Identifier: GPL-3.0-or-later
"""Put an object on another reference, and solve it there from the same picks."""

from typing import ClassVar

import bpy
from bpy.props import StringProperty

from ..fields import object_property
from ..modelling.model_changes import change_model, name_of
from ..polls import NeedsPose
from ..refusals import refuses


class StandOn(NeedsPose, bpy.types.Operator):
    """Let the object stand on the active reference, and solve it there from its picks"""

    bl_idname = "monocell.stand_on"
    bl_label = "Stand on Active Reference"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    name: object_property()
    on: StringProperty(
        name="On",
        description="A reference, or a face as crate.top; empty: the active reference",
        options={"SKIP_SAVE"},
    )

    @refuses
    def execute(self, context):
        """Solve again on it."""
        from ..modelling.editing import object_called, with_relations

        stored = context.scene.monocell_cell
        on = self.on or stored.references[stored.reference_index].name
        name = name_of(context, self.name)

        def moved(cell, sigma):
            thing = object_called(cell, name)
            # the ways in which it was on the old reference
            kept = [r for r in thing.relations if thing.on is None or r.to != thing.on]
            return with_relations(cell, name, kept, sigma, on=on)

        for warning in change_model(context.scene, moved).warnings:
            self.report({"WARNING"}, warning)
        return {"FINISHED"}
