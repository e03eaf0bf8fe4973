# SPDX-License-Identifier: GPL-3.0-or-later
"""Open a glTF that monocell exported: a file path goes in, a scene of exact objects comes out."""

from typing import ClassVar

import bpy
from bpy_extras.io_utils import ImportHelper

from ..cell.cell_scene import look_through, open_scene
from ..fields import endings_property
from ..refusals import refuses


class OpenGltf(bpy.types.Operator, ImportHelper):
    """Open an exported cell (.glb) in a scene of its own, its objects exact and editable"""

    bl_idname = "monocell.open_gltf"
    bl_label = "Open Exported Cell"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    filename_ext = ".glb"
    filter_glob: endings_property("*.glb")

    @refuses
    def execute(self, context):
        """Read, build, and look through the camera."""
        from pathlib import Path

        from ..modelling.glb_cell import read_glb_cell

        path = bpy.path.abspath(self.filepath)
        cell, lost = read_glb_cell(path)
        scene = open_scene(context, cell, None, Path(path).stem)
        look_through(context)
        self.report({"INFO"}, f"{scene.name}: {len(cell.objects)} objects")
        for warning in lost:
            self.report({"WARNING"}, warning)
        return {"FINISHED"}
