# SPDX-License-Identifier: GPL-3.0-or-later
"""What may be dropped on the 3D viewport: a file of these endings in, our operator called."""

import bpy

from .operators.drop_picture import DropPicture
from .operators.open_cell import OpenCell


class CellDrop(bpy.types.FileHandler):
    """A cell document opens in a scene of its own."""

    bl_idname = "MONOCELL_FH_cell"
    bl_label = "monocell document"
    bl_import_operator = OpenCell.bl_idname
    bl_file_extensions = ".json"

    @classmethod
    def poll_drop(cls, context):
        """Only on a 3D viewport."""
        return context.area is not None and context.area.type == "VIEW_3D"


class PictureDrop(bpy.types.FileHandler):
    """A picture starts a cell, once it is said which camera took it."""

    bl_idname = "MONOCELL_FH_picture"
    bl_label = "monocell picture"
    bl_import_operator = DropPicture.bl_idname
    bl_file_extensions = ".png;.jpg;.jpeg;.tif;.tiff;.bmp"

    @classmethod
    def poll_drop(cls, context):
        """Only on a 3D viewport."""
        return context.area is not None and context.area.type == "VIEW_3D"


CLASSES = (CellDrop, PictureDrop)
