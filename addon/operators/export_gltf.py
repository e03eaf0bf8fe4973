# SPDX-License-Identifier: GPL-3.0-or-later
"""Export the scene's cell as one binary glTF file."""

from typing import ClassVar

import bpy
from bpy_extras.io_utils import ExportHelper

from ..cell_scene import title_of
from ..document import read_scene
from ..fields import endings_property
from ..polls import NeedsCell
from ..refusals import refuses


class ExportCell(NeedsCell, bpy.types.Operator, ExportHelper):
    """Export objects and camera as a glTF file with exact sizes for robot programs"""

    bl_idname = "monocell.export_gltf"
    bl_label = "Export Cell as glTF"
    bl_options: ClassVar = {"REGISTER"}

    filename_ext = ".glb"
    filter_glob: endings_property("*.glb")

    def invoke(self, context, event):
        """Offer a name beside the document."""
        stored = context.scene.monocell_cell
        folder = bpy.path.abspath("//") or stored.folder + "/"
        self.filepath = folder + title_of(stored.path or context.scene.name) + ".glb"
        return super().invoke(context, event)

    @refuses
    def execute(self, context):
        """Write it whole or not at all."""
        from ...scene.gltf import export_gltf

        path = bpy.path.abspath(self.filepath)
        cell = read_scene(context.scene)
        export_gltf(cell, path)
        self.report({"INFO"}, f"{path}: {len(cell.objects)} objects exported")
        return {"FINISHED"}
