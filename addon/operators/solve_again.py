# SPDX-License-Identifier: GPL-3.0-or-later
"""Solve everything that was picked, again or for the first time, with the camera as it is now."""

from typing import ClassVar

import bpy

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

    @refuses
    def execute(self, context):
        """Solve, then rebuild what changed."""
        from ...core.modelling.solve import model_cell

        scene = context.scene
        cell, results = model_cell(read_scene(scene), scene.monocell_inputs.pick_sigma_pixels)
        write_scene(scene, cell, stored_report(scene))
        show_objects(scene, cell)
        self.report({"INFO"}, f"{len(results)} objects solved from their picks")
        for warning in (w for result in results for w in result.warnings):
            self.report({"WARNING"}, warning)
        return {"FINISHED"}
