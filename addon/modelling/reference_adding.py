# SPDX-License-Identifier: GPL-3.0-or-later
"""What the operators that make references share: clicks on the picture in, an active one out."""

from __future__ import annotations

import json

from bpy.props import StringProperty

from ..fields import new_name_property
from ..on_picture.on_picture import OnPicture
from ..polls import NeedsPose
from ..refusals import refuses, refuses_to_start
from .model_changes import change_model, make_active


def add_reference(operator, context, kind, on, source_of):
    """Add the reference that `source_of` makes of the name of what it stands on, and activate it.

    `operator` has a `name`, empty for the first free one. Raises what resolving it raises.
    """
    from ...core.reference import PendingReference
    from .editing import with_reference
    from .modelled import free_name

    scene = context.scene
    on = on or plane_name(scene)

    def added(cell, sigma):
        operator.name = operator.name or free_name(cell, kind)
        return with_reference(cell, PendingReference(operator.name, kind, source_of(on)), sigma)

    edited = change_model(scene, added)
    make_active(scene, operator.name)
    operator.report({"INFO"}, f"{operator.name} is the active reference")
    for warning in edited.warnings:
        if warning.startswith(operator.name):
            operator.report({"WARNING"}, warning)


def plane_name(scene):
    """The name of the active reference. Raises InvalidValue where that is no plane."""
    from ...core.errors import InvalidValue

    stored = scene.monocell_cell
    row = stored.references[stored.reference_index]
    if row.kind != "plane":
        raise InvalidValue(f"{row.name} is a line; choose the plane to work on")
    return row.name


class PicksUpright(OnPicture, NeedsPose):
    """An operator for what stands upright on the active plane, at `clicks` clicks on it."""

    on: StringProperty(
        name="On",
        description="The plane that was clicked on; empty: the active reference",
        options={"SKIP_SAVE"},
    )
    name: new_name_property("reference")
    picks: StringProperty(
        name="Picks",
        description="JSON, the clicked pixels: [[u, v], ...]",
        options={"HIDDEN", "SKIP_SAVE"},
    )

    @refuses_to_start
    def invoke(self, context, event):
        """Wait for the clicks."""
        self.on = plane_name(context.scene)
        self.pixels = []
        return self.begin(context, event)

    def handle(self, context, area, event):
        """A click, or one taken back."""
        if event.value != "PRESS":
            return None
        aim = self.aim(context, area)
        if event.type == "BACK_SPACE":
            self.pixels = self.pixels[:-1]
        if event.type != "LEFTMOUSE" or aim is None:
            return None
        self.pixels.append(aim.pixel.tolist())
        if len(self.pixels) < self.clicks:
            return None
        self.end(context)
        self.picks = json.dumps(self.pixels)
        return self.execute(context)

    def paint(self, context, frame):
        """Crosses at the clicks and the cursor, and what they make."""
        from ..overlay.reference_drawing import draw_upright

        draw_upright(context, frame, self)

    def keys(self):
        """What the status bar tells."""
        count = f"{len(self.pixels) + 1} of {self.clicks}"
        return (
            ("MOUSE_LMB", f"Upright {self.kind} on {self.on}: foot {count}"),
            ("EVENT_BACKSPACE", "    Take back"),
            ("EVENT_ESC", "   Cancel"),
        )

    @refuses
    def execute(self, context):
        """Add it."""
        from ...core.references.sources import Upright
        from .modelled import parsed_pixels

        pixels = parsed_pixels(self.picks)
        add_reference(self, context, self.kind, self.on, lambda on: Upright(pixels, on))
        return {"FINISHED"}
