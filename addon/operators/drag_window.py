# SPDX-License-Identifier: GPL-3.0-or-later
"""Drag a window: two corners on the picture in, where the active ball is looked for out."""

from typing import ClassVar

import bpy
from bpy.props import FloatVectorProperty

from ..background_job import OpensInBackground
from ..camera.sightings import edit_sighting
from ..cell.cell_scene import show_picture
from ..cell.document import bare_cell
from ..on_picture.camera_view import picking_region
from ..on_picture.on_picture import OnPicture
from ..polls import NeedsSighting
from ..refusals import refuses, refuses_to_start
from ..waiting import waiting
from .show_picture import showing

# a shorter drag is a slip of the hand
LEAST_DRAG = 6.0


class DragWindow(OnPicture, OpensInBackground, NeedsSighting, bpy.types.Operator):
    """Drag a rectangle round the active sighting's ball: it is looked for there only"""

    bl_idname = "monocell.drag_window"
    bl_label = "Drag Window"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    snaps = False
    # Blender's operators have no constructor of ours
    _waited = _dragging = False

    window: FloatVectorProperty(
        name="Window",
        description="Left, top, width and height in pixels of the picture as it came",
        size=4,
        options={"SKIP_SAVE"},
    )

    @refuses_to_start
    def invoke(self, context, event):
        """Show the sighting's own picture first, read in the background where it is another's."""
        scene = context.scene
        sighting = bare_cell(scene).sightings[scene.monocell_cell.sighting_index]
        if not hasattr(sighting, "window"):
            self.report({"ERROR"}, "The active sighting is a point: only balls are looked for")
            return {"CANCELLED"}
        picking_region(context, (event.mouse_x, event.mouse_y))
        if scene.monocell_cell.shown_picture == sighting.picture:
            return self._drag(context, event)
        return self.start(context, event)

    def prepare(self, context):
        """What is done in the background."""
        cell = bare_cell(context.scene)
        return showing(cell, cell.sightings[context.scene.monocell_cell.sighting_index].picture)

    def arrived(self, context, event, plate):
        """Wait for the drag."""
        with waiting(context):
            show_picture(context.scene, plate)
        return self._drag(context, event)

    @refuses
    def execute(self, context):
        """Keep the window with the sighting."""
        index = context.scene.monocell_cell.sighting_index
        window = tuple(round(float(value), 1) for value in self.window)
        edit_sighting(context.scene, index, window=window)
        self.report({"INFO"}, "Window {:.0f}, {:.0f}, {:.0f} x {:.0f} px".format(*window))
        return {"FINISHED"}

    def enter(self, context, event):
        """From now on the mouse drags."""
        self._dragging, self._start = True, None
        super().enter(context, event)

    def modal(self, context, event):
        """The picture first, then the drag."""
        if self._dragging:
            return OnPicture.modal(self, context, event)
        self._waited = True
        return OpensInBackground.modal(self, context, event)

    def cancel(self, context):
        """Blender's own way out."""
        follows = OnPicture if self._dragging else OpensInBackground
        follows.cancel(self, context)

    def handle(self, context, area, event):
        """Press, drag, release."""
        from ..on_picture.picture_frame import window_of

        if event.type != "LEFTMOUSE":
            return None
        if event.value == "PRESS":
            self._start = self.cursor
        elif event.value == "RELEASE" and self._start is not None:
            (x, y), (left, bottom) = self.cursor, self._start
            frame = self.frame(context, area)
            if frame is None or max(abs(x - left), abs(y - bottom)) < LEAST_DRAG:
                self._start = None
                return None
            window = window_of(frame, self._start, self.cursor)
            self.end(context)
            self.window = window
            return self.execute(context)
        return None

    def paint(self, context, frame):
        """The rectangle, or a cross where it would start."""
        import numpy as np

        from ..overlay.drawing import WHITE, YELLOW, draw_crosses, draw_lines

        scale = context.preferences.system.ui_scale
        if self._start is None:
            draw_crosses(np.array([self.cursor]), WHITE, scale)
            return
        (x, y), (left, bottom) = self.cursor, self._start
        corners = [[left, bottom], [x, bottom], [x, y], [left, y], [left, bottom]]
        draw_lines([np.array(corners)], YELLOW, 1.5, scale)

    def keys(self):
        """What the status bar tells."""
        return (("MOUSE_LMB_DRAG", "Drag a rectangle round the ball"), ("EVENT_ESC", "   Cancel"))

    def _drag(self, context, event):
        if not self._waited:
            return self.begin(context, event)
        picking_region(context, (event.mouse_x, event.mouse_y))
        self.enter(context, event)
        return {"RUNNING_MODAL"}
