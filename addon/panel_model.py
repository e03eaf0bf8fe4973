# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar's third step: what things stand on, and the things."""

import bpy

from .document import bare_cell, has_cell
from .lists import ObjectList, ReferenceList
from .operators.add_box import AddBox
from .operators.add_cone import AddCone
from .operators.add_cylinder import AddCylinder
from .operators.add_frustum import AddFrustum
from .operators.add_parallel_plane import AddParallelPlane
from .operators.add_prism import AddPrism
from .operators.add_sphere import AddSphere
from .operators.add_tube import AddTube
from .operators.add_upright_line import AddUprightLine
from .operators.add_upright_plane import AddUprightPlane
from .operators.align import Align
from .operators.pick_reference import PickReference
from .operators.propose import Propose
from .operators.remove_reference import RemoveReference
from .operators.solve_again import SolveAgain
from .panel_parts import CellPanel, next_thing, paragraph, standing
from .steps import count_objects, model_step

REVIEW = "See the picture: what is green would be taken. Enter takes it, Esc leaves all as it was."
TOOLS = (
    (AddBox, "Box", "MESH_CUBE"),
    (AddCylinder, "Cylinder", "MESH_CYLINDER"),
    (AddSphere, "Sphere", "MESH_UVSPHERE"),
    (AddPrism, "Prism", "MESH_ICOSPHERE"),
    (AddCone, "Cone", "MESH_CONE"),
    (AddFrustum, "Frustum", "MESH_CONE"),
    (AddTube, "Tube", "MESH_TORUS"),
)


class ModelPanel(CellPanel, bpy.types.Panel):
    """Adds objects, and shows their sizes with 1 sigma."""

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
        next_thing(layout, context, model_step(scene))
        if not has_cell(scene) or bare_cell(scene).camera.camera_from_world is None:
            return
        stored = scene.monocell_cell
        layout.label(text="Stands on")
        row = layout.row()
        row.template_list(
            ReferenceList.bl_idname,
            "",
            stored,
            "references",
            stored,
            "reference_index",
            rows=2,
            maxrows=4,
        )
        _draw_references(row.column(align=True))
        tools = layout.grid_flow(row_major=True, columns=3, even_columns=True, align=True)
        tools.scale_y = 1.2
        for tool, text, icon in TOOLS:
            tools.operator(tool.bl_idname, text=text, icon=icon)
        layout.operator(Propose.bl_idname, icon="VIEWZOOM")
        row = layout.row(align=True)
        row.prop(scene.monocell_inputs, "pick_sigma_pixels", text="Pick noise (px)")
        row.prop(scene.monocell_inputs, "show_grid", text="", icon="GRID")
        self._draw_objects(layout, context)

    def _draw_objects(self, layout, context):
        stored = context.scene.monocell_cell
        if count_objects(context.scene):
            layout.template_list(
                ObjectList.bl_idname,
                "",
                context.scene,
                "objects",
                stored,
                "object_index",
                rows=3,
            )
        row = layout.row(align=True)
        row.operator(SolveAgain.bl_idname, text="Solve All", icon="FILE_REFRESH")
        row.operator(SolveAgain.bl_idname, text="Together", icon="LINKED").joint = True
        row.operator(Align.bl_idname, text="Align All", icon="SNAP_EDGE").everything = True


def _draw_references(column):
    """Ways to a new reference beside their list."""
    column.operator(PickReference.bl_idname, text="", icon="EYEDROPPER")
    column.menu(ReferenceMenu.bl_idname, text="", icon="ADD")
    column.operator(RemoveReference.bl_idname, text="", icon="REMOVE")


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
