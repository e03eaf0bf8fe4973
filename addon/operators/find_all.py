# SPDX-License-Identifier: GPL-3.0-or-later
"""Find the balls: the sightings' pictures and windows go in, outlines on the picture come out."""

from typing import ClassVar

import bpy

from ..background_job import WorksInBackground
from ..cell.document import bare_cell, stored_report, write_scene
from ..polls import NeedsCell


class FindAll(WorksInBackground, NeedsCell, bpy.types.Operator):
    """Find the ball in every sighting's picture and draw its outline, without calibrating"""

    bl_idname = "monocell.find_all"
    bl_label = "Find All"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        """Blender's question whether the operator can run now."""
        if not super().poll(context):
            return False
        if bare_cell(context.scene).in_use().sightings:
            return True
        cls.poll_message_set("The cell has no ball sightings in use: add some first")
        return False

    def prepare(self, context):
        """What is done in the background."""
        from ..camera.calibrating import found

        cell = bare_cell(context.scene)
        return "Finding", len(cell.in_use().sightings), lambda watch: found(cell, watch)

    def finish(self, context, result):
        """Keep what was found; a pose that is there already stays, and what was told of it."""
        scene, before = context.scene, stored_report(context.scene)
        calibrated = before is not None and before.verdict
        write_scene(scene, bare_cell(scene), before.with_search(result) if calibrated else result)
        balls = sum(seen.ball is not None for seen in result.sightings)
        lost = [i + 1 for i, seen in enumerate(result.sightings) if seen.status == "rejected"]
        self.report({"WARNING" if lost else "INFO"}, f"{balls} balls found{_without(lost)}")
        return {"FINISHED"}


def _without(lost):
    return f"; none in number {', '.join(map(str, lost))}: drag a window round them" if lost else ""
