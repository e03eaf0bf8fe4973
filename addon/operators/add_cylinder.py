# SPDX-License-Identifier: GPL-3.0-or-later
"""Add a cylinder by clicking on the picture: three base rim points, then one of the top rim."""

from typing import ClassVar

import bpy
from bpy.props import StringProperty

from ..modelled import add_modelled
from ..pick_plan import CYLINDER
from ..picking import PicksOnPicture
from ..polls import NeedsPose
from ..refusals import refuses


class AddCylinder(PicksOnPicture, NeedsPose, bpy.types.Operator):
    """Click three points of the base rim, then one of the top rim"""

    bl_idname = "monocell.add_cylinder"
    bl_label = "Add Cylinder"
    bl_options: ClassVar = {"REGISTER", "UNDO"}
    plan = CYLINDER

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
        description='JSON: {"rim": [[u, v], ...], "top": [...]}',
        options={"HIDDEN", "SKIP_SAVE"},
    )

    @refuses
    def execute(self, context):
        """Solve the picks and build the cylinder."""
        from ...core.picture.overlay import caption

        modelled = add_modelled(context, self.plan.kind, self.name, self.on, self.picks)
        self.name = modelled.object.name
        self.report({"INFO"}, f"{self.name}: {caption(modelled.object)}")
        for warning in modelled.warnings:
            self.report({"WARNING"}, warning)
        return {"FINISHED"}
