# SPDX-License-Identifier: GPL-3.0-or-later
"""Add a prism by clicking on the picture: its base corners going round, then a top corner."""

from typing import ClassVar

import bpy

from ..modelling.adding import AddsPicked, way_property


class AddPrism(AddsPicked, bpy.types.Operator):
    """Click the base corners, going round, then the first again or Enter, then a top corner"""

    bl_idname = "monocell.add_prism"
    bl_label = "Add Prism"
    bl_options: ClassVar = {"REGISTER", "UNDO"}
    kind = "prism"
    way: way_property("prism")
