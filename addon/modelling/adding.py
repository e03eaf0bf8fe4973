# SPDX-License-Identifier: GPL-3.0-or-later
"""What every operator that adds a picked object shares: its inputs, and solving them."""

from bpy.props import EnumProperty, StringProperty

from ..fields import new_name_property
from ..picking.pick_plans import WAYS
from ..picking.picking import PicksOnPicture
from ..polls import NeedsPose
from ..refusals import refuses
from .modelled import add_modelled


def way_property(kind):
    """The choice of how a kind is picked and held, the first way offered."""
    ways = [(name, label, meaning) for name, label, meaning, _ in WAYS[kind]]
    return EnumProperty(
        name="Way",
        description="How it is picked and held",
        items=ways,
        default=ways[0][0],
        options={"SKIP_SAVE"},
    )


class AddsPicked(PicksOnPicture, NeedsPose):
    """An operator of a `kind` with a property `way`; scripts give `picks` as JSON."""

    name: new_name_property("object")
    on: StringProperty(
        name="On",
        description="The reference it stands on, or a face of an object as crate.top; empty: the "
        "active one",
        options={"SKIP_SAVE"},
    )
    picks: StringProperty(
        name="Picks",
        description='JSON, a list of pixels for each role: {"base": [[u, v], ...], "top": [...]}',
        options={"HIDDEN", "SKIP_SAVE"},
    )
    known: StringProperty(
        name="Known sizes",
        description='JSON, sizes that were measured, in metres: {"height": 0.12}',
        options={"HIDDEN", "SKIP_SAVE"},
    )

    @refuses
    def execute(self, context):
        """Solve the picks and build the object."""
        from ...core.length_unit import UNITS
        from ...core.picture.overlay import caption
        from ..preferences import settings

        unit = UNITS[settings(context).unit]
        modelled = add_modelled(context, self.kind, self)
        self.name = modelled.object.name
        self.report({"INFO"}, f"{self.name}: {caption(modelled.object, unit)}")
        for warning in modelled.warnings:
            self.report({"WARNING"}, warning)
        return {"FINISHED"}
