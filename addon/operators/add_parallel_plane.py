# SPDX-License-Identifier: GPL-3.0-or-later
"""A plane at a typed distance from the active one, as the active reference."""

from typing import ClassVar

import bpy
from bpy.props import StringProperty

from ..fields import length_property, new_name_property
from ..modelling.reference_adding import add_reference
from ..polls import NeedsPose
from ..refusals import refuses


class AddParallelPlane(NeedsPose, bpy.types.Operator):
    """Make a plane parallel to the active one, at a distance along its normal"""

    bl_idname = "monocell.add_parallel_plane"
    bl_label = "Parallel Plane"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    to: StringProperty(
        name="To",
        description="A plane, or a face as crate.top; empty: the active reference",
        options={"SKIP_SAVE"},
    )
    distance: length_property(
        "Distance", "Along the plane's normal, metres; below zero on its other side", default=0.1
    )
    name: new_name_property("reference")

    def invoke(self, context, event):
        """Ask for the distance."""
        return context.window_manager.invoke_props_dialog(self)

    @refuses
    def execute(self, context):
        """Add it."""
        from ...core.references.sources import Parallel
        from ..camera.place_inputs import decimals

        distance = float(decimals([self.distance])[0])
        add_reference(self, context, "plane", self.to, lambda on: Parallel(on, distance))
        return {"FINISHED"}
