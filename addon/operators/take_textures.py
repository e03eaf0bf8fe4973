# SPDX-License-Identifier: GPL-3.0-or-later
"""Give objects the picture's own pixels, face by face, as files beside the document."""

from typing import ClassVar

import bpy

from ..fields import everything_property
from ..modelling.looks_taken import TakesLooks


class TakeTextures(TakesLooks, bpy.types.Operator):
    """Give the active object the picture's pixels on its faces, PNG files beside the cell"""

    bl_idname = "monocell.take_textures"
    bl_label = "Texture from Picture"
    bl_options: ClassVar = {"REGISTER", "UNDO"}
    textured = True

    everything: everything_property()
