# SPDX-License-Identifier: GPL-3.0-or-later
"""The modal part of modelling: mouse and keys on the picture in, the document's picks out."""

import json

from .on_picture import CONFIRM_EVENTS, OnPicture


class PicksOnPicture(OnPicture):
    """A mixin for operators with a `plan`, a string property `picks` and an `execute`.

    Run by hand it collects the picks on the picture and then executes; called with `picks` (JSON)
    it executes at once. Cancelling leaves nothing behind.
    """

    def invoke(self, context, event):
        """Start picking in the viewport that looks through the camera."""
        from ..core.reference import ReferencePlane
        from .document import bare_cell
        from .pick_session import PickSession

        scene = context.scene
        cell = bare_cell(scene)
        reference = cell.references[scene.monocell_cell.reference_index]
        if not isinstance(reference, ReferencePlane):
            self.report({"ERROR"}, f"{reference.name} is a line; choose a plane to stand things on")
            return {"CANCELLED"}
        self.on = reference.name
        sigma = scene.monocell_inputs.pick_sigma_pixels
        self._session = PickSession(self.plan, cell.camera, reference, sigma)
        self._shown = None
        started = self.begin(context, event)
        if "RUNNING_MODAL" not in started:
            return started
        context.window_manager.monocell_work.picking = True
        # the click that a tool began with is the first pick
        if event.type == "LEFTMOUSE" and event.value == "PRESS":
            return self.handle(context, context.area, event) or started
        return started

    def end(self, context):
        """Let the sightings be seen again."""
        context.window_manager.monocell_work.picking = False
        super().end(context)

    def handle(self, context, area, event):
        """A pick, or a key of ours."""
        if event.value != "PRESS":
            return None
        picked, more = False, event.shift
        if event.type == "LEFTMOUSE":
            aim = self.aim(context, area)
            # what can't be the object is not taken; the words beside the cursor say why
            if aim is not None and not self._preview(aim.pixel).complaint:
                self._session, picked = self._session.picked(aim.pixel), True
        elif event.type == "BACK_SPACE":
            self._session = self._session.taken_back()
        confirmed = event.type in CONFIRM_EVENTS
        if confirmed and self._session.open:
            self._session, confirmed = self._session.advanced(), False
        ended = picked and self._session.complete and (self._session.full or not more)
        if ended or confirmed:
            return self._finish(context)
        self._shown = None
        return None

    def paint(self, context, frame):
        """The object as it would be with a click at the cursor."""
        from .pick_drawing import draw_preview, draw_prompt

        aim = self.aim(context, context.area)
        preview = self._preview(None if aim is None else aim.pixel)
        scale = context.preferences.system.ui_scale
        draw_preview(frame, self._session, preview, self.settings, scale)
        lines = [(line.pixels, self.settings.object_color) for line in preview.lines]
        snapped = self.paint_aim(context, frame, lines)
        draw_prompt(context, self._session, preview, snapped, self.cursor)

    def keys(self):
        """What the status bar tells."""
        return (
            ("MOUSE_LMB", f"{self.plan.kind.capitalize()} on {self.on}: {self._session.prompt}"),
            # the signs of long keys reach beyond the room that Blender gives an icon
            ("EVENT_SHIFT", "    with a click: one more"),
            ("EVENT_BACKSPACE", "    Take back"),
            ("EVENT_RETURN", "    Next" if self._session.open else "    Done"),
            ("EVENT_ESC", "   Cancel"),
        )

    def _finish(self, context):
        self.end(context)
        self.picks = json.dumps(self._session.picks())
        return self.execute(context)

    def _preview(self, pixel):
        """Solved once for each place of the cursor, however often Blender redraws."""
        key = None if pixel is None else tuple(pixel)
        if self._shown is None or self._shown[0] != key:
            self._shown = key, self._session.preview(pixel)
        return self._shown[1]
