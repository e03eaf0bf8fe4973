# SPDX-License-Identifier: GPL-3.0-or-later
"""Make a face, edge or axis of an object the active reference by one click on it."""

from typing import ClassVar

import bpy
from bpy.props import StringProperty

from ..modelling.model_changes import change_model, make_active
from ..on_picture.camera_view import hidden_names
from ..on_picture.on_picture import OnPicture
from ..polls import NeedsPose
from ..refusals import refuses, refuses_to_start

REACH_POINTS = 8.0


class PickReference(OnPicture, NeedsPose, bpy.types.Operator):
    """Click a face, an edge or a round side (its axis) to stand things on, or the floor"""

    bl_idname = "monocell.pick_reference"
    bl_label = "Choose on Picture"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    of: StringProperty(
        name="Reference",
        description="A face, edge or axis such as crate.top, or the name of a reference",
        options={"SKIP_SAVE"},
    )

    @refuses_to_start
    def invoke(self, context, event):
        """Wait for the click."""
        from ..modelling.modelled import standing_cell

        self._cell, self._shown, self._axis = standing_cell(context.scene), None, False
        self._hidden = hidden_names(context.scene, context.space_data)
        return self.begin(context, event)

    def handle(self, context, area, event):
        """The click; with Shift the axis is meant."""
        self._axis = event.shift
        if event.type != "LEFTMOUSE" or event.value != "PRESS":
            return None
        shown = self._under(context, area)
        if shown is None:
            return None
        self.end(context)
        self.of = shown.path
        return self.execute(context)

    def paint(self, context, frame):
        """What a click would choose."""
        from ..overlay.reference_drawing import draw_shown

        shown = self._under(context, context.area)
        draw_shown(context, frame, self._cell.standing_camera(), shown, self)

    def keys(self):
        """What the status bar tells."""
        return (
            ("MOUSE_LMB", "Face, edge or floor to stand things on"),
            ("EVENT_SHIFT", "    the object's axis"),
            ("EVENT_ESC", "   Cancel"),
        )

    @refuses
    def execute(self, context):
        """Choose it, as one of the list or as a new one."""
        from ...core.reference import PendingReference
        from ...core.references.sources import FeatureOf
        from ..modelling.editing import with_reference
        from ..modelling.modelled import free_name, standing_cell
        from ..on_picture.feature_picking import path_of

        scene = context.scene
        cell = standing_cell(scene)
        name = path_of(cell, self.of)
        if name is None:
            kind = cell.reference(self.of)
            kind = "line" if hasattr(kind, "direction") else "plane"
            # a reference of the very name of the face would be made from itself
            name = free_name(cell, self.of.replace(".", " "))
            made = PendingReference(name, kind, FeatureOf(self.of))
            change_model(scene, lambda cell, sigma: with_reference(cell, made, sigma))
        make_active(scene, name)
        self.report({"INFO"}, f"{name} is the active reference")
        return {"FINISHED"}

    def _under(self, context, area):
        """What is under the cursor, found once for each place of it."""
        pixel = self.pixel(context, area)
        if pixel is None:
            return None
        key = (*pixel, self._axis)
        if self._shown is None or self._shown[0] != key:
            frame = self.frame(context, area)
            across = (frame.right - frame.left) / frame.intrinsics.width
            reach = REACH_POINTS * context.preferences.system.ui_scale / across
            self._shown = key, self._at(pixel, reach)
        return self._shown[1]

    def _at(self, pixel, reach):
        from ..on_picture.feature_picking import shown_at

        return shown_at(self._cell, pixel, reach, axis=self._axis, hidden=self._hidden)
