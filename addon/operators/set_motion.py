# SPDX-License-Identifier: GPL-3.0-or-later
"""Say how an object may move in the robot's scene: not, freely, or on a joint of another."""

from typing import ClassVar

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, FloatVectorProperty, StringProperty

from ..fields import object_property, place_property
from ..modelling.model_changes import active_object, change_model, name_of
from ..polls import NeedsCell
from ..refusals import refuses


def _others(operator, context, typed):
    from ...scene.objects import is_modelled

    own = active_object(context)
    names = [ob.name for ob in context.scene.objects if is_modelled(ob) and ob != own]
    return [name for name in names if typed.lower() in name.lower()]


class SetMotion(NeedsCell, bpy.types.Operator):
    """Say how the object may move in the robot's scene"""

    bl_idname = "monocell.set_motion"
    bl_label = "Motion"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    name: object_property()
    kind: EnumProperty(
        name="Motion",
        description="How it may move",
        items=(
            ("static", "Static", "It never moves"),
            ("movable", "Movable", "It can be pushed and grasped"),
            ("attached", "Attached", "It hangs on a joint of another object"),
        ),
    )
    mass: FloatProperty(name="Mass", description="Mass in kg; 0: not stated", min=0.0, precision=3)
    density: FloatProperty(
        name="Density", description="Density in kg/m³, where no mass is stated; 0: not", min=0.0
    )
    to: StringProperty(name="To", description="The object that it is attached to", search=_others)
    joint: EnumProperty(
        name="Joint",
        description="What it is attached by",
        items=(
            ("fixed", "Fixed", "They move as one"),
            ("hinge", "Hinge", "It turns about an axis"),
            ("slider", "Slider", "It slides along an axis"),
        ),
    )
    axis: FloatVectorProperty(
        name="Axis",
        description="Direction of the joint, in the object's own frame, without a unit",
        default=(0, 0, 1),
    )
    point: place_property("Point", "That the axis goes through, in the object's own frame, metres")
    limited: BoolProperty(name="Limits", description="Whether the joint has ends")
    lower: FloatProperty(name="Lower", description="Least position, radians or metres", max=0.0)
    upper: FloatProperty(name="Upper", description="Greatest position, radians or metres", min=0.0)

    def invoke(self, context, event):
        """Ask, what it is now offered."""
        from ...core.errors import MonocellError
        from ..modelling.editing import object_called
        from ..modelling.modelled import standing_cell

        try:
            thing = object_called(standing_cell(context.scene), name_of(context, self.name))
        except MonocellError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self._offer(thing.motion)
        return context.window_manager.invoke_props_dialog(self)

    def draw(self, context):
        """The dialog."""
        column = self.layout.column()
        column.prop(self, "kind", expand=True)
        if self.kind == "static":
            return
        column.prop(self, "mass")
        column.prop(self, "density")
        if self.kind == "attached":
            column.prop(self, "to")
            column.prop(self, "joint")
        if self.kind == "attached" and self.joint != "fixed":
            column.prop(self, "axis")
            column.prop(self, "point")
            column.prop(self, "limited")
            if self.limited:
                column.prop(self, "lower")
                column.prop(self, "upper")

    @refuses
    def execute(self, context):
        """Write it down."""
        from ..modelling.editing import with_motion

        name, motion = name_of(context, self.name), self._motion()
        change_model(context.scene, lambda cell, sigma: with_motion(cell, name, motion))
        return {"FINISHED"}

    def _motion(self):
        from ...core.motion import Motion

        if self.kind == "static":
            return Motion()
        stated = {"mass": self.mass or None, "density": self.density or None}
        if self.kind == "movable":
            return Motion("movable", **stated)
        if self.joint == "fixed":
            return Motion("attached", **stated, to=self.to, joint="fixed")
        ends = (self.lower, self.upper) if self.limited else None
        return Motion(
            "attached",
            **stated,
            to=self.to,
            joint=self.joint,
            axis=tuple(self.axis),
            point=tuple(self.point),
            limits=ends,
        )

    def _offer(self, motion):
        self.kind, self.to = motion.kind, motion.to or ""
        self.mass, self.density = motion.mass or 0.0, motion.density or 0.0
        self.joint = motion.joint or "fixed"
        if motion.axis is not None:
            self.axis, self.point = motion.axis, motion.point
        self.limited = motion.limits is not None
        if motion.limits is not None:
            self.lower, self.upper = motion.limits
