# SPDX-License-Identifier: GPL-3.0-or-later
"""Propose: the cell's picture and the active reference go in, what may stand there comes out."""

from typing import ClassVar

import bpy
from bpy.props import BoolProperty, StringProperty

from ..background_job import WorksInBackground
from ..cell.document import bare_cell, read_scene, show_objects, stored_report, write_scene
from ..polls import NeedsPose
from ..preferences import settings
from ..review.reviewing import Reviewed

# about so many parts of a picture are tried
PARTS = 20


class Propose(Reviewed, WorksInBackground, NeedsPose, bpy.types.Operator):
    """Look for boxes and cylinders on the active reference: shows them, to be taken or left"""

    bl_idname = "monocell.propose"
    bl_label = "Propose"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    on: StringProperty(
        name="On",
        description="The plane they stand on; empty: the active reference",
        options={"SKIP_SAVE"},
    )
    doubtful: BoolProperty(
        name="Doubtful Ones Too",
        description="Add what is not believed as well, to be looked at",
        options={"SKIP_SAVE"},
    )

    def prepare(self, context):
        """What is done in the background."""
        from ..review.aligning import proposed

        scene = context.scene
        on = self.on or bare_cell(scene).references[scene.monocell_cell.reference_index].name
        cell = read_scene(scene)
        return "Proposing", PARTS, lambda watch: proposed(cell, on, watch)

    def offered(self, context, result):
        """What may stand there; the doubtful wait for a click."""
        from ..review.offer import offer_of_proposals

        return offer_of_proposals(result, self.doubtful, settings(context).unit)

    def take(self, context, result, offer):
        """Add what is taken as objects like any other."""
        from ..review.aligning import with_taken

        scene, taken = context.scene, offer.taken
        grown = with_taken(read_scene(scene), taken)
        write_scene(scene, grown, stored_report(scene))
        show_objects(scene, grown, [thing.name for thing in taken])
        self.report(
            {"INFO"}, f"{len(taken)} of {len(result)} proposals added; undo takes them back"
        )
        for one in result:
            if not one.believed:
                why = "; ".join(one.reasons)
                self.report({"WARNING"}, f"A {one.thing.kind} is not believed: {why}")
        return {"FINISHED"}
