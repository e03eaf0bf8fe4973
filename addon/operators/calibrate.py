# SPDX-License-Identifier: GPL-3.0-or-later
"""Calibrate: the cell's ball pictures go in, the camera's pose comes out and the camera moves."""

from typing import ClassVar

import bpy

from ..background_job import WorksInBackground
from ..cell.cell_scene import put_camera
from ..cell.document import bare_cell, read_scene, write_scene
from ..panels.steps import FEWEST_SIGHTINGS
from ..polls import NeedsCell


class Calibrate(WorksInBackground, NeedsCell, bpy.types.Operator):
    """Find the ball in every sighting's picture and compute where the camera stands"""

    bl_idname = "monocell.calibrate"
    bl_label = "Calibrate"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        """Blender's question whether the operator can run now."""
        if not super().poll(context):
            return False
        count = len(bare_cell(context.scene).in_use().sightings)
        if count >= FEWEST_SIGHTINGS:
            return True
        cls.poll_message_set(
            f"The cell has {count} ball sightings in use; a pose needs {FEWEST_SIGHTINGS} or more"
        )
        return False

    def prepare(self, context):
        """What is done in the background."""
        from ..camera.calibrating import LOOKS, calibrated

        cell = bare_cell(context.scene)
        total = LOOKS * len(cell.in_use().sightings)
        return "Calibrating", total, lambda watch: calibrated(cell, watch)

    def finish(self, context, result):
        """Let document and Blender's camera take the pose."""
        from ..camera.camera_change import mark_objects, same_camera

        (cell, report), before = result, read_scene(context.scene)
        write_scene(context.scene, cell, report)
        put_camera(context.scene)
        if not same_camera(before.camera, cell.camera):
            mark_objects(context.scene, before)
        level = {"good": "INFO", "weak": "WARNING", "failed": "ERROR"}[report.verdict]
        self.report({level}, f"Calibration {report.verdict}: {report.rms_pixels:.2f} px rms")
        for warning in report.warnings:
            self.report({"WARNING"}, warning)
        return {"FINISHED"}
