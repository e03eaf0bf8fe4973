# SPDX-License-Identifier: GPL-3.0-or-later
"""Add a frustum: picks on the picture go in, a cone without its tip comes out."""

from typing import ClassVar

import bpy

from ..adding import AddsPicked, way_property


class AddFrustum(AddsPicked, bpy.types.Operator):
    """Click three points of the base rim, then three of the top rim"""

    bl_idname = "monocell.add_frustum"
    bl_label = "Add Frustum"
    bl_options: ClassVar = {"REGISTER", "UNDO"}
    kind = "cone"
    way: way_property("cone", "FRUSTUM")
