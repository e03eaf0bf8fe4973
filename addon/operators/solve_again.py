# SPDX-License-Identifier: GPL-3.0-or-later
"""Solve everything that was picked, again or for the first time, with the camera as it is now."""

from typing import ClassVar

import bpy
from bpy.props import BoolProperty

from ..background_job import WorksInBackground
from ..cell.document import read_scene, show_objects, stored_report, write_scene
from ..polls import NeedsPose


class SolveAgain(WorksInBackground, NeedsPose, bpy.types.Operator):
    """Solve every sketch, and every object with picks again, for the camera of now"""

    bl_idname = "monocell.solve_again"
    bl_label = "Solve All Picks"
    bl_description = (
        "Solve all objects from their picks with the camera as it is now. What was moved by hand "
        "goes back to its picks; objects without picks stay"
    )
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    joint: BoolProperty(
        name="Together",
        description="Solve all objects as one problem, so that what is known of one improves the "
        "others",
        options={"SKIP_SAVE"},
    )

    def prepare(self, context):
        """What is done in the background."""
        from ...core.modelling.solve import model

        cell, joint = read_scene(context.scene), self.joint
        sigma = context.scene.monocell_inputs.pick_sigma_pixels
        return (
            "Solving",
            len(cell.things),
            lambda watch: model(cell, sigma, joint=joint, watch=watch),
        )

    def state_of(self, scene):
        """Objects that were moved meanwhile must not go back unasked."""
        from ...core.document.entries import object_entry

        entries = [object_entry(thing) for thing in read_scene(scene).objects]
        return (*super().state_of(scene), entries)

    def finish(self, context, done):
        """Rebuild what changed."""
        scene = context.scene
        write_scene(scene, done.cell, stored_report(scene))
        told = [*done.warnings, *show_objects(scene, done.cell)]
        scene.monocell_cell.outdated = ""
        self.report({"INFO"}, f"{len(done.results)} objects solved from their picks")
        for warning in (*told, *(w for result in done.results for w in result.warnings)):
            self.report({"WARNING"}, warning)
        return {"FINISHED"}
