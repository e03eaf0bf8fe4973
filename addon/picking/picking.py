# SPDX-License-Identifier: GPL-3.0-or-later
"""The modal part of modelling: mouse and keys on the picture in, the document's picks out."""

import json

from ..on_picture.on_picture import CONFIRM_EVENTS, OnPicture
from ..preferences import settings
from ..refusals import refuses_to_start
from .typed_size import typed_key

# how near to its first corner a click closes a polygon, in points of the screen
CLOSING_POINTS = 9.0


class PicksOnPicture(OnPicture):
    """A mixin for operators with a `kind`, a property `way`, texts `picks`, `known`, `on`.

    Run by hand it collects the picks on the picture and then executes; called with `picks` (JSON)
    it executes at once. Cancelling leaves nothing behind.
    """

    @refuses_to_start
    def invoke(self, context, event):
        """Start picking in the viewport that looks through the camera."""
        from ..modelling.modelled import active_reference, standing_cell
        from .pick_plans import plan_of
        from .pick_session import PickSession

        scene = context.scene
        cell = standing_cell(scene)
        reference = active_reference(scene, cell, self.kind)
        self.on = reference.name
        sigma = scene.monocell_inputs.pick_sigma_pixels
        plan = plan_of(self.kind, self.way)
        self._session = PickSession(
            plan,
            cell.standing_camera(),
            reference,
            cell.objects,
            sigma=sigma,
            unit=settings(context).unit,
        )
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
        """A pick, a typed size, or another key of ours."""
        if event.value != "PRESS":
            return None
        self._shown = None
        sign = typed_key(event)
        if event.type == "LEFTMOUSE":
            return self._clicked(context, area, event)
        if event.type in CONFIRM_EVENTS:
            return self._entered(context)
        if event.type == "BACK_SPACE":
            typed = bool(self._session.sized)
            self._session = self._session.without_key() if typed else self._session.taken_back()
        elif event.type == "TAB":
            self._session = self._session.next_size()
        elif event.type == "V":
            self._other_way()
        elif sign:
            self._session = self._session.with_key(sign)
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
        draw_prompt(context, self, self._session, preview, snapped)

    def keys(self):
        """What the status bar tells."""
        on = "" if self._session.plan.held == "floats" else f" on {self.on}"
        return (
            ("MOUSE_LMB", f"{self.kind.capitalize()}{on}: {self._session.prompt}"),
            # the signs of long keys reach beyond the room that Blender gives an icon
            ("EVENT_SHIFT", "    with a click: more of them"),
            ("EVENT_TAB", f"   0-9 type {self._session.size_now.replace('_', ' ')}, Tab the next"),
            *((("EVENT_V", "Another way"),) if self._ways() > 1 else ()),
            ("EVENT_BACKSPACE", "    Take back"),
            ("EVENT_RETURN", "    Done"),
            ("EVENT_ESC", "   Cancel"),
        )

    def _clicked(self, context, area, event):
        aim = self.aim(context, area)
        if aim is None:
            return None
        pixel, session = aim.pixel, self._session
        if session.complete and not event.shift:
            return self._finish(context)
        if session.closes(pixel, self._reach(context, area)):
            self._session = session.with_closed()
            return self._finish(context) if self._session.complete else None
        # what can't be the object is not taken; the words beside the cursor say why
        if self._preview(pixel).complaint:
            return None
        self._session, self._shown = session.picked(pixel, more=event.shift), None
        return self._finish(context) if self._session.complete else None

    def _entered(self, context):
        """Enter closes a polygon; otherwise it ends, if the picks are enough."""
        from ...core.errors import MonocellError

        if self._session.closes(None, 0.0):
            self._session = self._session.with_closed()
            if not self._session.complete:
                return None
        try:
            self._session.solved()
        except MonocellError as error:
            self.report({"WARNING"}, str(error).replace("preview: ", ""))
            return None
        return self._finish(context)

    def _other_way(self):
        from .pick_plans import next_way, plan_of

        self.way = next_way(self.kind, self.way)
        self._session = self._session.replanned(plan_of(self.kind, self.way))

    def _ways(self):
        from .pick_plans import WAYS

        return len(WAYS[self.kind])

    def _reach(self, context, area):
        """How near a click has to be to mean a pick, in pixels of the picture."""
        frame = self.frame(context, area)
        across = (frame.right - frame.left) / frame.intrinsics.width
        return CLOSING_POINTS * context.preferences.system.ui_scale / across

    def _finish(self, context):
        self.end(context)
        known = {k: v for k, v in self._session.known.items() if k not in self._session.plan.known}
        self.picks, self.known = json.dumps(self._session.picks()), json.dumps(known)
        return self.execute(context)

    def _preview(self, pixel):
        """Solved once for each place of the cursor, however often Blender redraws."""
        key = None if pixel is None else tuple(pixel)
        if self._shown is None or self._shown[0] != key:
            self._shown = key, self._session.preview(pixel)
        return self._shown[1]
