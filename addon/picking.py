# SPDX-License-Identifier: GPL-3.0-or-later
"""The modal part of modelling: mouse and keys on the picture in, the document's picks out."""

import json

import bpy

from .cell_scene import looks_through
from .picture_frame import free_part, picture_frame

# what moves the view goes to Blender, so that zoom and pan work as ever
VIEW_EVENTS = frozenset(
    {
        "MOUSEMOVE",
        "INBETWEEN_MOUSEMOVE",
        "MIDDLEMOUSE",
        "WHEELUPMOUSE",
        "WHEELDOWNMOUSE",
        "WHEELINMOUSE",
        "WHEELOUTMOUSE",
        "TRACKPADPAN",
        "TRACKPADZOOM",
        "NDOF_MOTION",
        "HOME",
        "NUMPAD_PLUS",
        "NUMPAD_MINUS",
        "NUMPAD_0",
        "TIMER",
        "WINDOW_DEACTIVATE",
    }
)
CANCEL_EVENTS = frozenset({"ESC", "RIGHTMOUSE"})
DONE_EVENTS = frozenset({"RET", "NUMPAD_ENTER"})


class PicksOnPicture:
    """A mixin for operators with a `plan`, a string property `picks` and an `execute`.

    Run by hand it collects the picks on the picture and then executes; called with `picks` (JSON)
    it executes at once. Cancelling leaves nothing behind.
    """

    def invoke(self, context, event):
        """Start picking in the viewport that looks through the camera."""
        from ..core.reference import ReferencePlane
        from .document import bare_cell
        from .pick_session import PickSession

        scene, space = context.scene, context.space_data
        if space is None or space.type != "VIEW_3D" or not looks_through(scene, space):
            self.report({"ERROR"}, "Look through the cell's camera first: picks are made there")
            return {"CANCELLED"}
        cell = bare_cell(scene)
        reference = cell.references[scene.monocell_cell.reference_index]
        if not isinstance(reference, ReferencePlane):
            self.report({"ERROR"}, f"{reference.name} is a line; choose a plane to stand things on")
            return {"CANCELLED"}
        self.on = reference.name
        self._session = PickSession(self.plan, cell.camera, reference)
        self._cursor, self._shown, self._area = None, None, context.area.as_pointer()
        self._follow(context.area, event)
        self._handle = bpy.types.SpaceView3D.draw_handler_add(
            self._draw, (context,), "WINDOW", "POST_PIXEL"
        )
        context.window_manager.modal_handler_add(self)
        self._tell(context)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        """One event: a pick, a key of ours, or something for Blender."""
        area = self._its_area(context)
        if area is None or (event.type in CANCEL_EVENTS and event.value == "PRESS"):
            self._end(context)
            return {"CANCELLED"}
        if event.type == "MOUSEMOVE":
            self._follow(area, event)
        if event.type == "MIDDLEMOUSE" and not (event.shift or event.ctrl or event.alt):
            # turning would leave the camera, and with it the picture
            return self._pan(context, area, event)
        if event.type in VIEW_EVENTS:
            area.tag_redraw()
            return {"PASS_THROUGH"}
        if event.value == "PRESS":
            return self._press(context, area, event)
        return {"RUNNING_MODAL"}

    def cancel(self, context):
        """Blender's own way out, when a file is loaded or the window closes."""
        self._end(context)

    def _press(self, context, area, event):
        picked, more = False, event.shift
        if event.type == "LEFTMOUSE":
            self._follow(area, event)
            pixel = self._pixel(context, area)
            # what can't be the object is not taken; the words beside the cursor say why
            if pixel is not None and not self._preview(pixel).complaint:
                self._session, picked = self._session.picked(pixel), True
        elif event.type == "BACK_SPACE":
            self._session = self._session.taken_back()
        if (picked and self._session.complete and not more) or event.type in DONE_EVENTS:
            return self._finish(context)
        self._shown = None
        self._tell(context)
        area.tag_redraw()
        return {"RUNNING_MODAL"}

    def _finish(self, context):
        self._end(context)
        self.picks = json.dumps(self._session.picks())
        return self.execute(context)

    def _end(self, context):
        bpy.types.SpaceView3D.draw_handler_remove(self._handle, "WINDOW")
        context.workspace.status_text_set(None)
        area = self._its_area(context)
        if area is not None:
            area.tag_redraw()

    def _pan(self, context, area, event):
        region = _region(area)
        if event.value == "PRESS":
            with context.temp_override(area=area, region=region):
                bpy.ops.view3d.move("INVOKE_DEFAULT")
        return {"RUNNING_MODAL"}

    def _follow(self, area, event):
        """Keep where the mouse is in the region: events count pixels, so its middle is meant."""
        region = _region(area)
        self._cursor = (event.mouse_x - region.x + 0.5, event.mouse_y - region.y + 0.5)

    def _pixel(self, context, area):
        """The pixel under the cursor; None beside the picture or under a sidebar."""
        space, region = area.spaces.active, _region(area)
        if not looks_through(context.scene, space):
            return None
        x, y = self._cursor
        left, bottom, right, top = free_part(area, region)
        if not (left <= x <= right and bottom <= y <= top):
            return None
        intrinsics = self._session.camera.intrinsics
        frame = picture_frame(context.scene, region, space, intrinsics)
        return frame.picture_pixel(x, y) if frame.contains(x, y) else None

    def _its_area(self, context):
        areas = context.window.screen.areas if context.window else ()
        return next((area for area in areas if area.as_pointer() == self._area), None)

    def _preview(self, pixel):
        """Solved once for each place of the cursor, however often Blender redraws."""
        key = None if pixel is None else tuple(pixel)
        if self._shown is None or self._shown[0] != key:
            self._shown = key, self._session.preview(pixel)
        return self._shown[1]

    def _draw(self, context):
        area = context.area
        if area is None or area.as_pointer() != self._area:
            return
        if not looks_through(context.scene, area.spaces.active):
            return
        from .pick_drawing import draw_session

        frame = picture_frame(
            context.scene, context.region, area.spaces.active, self._session.camera.intrinsics
        )
        preview = self._preview(self._pixel(context, area))
        draw_session(context, frame, self._session, preview, self._cursor)

    def _tell(self, context):
        prompt = f"{self.plan.kind.capitalize()} on {self.on}: {self._session.prompt}"

        def draw(header, context):
            row = header.layout.row(align=True)
            for icon, text in (
                ("MOUSE_LMB", prompt),
                # the signs of long keys reach beyond the room that Blender gives an icon
                ("EVENT_SHIFT", "    with a click: more points of the top"),
                ("EVENT_BACKSPACE", "    Take back"),
                ("EVENT_RETURN", "    Done"),
                ("EVENT_ESC", "   Cancel"),
                ("MOUSE_MMB", "Pan, wheel zooms"),
            ):
                row.label(text=text, icon=icon)
                row.separator(factor=2.0)

        context.workspace.status_text_set(draw)


def _region(area):
    return next(region for region in area.regions if region.type == "WINDOW")
