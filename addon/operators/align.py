# SPDX-License-Identifier: GPL-3.0-or-later
"""Align: solved objects and their picture go in, the objects on its edges come out."""

from typing import ClassVar

import bpy

from ..background_job import WorksInBackground
from ..document import read_scene, show_objects, stored_report, write_scene
from ..fields import everything_property, object_property
from ..polls import NeedsPose


class Align(WorksInBackground, NeedsPose, bpy.types.Operator):
    """Refine objects on the edges of the picture; one that is not believed stays as it is"""

    bl_idname = "monocell.align"
    bl_label = "Align on Edges"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    name: object_property()
    everything: everything_property()

    def prepare(self, context):
        """What is done in the background."""
        from ..aligning import aligned
        from ..model_changes import name_of

        cell = read_scene(context.scene)
        names = None if self.everything else [name_of(context, self.name)]
        total = len(cell.objects) if names is None else 1
        return "Aligning", total, lambda watch: aligned(cell, names, watch)

    def finish(self, context, result):
        """Show what moved, and say what was not believed and why."""
        cell, aligned = result
        scene, found = context.scene, aligned.objects
        write_scene(scene, cell, stored_report(scene))
        told = show_objects(scene, cell, [n for n, one in found.items() if one.believed])
        moved = [one for one in found.values() if one.believed]
        far = max((one.moved_pixels for one in moved), default=0.0)
        self.report(
            {"INFO"},
            f"{len(moved)} of {len(found)} objects aligned, by {far:.1f} px at most; undo takes "
            "it back",
        )
        doubts = [f"{n}: not aligned: {why}" for n, one in found.items() for why in one.reasons]
        for warning in (
            *aligned.warnings,
            *told,
            *doubts,
            *(w for one in moved for w in one.warnings),
        ):
            self.report({"WARNING"}, warning)
        return {"FINISHED"}
