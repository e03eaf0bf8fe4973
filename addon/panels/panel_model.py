# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar's third step: what things stand on, and the things."""

from typing import ClassVar

import bpy

from ..cell.document import bare_cell
from ..operators.add_box import AddBox
from ..operators.add_cone import AddCone
from ..operators.add_cylinder import AddCylinder
from ..operators.add_parallel_plane import AddParallelPlane
from ..operators.add_prism import AddPrism
from ..operators.add_sphere import AddSphere
from ..operators.add_tube import AddTube
from ..operators.add_upright_line import AddUprightLine
from ..operators.add_upright_plane import AddUprightPlane
from ..operators.align import Align
from ..operators.pick_reference import PickReference
from ..operators.propose import Propose
from ..operators.remove_reference import RemoveReference
from ..operators.solve_again import SolveAgain
from .lists import ObjectList, ReferenceList
from .panel_parts import CellPanel, next_thing, paragraph, standing
from .steps import count_objects, is_posed, model_step

REVIEW = "See the picture: what is green would be taken. Enter takes it, Esc leaves all as it was."
TOOLS = (
    (AddBox, "Box", "MESH_CUBE"),
    (AddCylinder, "Cylinder", "MESH_CYLINDER"),
    (AddSphere, "Sphere", "MESH_UVSPHERE"),
    (AddPrism, "Prism", "MESH_ICOSPHERE"),
    (AddCone, "Cone", "MESH_CONE"),
    (AddTube, "Tube", "MESH_TORUS"),
)


class ModelPanel(CellPanel, bpy.types.Panel):
    """Adds objects, and lists them."""

    bl_idname = "MONOCELL_PT_model"
    bl_label = "Model"

    def draw_header(self, context):
        """Blender's call."""
        standing(self.layout, model_step(context.scene))

    def draw(self, context):
        """Blender's call."""
        layout, scene = self.layout, context.scene
        if context.window_manager.monocell_work.reviewing:
            paragraph(layout, context, REVIEW, "INFO")
            return
        step = model_step(scene)
        next_thing(layout, context, step)
        if not is_posed(scene):
            return
        if step.mark == "doubt" or bare_cell(scene).sketches:
            draw_solving(layout)
        _draw_reference(layout, scene)
        tools = layout.grid_flow(row_major=True, columns=3, even_columns=True, align=True)
        for tool, text, icon in TOOLS:
            tools.operator(tool.bl_idname, text=text, icon=icon)
        if count_objects(scene):
            stored = scene.monocell_cell
            layout.template_list(
                *(ObjectList.bl_idname, "", scene, "objects", stored, "object_index"),
                rows=2,
                maxrows=3,
            )


class ReferencesPanel(CellPanel, bpy.types.Panel):
    """What things can stand on, and how it is shown."""

    bl_idname = "MONOCELL_PT_references"
    bl_parent_id = ModelPanel.bl_idname
    bl_label = "References"
    bl_options: ClassVar = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        """Once there is a pose."""
        return is_posed(context.scene)

    def draw(self, context):
        """Blender's call."""
        layout, stored = self.layout, context.scene.monocell_cell
        row = layout.row()
        row.template_list(
            *(ReferenceList.bl_idname, "", stored, "references", stored, "reference_index"),
            rows=3,
            maxrows=6,
        )
        column = row.column(align=True)
        column.operator(PickReference.bl_idname, text="", icon="EYEDROPPER")
        column.menu(ReferenceMenu.bl_idname, text="", icon="ADD")
        column.operator(RemoveReference.bl_idname, text="", icon="REMOVE")
        row = layout.row(align=True)
        row.prop(context.scene.monocell_inputs, "show_grid", text="Grid", icon="GRID", toggle=True)
        row.prop(context.scene.monocell_inputs, "pick_sigma_pixels", text="Pick noise (px)")


class AllObjectsPanel(CellPanel, bpy.types.Panel):
    """What is done with the whole model."""

    bl_idname = "MONOCELL_PT_all_objects"
    bl_parent_id = ModelPanel.bl_idname
    bl_label = "All Objects"
    bl_options: ClassVar = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        """Once there is a pose."""
        return is_posed(context.scene)

    def draw(self, context):
        """Blender's call."""
        draw_solving(self.layout)
        self.layout.operator(Align.bl_idname, text="Align All", icon="SNAP_EDGE").everything = True


def draw_solving(layout):
    """Ways to solve all that was picked."""
    row = layout.row(align=True)
    row.operator(SolveAgain.bl_idname, text="Solve All", icon="FILE_REFRESH")
    row.operator(SolveAgain.bl_idname, text="Together", icon="LINKED").joint = True


def _draw_reference(layout, scene):
    """What new objects stand on, and ways to something else."""
    stored = scene.monocell_cell
    index = stored.reference_index
    there = 0 <= index < len(stored.references)
    row = layout.row(align=True)
    row.label(text=f"New on {stored.references[index].name}" if there else "On nothing")
    row.operator(PickReference.bl_idname, text="", icon="EYEDROPPER")
    row.menu(ReferenceMenu.bl_idname, text="", icon="ADD")
    row.separator()
    row.operator(Propose.bl_idname, icon="VIEWZOOM")


class ReferenceMenu(bpy.types.Menu):
    """Ways to a new reference."""

    bl_idname = "MONOCELL_MT_reference"
    bl_label = "New Reference"

    def draw(self, context):
        """Blender's call."""
        self.layout.operator(PickReference.bl_idname, text="Face, Edge or Axis", icon="EYEDROPPER")
        self.layout.operator(AddUprightPlane.bl_idname, icon="AXIS_SIDE")
        self.layout.operator(AddUprightLine.bl_idname, icon="EMPTY_SINGLE_ARROW")
        self.layout.operator(AddParallelPlane.bl_idname, icon="MOD_ARRAY")
