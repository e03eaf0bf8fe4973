# SPDX-License-Identifier: GPL-3.0-or-later
"""Add a cylinder by clicking on the picture: three base rim points, then one of the top rim."""

from typing import ClassVar

import bpy

from ..modelling.adding import AddsPicked, way_property


class AddCylinder(AddsPicked, bpy.types.Operator):
    """Click three points of the base rim, then one of the top rim"""

    bl_idname = "monocell.add_cylinder"
    bl_label = "Add Cylinder"
    bl_description = (
        "Click three points of the base rim, then one of the top rim. V lays it on its side"
    )
    bl_options: ClassVar = {"REGISTER", "UNDO"}
    kind = "cylinder"
    way: way_property("cylinder")
