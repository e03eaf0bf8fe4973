# SPDX-License-Identifier: GPL-3.0-or-later
"""Open the cell that the extension brings along: a button goes in, a scene to try things out."""

from pathlib import Path
from typing import ClassVar

import bpy

from ..cell_scene import look_through, open_scene
from ..refusals import refuses

SAMPLE = Path(__file__).resolve().parents[2] / "samples" / "01_table" / "table.cell.json"


class OpenSample(bpy.types.Operator):
    """Open a sample: eight pictures of a ball in a robot's hand, and a table with seven objects"""

    bl_idname = "monocell.open_sample"
    bl_label = "Open the Sample Cell"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    @refuses
    def execute(self, context):
        """Read, build, and look through the camera; it is saved elsewhere, under a new name."""
        from ...core.document.cell_file import read_cell

        cell = read_cell(SAMPLE)
        open_scene(context, cell, "Sample cell")
        look_through(context)
        self.report({"INFO"}, f"{len(cell.sightings)} ball sightings: press Calibrate")
        return {"FINISHED"}
