# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar's third step: what things stand on, and the things."""

import bpy

from .document import bare_cell, has_cell
from .lists import ObjectList, ReferenceList
from .operators.add_box import AddBox
from .operators.add_cone import AddCone
from .operators.add_cylinder import AddCylinder
from .operators.add_frustum import AddFrustum
from .operators.add_prism import AddPrism
from .operators.add_sphere import AddSphere
from .operators.add_tube import AddTube
from .operators.solve_again import SolveAgain
from .panel_parts import CellPanel, next_thing, numbers, paragraph, standing
from .steps import count_objects, model_step

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
        next_thing(layout, context, model_step(scene))
        if not has_cell(scene) or bare_cell(scene).camera.camera_from_world is None:
            return
        stored = scene.monocell_cell
        layout.label(text="Stands on")
        layout.template_list(
            ReferenceList.bl_idname,
            "",
            stored,
            "references",
            stored,
            "reference_index",
            rows=1,
            maxrows=2,
        )
        tools = layout.grid_flow(row_major=True, columns=3, even_columns=True, align=True)
        tools.scale_y = 1.2
        for tool, text, icon in TOOLS:
            tools.operator(tool.bl_idname, text=text, icon=icon)
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
                stored.collection,
                "objects",
                stored,
                "object_index",
                rows=3,
            )
            _draw_sizes(layout, context)
        layout.operator(SolveAgain.bl_idname, icon="FILE_REFRESH")


def _draw_sizes(layout, context):
    """Sizes and place of the active object, with 1 sigma where it is known."""
    from ..core.errors import MonocellError
    from ..scene.objects import is_modelled, read_object

    ob = context.view_layer.objects.active
    if ob is None or not is_modelled(ob):
        return
    try:
        thing = read_object(ob)
    except MonocellError as error:
        paragraph(layout, context, str(error), "ERROR")
        return
    numbers(layout, _rows(thing))


def _rows(thing):
    sigmas, place = thing.size_sigma(), thing.position_sigma()
    for i, (name, size) in enumerate(zip(thing.size_names, thing.sizes, strict=True)):
        error = "" if sigmas is None or sigmas[i] == 0 else f" ± {1e3 * sigmas[i]:.1f}"
        yield name.replace("_", " ").capitalize(), f"{1e3 * size:.1f}{error} mm"
    if thing.kind == "prism":
        yield "Corners", str(len(thing.polygon))
    yield "Centre", ", ".join(f"{1e3 * x:.1f}" for x in thing.world_from_object.translation) + " mm"
    if place is not None:
        yield "± 1 sigma", ", ".join(f"{1e3 * x:.1f}" for x in place) + " mm"
    yield "Stands on", thing.on or "nothing named"
