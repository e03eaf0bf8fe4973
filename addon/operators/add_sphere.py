# SPDX-License-Identifier: GPL-3.0-or-later
"""Add a sphere by clicking on the picture: three points of its outline."""

from typing import ClassVar

import bpy

from ..modelling.adding import AddsPicked, way_property


class AddSphere(AddsPicked, bpy.types.Operator):
    """Click three points of the outline of a ball that rests on the reference"""

    bl_idname = "monocell.add_sphere"
    bl_label = "Add Sphere"
    bl_description = (
        "Click three points of the outline of a ball that rests on the reference. "
        "V lets it float: type its radius"
    )
    bl_options: ClassVar = {"REGISTER", "UNDO"}
    kind = "sphere"
    way: way_property("sphere")
