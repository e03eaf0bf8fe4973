# SPDX-License-Identifier: GPL-3.0-or-later
"""A plane upright on the active one, through two clicks on it: a wall over its foot."""

from typing import ClassVar

import bpy

from ..modelling.reference_adding import PicksUpright


class AddUprightPlane(PicksUpright, bpy.types.Operator):
    """Click two points where a wall meets the active plane"""

    bl_idname = "monocell.add_upright_plane"
    bl_label = "Upright Plane"
    bl_options: ClassVar = {"REGISTER", "UNDO"}
    kind = "plane"
    clicks = 2
