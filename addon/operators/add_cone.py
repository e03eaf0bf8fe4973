# SPDX-License-Identifier: GPL-3.0-or-later
"""Add a cone: picks on the picture go in, a cone on the active reference comes out."""

from typing import ClassVar

import bpy

from ..adding import AddsPicked
from ..pick_plan import CONE


class AddCone(AddsPicked, bpy.types.Operator):
    """Click three points of the base rim, then the apex"""

    bl_idname = "monocell.add_cone"
    bl_label = "Add Cone"
    bl_options: ClassVar = {"REGISTER", "UNDO"}
    plan = CONE
