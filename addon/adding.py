# SPDX-License-Identifier: GPL-3.0-or-later
"""What every operator that adds a picked object shares: its inputs, and solving them."""

from bpy.props import StringProperty

from .modelled import add_modelled
from .picking import PicksOnPicture
from .polls import NeedsPose
from .refusals import refuses


class AddsPicked(PicksOnPicture, NeedsPose):
    """An operator whose `plan` says what is picked; scripts give `picks` as JSON."""

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
        description='JSON, a list of pixels for each role: {"base": [[u, v], ...], "top": [...]}',
        options={"HIDDEN", "SKIP_SAVE"},
    )

    @refuses
    def execute(self, context):
        """Solve the picks and build the object."""
        from ..core.picture.overlay import caption

        modelled = add_modelled(context, self.plan.kind, self.name, self.on, self.picks)
        self.name = modelled.object.name
        self.report({"INFO"}, f"{self.name}: {caption(modelled.object)}")
        for warning in modelled.warnings:
            self.report({"WARNING"}, warning)
        return {"FINISHED"}
