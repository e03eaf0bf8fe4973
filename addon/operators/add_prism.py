# SPDX-License-Identifier: GPL-3.0-or-later
"""Add a prism: picks on the picture go in, a prism on the active reference comes out."""

from typing import ClassVar

import bpy

from ..adding import AddsPicked
from ..pick_plan import PRISM


class AddPrism(AddsPicked, bpy.types.Operator):
    """Click the base corners going round, Enter, then a top corner"""

    bl_idname = "monocell.add_prism"
    bl_label = "Add Prism"
    bl_options: ClassVar = {"REGISTER", "UNDO"}
    plan = PRISM
