# SPDX-License-Identifier: GPL-3.0-or-later
"""Add a sphere: picks on the picture go in, a sphere on the active reference comes out."""

from typing import ClassVar

import bpy

from ..adding import AddsPicked
from ..pick_plan import SPHERE


class AddSphere(AddsPicked, bpy.types.Operator):
    """Click three points or more of the outline of a ball that lies on the reference"""

    bl_idname = "monocell.add_sphere"
    bl_label = "Add Sphere"
    bl_options: ClassVar = {"REGISTER", "UNDO"}
    plan = SPHERE
