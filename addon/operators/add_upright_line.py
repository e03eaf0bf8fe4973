# SPDX-License-Identifier: GPL-3.0-or-later
"""A line upright on the active plane, at a click on it: a post over its foot."""

from typing import ClassVar

import bpy

from ..modelling.reference_adding import PicksUpright


class AddUprightLine(PicksUpright, bpy.types.Operator):
    """Click where a post meets the active plane"""

    bl_idname = "monocell.add_upright_line"
    bl_label = "Upright Line"
    bl_options: ClassVar = {"REGISTER", "UNDO"}
    kind = "line"
    clicks = 1
