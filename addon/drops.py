# SPDX-License-Identifier: GPL-3.0-or-later
"""What may be dropped on the 3D viewport: a file of these endings in, our operator called."""

import bpy

from .operators.drop_picture import DropPicture
from .operators.open_cell import OpenCell


class OnViewport:
    """A mixin for what is dropped on a 3D viewport and nowhere else."""

    @classmethod
    def poll_drop(cls, context):
        """Blender's question whether it is taken here."""
        return context.area is not None and context.area.type == "VIEW_3D"


class CellDrop(OnViewport, bpy.types.FileHandler):
    """A cell document opens in a scene of its own."""

    bl_idname = "MONOCELL_FH_cell"
    bl_label = "monocell document"
    bl_import_operator = OpenCell.bl_idname
    bl_file_extensions = ".json"


class PictureDrop(OnViewport, bpy.types.FileHandler):
    """The first picture starts a cell once it is said which camera took it; more are sightings."""

    bl_idname = "MONOCELL_FH_picture"
    bl_label = "monocell picture"
    bl_import_operator = DropPicture.bl_idname
    bl_file_extensions = ".png;.jpg;.jpeg;.tif;.tiff;.bmp"


CLASSES = (CellDrop, PictureDrop)
