# SPDX-License-Identifier: GPL-3.0-or-later
"""Solve everything that was picked, again or for the first time, with the camera as it is now."""

from typing import ClassVar

import bpy
from bpy.props import BoolProperty

from ..document import read_scene, show_objects, stored_report, write_scene
from ..polls import NeedsPose
from ..refusals import refuses


class SolveAgain(NeedsPose, bpy.types.Operator):
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

    @refuses
    def execute(self, context):
        """Solve, then rebuild what changed."""
        from ...core.modelling.solve import model

        scene = context.scene
        sigma = scene.monocell_inputs.pick_sigma_pixels
        done = model(read_scene(scene), sigma, joint=self.joint)
        write_scene(scene, done.cell, stored_report(scene))
        told = [*done.warnings, *show_objects(scene, done.cell)]
        scene.monocell_cell.outdated = ""
        self.report({"INFO"}, f"{len(done.results)} objects solved from their picks")
        for warning in (*told, *(w for result in done.results for w in result.warnings)):
            self.report({"WARNING"}, warning)
        return {"FINISHED"}
