# SPDX-License-Identifier: GPL-3.0-or-later
"""Add a tube by clicking on the picture: points of its base rim, its top rim and its hole."""

from typing import ClassVar

import bpy

from ..modelling.adding import AddsPicked, way_property


class AddTube(AddsPicked, bpy.types.Operator):
    """Click three points of the base rim, then one of the top rim and one of the hole"""

    bl_idname = "monocell.add_tube"
    bl_label = "Add Tube"
    bl_options: ClassVar = {"REGISTER", "UNDO"}
    kind = "tube"
    way: way_property("tube")
