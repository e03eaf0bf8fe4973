# SPDX-License-Identifier: GPL-3.0-or-later
"""What may be dropped on the 3D viewport: a file of these endings in, our operator called."""

import bpy

from .cell.document import has_cell
from .operators.add_pictures import AddPictures
from .operators.drop_picture import DropPicture
from .operators.estimate_lens import EstimateLens
from .operators.open_cell import OpenCell

PICTURES = ".png;.jpg;.jpeg;.tif;.tiff;.bmp"


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
    """A picture starts a cell, once it is said which camera took it."""

    bl_idname = "MONOCELL_FH_picture"
    bl_label = "Start a Cell"
    bl_import_operator = DropPicture.bl_idname
    bl_file_extensions = PICTURES


class SightingDrop(OnViewport, bpy.types.FileHandler):
    """Pictures of the ball are added to the cell that is open, with the positions copied."""

    bl_idname = "MONOCELL_FH_sightings"
    bl_label = "Add as Sightings"
    bl_import_operator = AddPictures.bl_idname
    bl_file_extensions = PICTURES

    @classmethod
    def poll_drop(cls, context):
        """There has to be a cell to add them to."""
        return super().poll_drop(context) and has_cell(context.scene)


class BoardDrop(OnViewport, bpy.types.FileHandler):
    """Pictures of a board tell the lens."""

    bl_idname = "MONOCELL_FH_board"
    bl_label = "Estimate the Lens"
    bl_import_operator = EstimateLens.bl_idname
    bl_file_extensions = PICTURES

    @classmethod
    def poll_drop(cls, context):
        """Before a cell is open, or where its camera is to come from a board."""
        asked = context.scene.monocell_inputs.camera_source == "BOARD"
        return super().poll_drop(context) and (asked or not has_cell(context.scene))


CLASSES = (CellDrop, PictureDrop, SightingDrop, BoardDrop)
