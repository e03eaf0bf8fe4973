# SPDX-License-Identifier: GPL-3.0-or-later
"""Align: solved objects and their picture go in, the objects on its edges come out."""

from typing import ClassVar

import bpy

from ..background_job import WorksInBackground
from ..cell.document import read_scene, show_objects, stored_report, write_scene
from ..fields import everything_property, object_property
from ..polls import NeedsPose
from ..preferences import settings
from ..review.reviewing import Reviewed


class Align(Reviewed, WorksInBackground, NeedsPose, bpy.types.Operator):
    """Refine objects on the picture's edges: shows what would move, to be taken or left"""

    bl_idname = "monocell.align"
    bl_label = "Align on Edges"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    name: object_property()
    everything: everything_property()

    def prepare(self, context):
        """What is done in the background."""
        from ..modelling.model_changes import name_of
        from ..review.aligning import aligned

        cell = read_scene(context.scene)
        names = None if self.everything else [name_of(context, self.name)]
        total = len(cell.objects) if names is None else 1
        return "Aligning", total, lambda watch: aligned(cell, names, watch)

    def offered(self, context, result):
        """What would move, and what stays."""
        from ..review.offer import offer_of_aligned

        cell, aligned = result
        return offer_of_aligned(cell.objects, aligned.objects, settings(context).unit)

    def take(self, context, result, offer):
        """Move what is taken, and say what was not believed and why."""
        from ..review.aligning import with_taken

        cell, aligned = result
        scene, found = context.scene, aligned.objects
        was = {thing.name: thing for thing in cell.objects}
        now = with_taken(cell, offer.taken)
        write_scene(scene, now, stored_report(scene))
        # what stands on an aligned object has moved with it
        told = show_objects(scene, now, [t.name for t in now.objects if t is not was[t.name]])
        moved = [found[thing.name] for thing in offer.taken]
        far = max((one.moved_pixels for one in moved), default=0.0)
        self.report(
            {"INFO"},
            f"{len(moved)} of {len(found)} objects aligned, by {far:.1f} px at most; undo takes "
            "it back",
        )
        doubts = [f"{n}: not aligned: {why}" for n, one in found.items() for why in one.reasons]
        for warning in (*aligned.warnings, *told, *doubts, *_warnings(moved)):
            self.report({"WARNING"}, warning)
        return {"FINISHED"}


def _warnings(moved):
    return [warning for one in moved for warning in one.warnings]
