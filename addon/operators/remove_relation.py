# SPDX-License-Identifier: GPL-3.0-or-later
"""Take a relation away from an object, and solve it without."""

from typing import ClassVar

import bpy
from bpy.props import IntProperty

from ..fields import object_property
from ..modelling.model_changes import change_model, name_of
from ..polls import NeedsPose
from ..refusals import refuses


class RemoveRelation(NeedsPose, bpy.types.Operator):
    """Let the object go of what holds it, and solve it without"""

    bl_idname = "monocell.remove_relation"
    bl_label = "Remove Relation"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    name: object_property()
    index: IntProperty(
        name="Number",
        description="Which of its relations, from 0; -1 for what it stands on",
        min=-1,
        options={"SKIP_SAVE"},
    )

    @refuses
    def execute(self, context):
        """Solve again without it."""
        from ...core.errors import InvalidValue
        from ..modelling.editing import object_called, with_relations

        name = name_of(context, self.name)

        def removed(cell, sigma):
            thing = object_called(cell, name)
            relations, on = list(thing.relations), thing.on
            if self.index == -1:
                on = None
            elif self.index < len(relations):
                gone = relations.pop(self.index)
                # a way of lying on what it is said to be on: both go
                on = None if gone.to == on else on
            else:
                raise InvalidValue(f"{name}: has {len(relations)} relations, none of {self.index}")
            return with_relations(cell, name, relations, sigma, on=on)

        for warning in change_model(context.scene, removed).warnings:
            self.report({"WARNING"}, warning)
        return {"FINISHED"}
