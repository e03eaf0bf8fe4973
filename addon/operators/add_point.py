# SPDX-License-Identifier: GPL-3.0-or-later
"""Add a known point: the stated place and a click on the picture go in, a sighting comes out."""

from typing import ClassVar

import bpy
from bpy.props import FloatVectorProperty

from ..camera.place_inputs import stated_place
from ..camera.sightings import add_sightings
from ..on_picture.on_picture import OnPicture
from ..polls import NeedsCell
from ..refusals import refuses, refuses_to_start


class AddPoint(OnPicture, NeedsCell, bpy.types.Operator):
    """Click where the picture shows a point whose place is stated; points serve as balls do"""

    bl_idname = "monocell.add_point"
    bl_label = "Click Point"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    pixel_at: FloatVectorProperty(
        name="Pixel",
        description="Pixel of the picture as it came; the centre of the top-left one is 0, 0",
        size=2,
        options={"SKIP_SAVE"},
    )

    @refuses_to_start
    def invoke(self, context, event):
        """Refuse a place that is not stated before the click, not after it."""
        stated_place(context)
        return self.begin(context, event)

    def handle(self, context, area, event):
        """The click."""
        aim = self.aim(context, area)
        if event.type != "LEFTMOUSE" or event.value != "PRESS" or aim is None:
            return None
        self.end(context)
        self.pixel_at = aim.pixel.tolist()
        return self.execute(context)

    def paint(self, context, frame):
        """The cursor, what it snaps to, and the loupe."""
        self.paint_aim(context, frame)

    def keys(self):
        """What the status bar tells."""
        return (("MOUSE_LMB", "Click the point"), ("EVENT_ESC", "   Cancel"))

    @refuses
    def execute(self, context):
        """Make the sighting."""
        from ...core.errors import PictureError
        from ...core.sighting import PointSighting

        scene = context.scene
        picture = scene.monocell_cell.shown_picture
        if not picture:
            raise PictureError("no picture is shown to click on")
        place = stated_place(context)
        pixel = [round(float(value), 3) for value in self.pixel_at]
        point = PointSighting(
            picture, place.center, pixel, world_from_flange=place.world_from_flange
        )
        add_sightings(scene, [point])
        self.report({"INFO"}, "Point at pixel {:.1f}, {:.1f}".format(*pixel))
        return {"FINISHED"}
