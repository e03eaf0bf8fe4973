# SPDX-License-Identifier: GPL-3.0-or-later
"""Add a cone or frustum by clicking on the picture: three base rim points, then tip or top rim."""

from typing import ClassVar

import bpy

from ..modelling.adding import AddsPicked, way_property


class AddCone(AddsPicked, bpy.types.Operator):
    """Click three points of the base rim, then the tip"""

    bl_idname = "monocell.add_cone"
    bl_label = "Add Cone"
    bl_description = (
        "Click three points of the base rim, then the tip. "
        "V makes it a frustum: three points of the top rim"
    )
    bl_options: ClassVar = {"REGISTER", "UNDO"}
    kind = "cone"
    way: way_property("cone")
