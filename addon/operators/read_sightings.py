# SPDX-License-Identifier: GPL-3.0-or-later
"""Read sightings: a CSV file, a text or a cell document goes in, sightings come out."""

from pathlib import Path
from typing import ClassVar

import bpy
from bpy_extras.io_utils import ImportHelper

from ..camera.place_inputs import decimals
from ..camera.sightings import add_sightings
from ..fields import endings_property
from ..polls import NeedsCell
from ..refusals import refuses


class ReadSightings(NeedsCell, bpy.types.Operator, ImportHelper):
    """Add sightings from a CSV file, a text file or another cell document"""

    bl_idname = "monocell.read_sightings"
    bl_label = "Read Sightings"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    filter_glob: endings_property("*.csv;*.txt;*.tsv;*.json")

    @refuses
    def execute(self, context):
        """Picture names in it start at its own folder."""
        from ...core.document.sighting_text import Unsaid, read_sighting_file

        scene, file = context.scene, Path(bpy.path.abspath(self.filepath)).resolve()
        radius = float(decimals([scene.monocell_inputs.ball_radius])[0])
        shown = scene.monocell_cell.shown_picture
        here = (str((Path(scene.monocell_cell.folder) / shown).resolve()),) if shown else ()
        unit = scene.monocell_inputs.position_unit
        given = read_sighting_file(file, Unsaid(here, radius, unit))
        self.report({"INFO"}, f"{add_sightings(scene, given, file.parent)} sightings added")
        return {"FINISHED"}
