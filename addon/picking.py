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
        self._session = PickSession(self.plan, cell.camera, reference)
        self._shown = None
        return self.begin(context, event)

    def handle(self, context, area, event):
        """A pick, or a key of ours."""
        if event.value != "PRESS":
            return None
        picked, more = False, event.shift
        if event.type == "LEFTMOUSE":
            pixel = self.pixel(context, area)
            # what can't be the object is not taken; the words beside the cursor say why
            if pixel is not None and not self._preview(pixel).complaint:
                self._session, picked = self._session.picked(pixel), True
        elif event.type == "BACK_SPACE":
            self._session = self._session.taken_back()
        if (picked and self._session.complete and not more) or event.type in CONFIRM_EVENTS:
            return self._finish(context)
        self._shown = None
        return None

    def paint(self, context, frame):
        """The object as it would be with a click at the cursor."""
        from .pick_drawing import draw_session

        preview = self._preview(self.pixel(context, context.area))
        draw_session(context, frame, self._session, preview, self.cursor)

    def keys(self):
        """What the status bar tells."""
        return (
            ("MOUSE_LMB", f"{self.plan.kind.capitalize()} on {self.on}: {self._session.prompt}"),
            # the signs of long keys reach beyond the room that Blender gives an icon
            ("EVENT_SHIFT", "    with a click: more points of the top"),
            ("EVENT_BACKSPACE", "    Take back"),
            ("EVENT_RETURN", "    Done"),
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
