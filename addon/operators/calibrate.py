# SPDX-License-Identifier: GPL-3.0-or-later
"""Calibrate the scene's camera from its ball sightings."""

from contextlib import contextmanager
from typing import ClassVar

import bpy

from ..cell_scene import put_camera
from ..document import bare_cell, write_scene
from ..polls import NeedsCell
from ..refusals import refuses
from ..report import report_of

FEWEST_SIGHTINGS = 3


class Calibrate(NeedsCell, bpy.types.Operator):
    """Find the ball in every sighting's picture and compute where the camera stands"""

    bl_idname = "monocell.calibrate"
    bl_label = "Calibrate"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        """Blender's question whether the operator can run now."""
        if not super().poll(context):
            return False
        count = len(bare_cell(context.scene).sightings)
        if count >= FEWEST_SIGHTINGS:
            return True
        cls.poll_message_set(
            f"The document has {count} ball sightings; a pose needs {FEWEST_SIGHTINGS} or more"
        )
        return False

    @refuses
    def execute(self, context):
        """Calibrate, then let document and Blender's camera take the pose."""
        from ...core.calibration.calibrate import calibrate_cell

        given = bare_cell(context.scene)
        with _hourglass(context.window):
            cell, calibration = calibrate_cell(given)
        failed = calibration.verdict == "failed"
        # a pose that can't be trusted is reported, with every outline, but nothing is built on it
        write_scene(context.scene, given if failed else cell, report_of(calibration))
        put_camera(context.scene)
        level = {"good": "INFO", "weak": "WARNING", "failed": "ERROR"}[calibration.verdict]
        self.report(
            {level}, f"Calibration {calibration.verdict}: {calibration.rms_pixels:.2f} px rms"
        )
        for warning in calibration.warnings:
            self.report({"WARNING"}, warning)
        return {"FINISHED"}


@contextmanager
def _hourglass(window):
    """The waiting cursor while pictures are measured, which takes seconds."""
    window.cursor_modal_set("WAIT")
    try:
        yield
    finally:
        window.cursor_modal_restore()
