# SPDX-License-Identifier: GPL-3.0-or-later
"""Add a box by clicking on the picture: three base corners, going round, then a top corner."""

from typing import ClassVar

import bpy

from ..modelling.adding import AddsPicked, way_property


class AddBox(AddsPicked, bpy.types.Operator):
    """Click three base corners, going round, then a top corner"""

    bl_idname = "monocell.add_box"
    bl_label = "Add Box"
    bl_options: ClassVar = {"REGISTER", "UNDO"}
    kind = "box"
    way: way_property("box")
