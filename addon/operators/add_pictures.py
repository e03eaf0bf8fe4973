# SPDX-License-Identifier: GPL-3.0-or-later
"""Add pictures with their positions: chosen files and positions as text in, sightings out."""

from pathlib import Path
from typing import ClassVar

import bpy
from bpy.props import StringProperty

from ..camera.place_inputs import decimals
from ..camera.sightings import add_sightings
from ..fields import files_property, folder_property, shows_property, unit_property
from ..polls import NeedsCell
from ..refusals import refuses


class AddPictures(NeedsCell, bpy.types.Operator):
    """Choose pictures of the ball; their positions are those copied, in the order of the names"""

    bl_idname = "monocell.add_pictures"
    bl_label = "Add Pictures with Positions"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    directory: folder_property()
    files: files_property()
    filter_image: shows_property("pictures")
    filter_folder: shows_property("folders")
    positions: StringProperty(
        name="Positions",
        description="A position a picture: x y z, parted by semicolons here; CSV and JSON too. "
        "Filled with what was copied",
        options={"SKIP_SAVE"},
    )
    unit: unit_property()

    def invoke(self, context, event):
        """Take what was copied, then let pictures be chosen that were not dropped."""
        self.positions = context.window_manager.clipboard
        self.unit = context.scene.monocell_inputs.position_unit
        if self.files:
            return context.window_manager.invoke_props_dialog(self, width=420)
        self.directory = context.scene.monocell_cell.folder + "/"
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def draw(self, context):
        """Blender's call."""
        if len(self.files):
            told = "1 picture" if len(self.files) == 1 else f"{len(self.files)} pictures"
            self.layout.label(text=told, icon="IMAGE_DATA")
        self.layout.prop(self, "positions")
        self.layout.prop(self, "unit", expand=True)
        self.layout.prop(context.scene.monocell_inputs, "ball_radius")

    @refuses
    def execute(self, context):
        """Pair pictures with positions in the order of their names."""
        from ...core.document.sighting_text import Unsaid, sightings_from_text
        from ...core.errors import PictureError

        names = sorted(file.name for file in self.files if file.name)
        if not names:
            raise PictureError("no picture was chosen: choose one for each position")
        radius = float(decimals([context.scene.monocell_inputs.ball_radius])[0])
        given = sightings_from_text(self.positions, Unsaid(names, radius, self.unit))
        count = add_sightings(context.scene, given, Path(bpy.path.abspath(self.directory)))
        self.report({"INFO"}, f"{count} sightings added")
        return {"FINISHED"}
