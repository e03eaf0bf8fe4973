# SPDX-License-Identifier: GPL-3.0-or-later
"""Drag a pick of the active object elsewhere; the object, and what hangs on it, follow."""

from typing import ClassVar

import bpy
from bpy.props import FloatVectorProperty, IntProperty, StringProperty

from ..fields import object_property
from ..modelling.model_changes import active_object, change_model, name_of
from ..on_picture.camera_view import camera_region, view_of
from ..on_picture.on_picture import OnPicture
from ..on_picture.picture_frame import picture_frame
from ..polls import NeedsPose
from ..preferences import settings
from ..refusals import refuses, refuses_to_start

REACH_POINTS = 14.0
# a tool's click beside all picks chooses another object, as ever
PASSED_ON = {"CANCELLED", "PASS_THROUGH"}


class MovePick(OnPicture, NeedsPose, bpy.types.Operator):
    """Drag a pick of the active object; the object follows, and is solved on release"""

    bl_idname = "monocell.move_pick"
    bl_label = "Move Pick"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    name: object_property()
    role: StringProperty(
        name="Role",
        description="What it was picked for, as base, top or rim",
        options={"SKIP_SAVE"},
    )
    index: IntProperty(
        name="Number", description="Which pick of that role, from 0", min=0, options={"SKIP_SAVE"}
    )
    pixel_at: FloatVectorProperty(
        name="Pixel",
        description="Where it is now, a pixel of the picture as it came",
        size=2,
        precision=2,
        options={"SKIP_SAVE"},
    )

    @refuses_to_start
    def invoke(self, context, event):
        """Take the pick under the cursor, or wait for a press on one."""
        from ..modelling.editing import object_called
        from ..modelling.modelled import standing_cell
        from ..picking.pick_handles import Handles

        cell = standing_cell(context.scene)
        pressed = event.type == "LEFTMOUSE" and event.value == "PRESS"
        if pressed and not self.name and active_object(context) is None:
            return PASSED_ON
        thing = object_called(cell, name_of(context, self.name))
        if pressed and not thing.picks:
            return PASSED_ON
        sigma = context.scene.monocell_inputs.pick_sigma_pixels
        self.name, self._handles = (
            thing.name,
            Handles.of(cell, thing, sigma, settings(context).unit),
        )
        self._held = self._pressed_on(context, event) if pressed else None
        if pressed and self._held is None:
            return PASSED_ON
        return self.begin(context, event)

    def handle(self, context, area, event):
        """Press takes the nearest pick, release solves."""
        if event.type != "LEFTMOUSE":
            return None
        if event.value == "PRESS":
            pixel = self.pixel(context, area)
            if pixel is not None:
                self._held = self._handles.nearest(pixel, self._reach(context, area))
            return None
        aim = self.aim(context, area)
        if self._held is None or event.value != "RELEASE":
            return None
        if aim is None or self._handles.moved(self._held, aim.pixel).complaint:
            # what can't be the object goes back to where it was
            self._held = None
            return None
        self.end(context)
        self.role, self.index = self._held
        self.pixel_at = aim.pixel.tolist()
        return self.execute(context)

    def paint(self, context, frame):
        """The handles; the object as it would be with the pick at the cursor."""
        from ..picking.pick_drawing import draw_handles

        aim = self.aim(context, context.area) if self._held is not None else None
        draw_handles(context, frame, self, self._handles, self._held, aim)

    def keys(self):
        """What the status bar tells."""
        return (
            ("MOUSE_LMB", f"Drag a pick of {self.name}; release solves"),
            ("EVENT_ESC", "   Cancel"),
        )

    @refuses
    def execute(self, context):
        """Solve with the pick there."""
        from ..modelling.editing import with_pick

        name, pixel = name_of(context, self.name), [round(float(v), 3) for v in self.pixel_at]
        edited = change_model(
            context.scene,
            lambda cell, sigma: with_pick(cell, name, self.role, self.index, pixel, sigma),
        )
        for warning in edited.warnings:
            self.report({"WARNING"}, warning)
        return {"FINISHED"}

    def _pressed_on(self, context, event):
        """The handle under a press that starts it all."""
        space = context.space_data
        if space is None or space.type != "VIEW_3D":
            return None
        region = camera_region(context.scene, context.area, (event.mouse_x, event.mouse_y))
        if region is None:
            return None
        intrinsics = self._handles.cell.camera.intrinsics
        frame = picture_frame(context.scene, region, view_of(space, region), intrinsics)
        x, y = event.mouse_x - region.x + 0.5, event.mouse_y - region.y + 0.5
        pixel = frame.picture_pixel(x, y)
        return None if pixel is None else self._handles.nearest(pixel, reach_of(context, frame))

    def _reach(self, context, area):
        return reach_of(context, self.frame(context, area))


def reach_of(context, frame):
    """How near a press has to be to take a pick, in pixels of the picture."""
    across = (frame.right - frame.left) / frame.intrinsics.width
    return REACH_POINTS * context.preferences.system.ui_scale / across
