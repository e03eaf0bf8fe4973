# SPDX-License-Identifier: GPL-3.0-or-later
"""Add one ball: a stated place and the picture that is shown in, a sighting out."""

from typing import ClassVar

import bpy
from bpy.props import StringProperty

from ..camera.place_inputs import decimals, stated_place
from ..camera.sightings import add_sightings
from ..polls import NeedsCell
from ..refusals import refuses


class AddSighting(NeedsCell, bpy.types.Operator):
    """Add a ball at the stated place; its picture is the one that is shown"""

    bl_idname = "monocell.add_sighting"
    bl_label = "Add Ball"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    picture: StringProperty(
        name="Picture", description="Empty: the one that is shown", options={"SKIP_SAVE"}
    )

    @refuses
    def execute(self, context):
        """Make the sighting."""
        from ...core.errors import PictureError
        from ...core.sighting import SphereSighting

        scene = context.scene
        picture = self.picture or scene.monocell_cell.shown_picture
        if not picture:
            raise PictureError("no picture is shown: add pictures with their positions instead")
        place = stated_place(context)
        radius = float(decimals([scene.monocell_inputs.ball_radius])[0])
        sighting = SphereSighting(
            picture, place.center, radius, world_from_flange=place.world_from_flange
        )
        add_sightings(scene, [sighting])
        self.report({"INFO"}, f"Ball {len(scene.monocell_cell.sightings)} in {picture}")
        return {"FINISHED"}
