# SPDX-License-Identifier: GPL-3.0-or-later
"""Add a box by clicking on the picture: three base corners, going round, then a top corner."""

from typing import ClassVar

import bpy
from bpy.props import StringProperty

from ..modelled import add_modelled
from ..pick_plan import BOX
from ..picking import PicksOnPicture
from ..polls import NeedsPose
from ..refusals import refuses


class AddBox(PicksOnPicture, NeedsPose, bpy.types.Operator):
    """Click three base corners, going round, then a top corner"""

    bl_idname = "monocell.add_box"
    bl_label = "Add Box"
    bl_options: ClassVar = {"REGISTER", "UNDO"}
    plan = BOX

    name: StringProperty(
        name="Name", description="Empty: the first free one", options={"SKIP_SAVE"}
    )
    on: StringProperty(
        name="On",
        description="The reference it stands on; empty: the active one",
        options={"SKIP_SAVE"},
    )
    picks: StringProperty(
        name="Picks",
        description='JSON: {"base": [[u, v], ...], "top": [...]}',
        options={"HIDDEN", "SKIP_SAVE"},
    )

    @refuses
    def execute(self, context):
        """Solve the picks and build the box."""
        from ...core.picture.overlay import caption

        modelled = add_modelled(context, self.plan.kind, self.name, self.on, self.picks)
        self.name = modelled.object.name
        self.report({"INFO"}, f"{self.name}: {caption(modelled.object)}")
        for warning in modelled.warnings:
            self.report({"WARNING"}, warning)
        return {"FINISHED"}
