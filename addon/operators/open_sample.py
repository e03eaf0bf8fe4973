# SPDX-License-Identifier: GPL-3.0-or-later
"""Open a cell that the extension brings along: a button goes in, a scene to try things out."""

from pathlib import Path
from typing import ClassVar

import bpy
from bpy.props import EnumProperty

from ..background_job import OpensInBackground
from ..cell.cell_scene import PLATE_STEPS, look_through, open_scene
from .open_cell import read_with_plate

FOLDER = Path(__file__).resolve().parents[2] / "samples"
DOCUMENTS = {"STACK": "03_stack/stack.cell.json", "TABLE": "01_table/table.cell.json"}
# an identifier, what the button says, and what its tooltip says
SAMPLES = (
    (
        "STACK",
        "Open a Sample",
        "Eight pictures of a 40 mm ball in a robot's hand, and a bench to model yourself: a carton "
        "with a can on it, a block, a cone, a ball",
    ),
    (
        "TABLE",
        "Sample with Picks",
        "Eight pictures of a 40 mm ball in a robot's hand, and a table with seven objects that a "
        "hand has picked already: Calibrate, then Solve All",
    ),
)


class OpenSample(OpensInBackground, bpy.types.Operator):
    """Open a sample cell: pictures of a ball in a robot's hand, and things to model"""

    bl_idname = "monocell.open_sample"
    bl_label = "Open a Sample Cell"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    sample: EnumProperty(
        name="Sample", description="Which of the two", items=SAMPLES, options={"SKIP_SAVE"}
    )

    @classmethod
    def description(cls, context, properties):
        """Blender's question for the tooltip: that of the sample itself."""
        return next(meaning for name, _, meaning in SAMPLES if name == properties.sample)

    def state_of(self, scene):
        """A scene of its own is made, whatever happens to others meanwhile."""

    def prepare(self, context):
        """What is done in the background."""
        path = FOLDER / DOCUMENTS[self.sample]
        return "Opening", PLATE_STEPS, lambda watch: read_with_plate(path, watch)

    def finish(self, context, result):
        """Build, and look through the camera; it is saved elsewhere, under a new name."""
        cell, plate = result
        open_scene(context, cell, plate, "Sample cell")
        look_through(context)
        self.report({"INFO"}, f"{len(cell.sightings)} ball sightings: press Calibrate")
        return {"FINISHED"}
