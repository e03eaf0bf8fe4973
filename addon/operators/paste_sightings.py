# SPDX-License-Identifier: GPL-3.0-or-later
"""Paste positions: copied text goes in, sightings or new places of those listed come out."""

from typing import ClassVar

import bpy
from bpy.props import EnumProperty, StringProperty

from ..camera.place_inputs import decimals
from ..camera.sightings import add_sightings, place_sightings
from ..polls import NeedsCell
from ..refusals import refuses


class PasteSightings(NeedsCell, bpy.types.Operator):
    """Paste ball positions: rows of x y z, CSV, or JSON"""

    bl_idname = "monocell.paste_sightings"
    bl_label = "Paste Positions"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    text: StringProperty(
        name="Text",
        description="Rows of x y z; empty: what was copied",
        options={"HIDDEN", "SKIP_SAVE"},
    )
    becomes: EnumProperty(
        name="Becomes",
        description="What the positions become",
        items=(
            ("NEW", "New sightings", "In the pictures they name, or else in the one shown"),
            ("PLACES", "New places", "Of the sightings listed, in their order"),
        ),
        options={"SKIP_SAVE"},
    )

    @classmethod
    def description(cls, context, properties):
        """What the button at hand does."""
        if properties.becomes == "PLACES":
            return "Give the listed sightings the copied positions, in their order"
        return (
            "Add a ball for each copied position: rows of x y z, CSV with a heading, or JSON. "
            "Rows that name no picture are taken to be in the one that is shown"
        )

    @refuses
    def execute(self, context):
        """Read the text, then add or place."""
        from ...core.document.sighting_text import Unsaid, sightings_from_text

        scene, inputs = context.scene, context.scene.monocell_inputs
        text = self.text or context.window_manager.clipboard
        radius = float(decimals([inputs.ball_radius])[0])
        shown = scene.monocell_cell.shown_picture
        pictures = (shown,) if shown else ()
        given = sightings_from_text(text, Unsaid(pictures, radius, inputs.position_unit))
        if self.becomes == "PLACES":
            place_sightings(scene, given)
            self.report({"INFO"}, f"{len(given)} sightings placed")
        else:
            self.report({"INFO"}, f"{add_sightings(scene, given)} sightings added")
        return {"FINISHED"}
