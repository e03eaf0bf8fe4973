# SPDX-License-Identifier: GPL-3.0-or-later
"""Add a tube: picks on the picture go in, a tube on the active reference comes out."""

from typing import ClassVar

import bpy

from ..adding import AddsPicked
from ..pick_plan import TUBE


class AddTube(AddsPicked, bpy.types.Operator):
    """Click three points of the base rim, one of the top rim, and the rim of the hole"""

    bl_idname = "monocell.add_tube"
    bl_label = "Add Tube"
    bl_options: ClassVar = {"REGISTER", "UNDO"}
    plan = TUBE
