# SPDX-License-Identifier: GPL-3.0-or-later
"""Give objects the colour that the picture shows, in linear light."""

from typing import ClassVar

import bpy

from ..fields import everything_property
from ..modelling.looks_taken import TakesLooks


class TakeColors(TakesLooks, bpy.types.Operator):
    """Give the active object the colour that the picture shows of it"""

    bl_idname = "monocell.take_colors"
    bl_label = "Colour from Picture"
    bl_options: ClassVar = {"REGISTER", "UNDO"}
    textured = False

    everything: everything_property()
