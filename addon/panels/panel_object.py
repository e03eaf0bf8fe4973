# SPDX-License-Identifier: GPL-3.0-or-later
"""The active object in the sidebar: sizes with locks, what holds it, how it moves, its picks."""

import bpy

from ..cell.document import bare_cell, has_cell
from ..lengths import length, lengths
from ..modelling.model_changes import active_object
from ..operators.add_relation import KINDS, AddRelation
from ..operators.align import Align
from ..operators.move_pick import MovePick
from ..operators.remove_relation import RemoveRelation
from ..operators.set_motion import SetMotion
from ..operators.stand_on import StandOn
from ..operators.take_colors import TakeColors
from ..operators.take_textures import TakeTextures
from ..preferences import settings
from .panel_parts import CellPanel, numbers, paragraph

SAID = {name: label for name, label, _ in KINDS}


class ObjectPanel(CellPanel, bpy.types.Panel):
    """Sizes, relations, motion and looks of the active object."""

    bl_idname = "MONOCELL_PT_object"
    # the object's own name stands in the head
    bl_label = ""
    bl_parent_id = "MONOCELL_PT_model"

    @classmethod
    def poll(cls, context):
        """Blender's question whether it is shown."""
        if not has_cell(context.scene) or active_object(context) is None:
            return False
        return bare_cell(context.scene).camera.camera_from_world is not None

    def draw_header(self, context):
        """The object's name."""
        self.layout.label(text=active_object(context).name)

    def draw(self, context):
        """Blender's call."""
        from ...core.errors import MonocellError
        from ...scene.objects import left_out, read_object

        layout = self.layout
        try:
            thing = read_object(active_object(context))
        except MonocellError as error:
            paragraph(layout, context, str(error), "ERROR")
            return
        for doubt in left_out(active_object(context)):
            paragraph(layout, context, doubt, "ERROR")
        draw_sizes(layout, context, thing)
        numbers(layout, place_rows(thing, settings(context).unit))
        draw_holding(layout, thing)
        column = layout.column(align=True)
        row = column.row(align=True)
        if thing.picks:
            row.operator(MovePick.bl_idname, text="Drag a Pick", icon="SNAP_MIDPOINT")
        row.operator(Align.bl_idname, text="Align", icon="SNAP_EDGE").name = thing.name
        row = column.row(align=True)
        row.operator(TakeColors.bl_idname, text="Colour", icon="EYEDROPPER")
        row.operator(TakeTextures.bl_idname, text="Texture", icon="TEXTURE")
        moves = f"Motion: {thing.motion.kind}"
        column.operator(SetMotion.bl_idname, text=moves, icon="CON_PIVOT")


def draw_sizes(layout, context, thing):
    """A field, 1 sigma and a lock for each size."""
    fields = context.scene.monocell_object
    sigmas, unit = thing.size_sigma(), settings(context).unit
    column = layout.column(align=True)
    for i, name in enumerate(thing.size_names):
        row = column.row(align=True)
        split = row.split(factor=0.66, align=True)
        split.prop(fields, f"size_{i}", text=name.replace("_", " ").capitalize())
        held = name in thing.known
        error = "" if sigmas is None or held else f"± {length(float(sigmas[i]), unit)}"
        split.label(text="typed" if held else error)
        icon = "LOCKED" if held else "UNLOCKED"
        row.prop(fields, f"known_{i}", text="", icon=icon, emboss=False)
    if fields.about != thing.name:
        return
    if fields.refusal:
        paragraph(layout, context, fields.refusal, "ERROR")
    elif fields.warning:
        paragraph(layout, context, fields.warning, "INFO")


def place_rows(thing, unit):
    """Corners, centre and its error."""
    if thing.kind == "prism":
        yield "Corners", str(len(thing.polygon))
    yield "Centre", lengths(thing.world_from_object.translation, unit)
    place = thing.position_sigma()
    if place is not None:
        yield "± 1 sigma", lengths(place, unit)


def draw_holding(layout, thing):
    """What the object stands on and is held by, each with a way to take it away."""
    column = layout.column(align=True)
    told_by_relation = any(relation.to == thing.on for relation in thing.relations)
    if thing.on is not None and not told_by_relation:
        _held_row(column, f"Stands on {thing.on}", -1)
    for i, relation in enumerate(thing.relations):
        own = f" ({relation.own})" if relation.own else ""
        about = f" in {relation.about}" if relation.about else ""
        _held_row(column, f"{SAID[relation.kind]}{own} {relation.to}{about}", i)
    row = column.row(align=True)
    row.operator(AddRelation.bl_idname, text="Relation", icon="ADD")
    row.operator(StandOn.bl_idname, text="Stand on Active", icon="TRIA_DOWN_BAR")


def _held_row(column, text, index):
    row = column.row(align=True)
    row.label(text=text, icon="LINKED")
    row.operator(RemoveRelation.bl_idname, text="", icon="X", emboss=False).index = index
