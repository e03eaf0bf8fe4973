# SPDX-License-Identifier: GPL-3.0-or-later
"""The toolbar's tools: a table in, one tool for each solid, for references and for picks out."""

import bpy

# verb, what the toolbar calls it, what it does, and one of Blender's own icons
TOOLS = (
    ("add_box", "Box", "Pick a box on the picture", "primitive_cube_add_gizmo"),
    ("add_cylinder", "Cylinder", "Pick a cylinder", "primitive_cylinder_add_gizmo"),
    ("add_sphere", "Sphere", "Pick a ball by its outline", "primitive_sphere_add_gizmo"),
    ("add_cone", "Cone", "Pick a cone, or with V a frustum", "primitive_cone_add_gizmo"),
    ("add_tube", "Tube", "Pick a tube", "primitive_torus_add_gizmo"),
    ("add_prism", "Prism", "Pick a prism by its corners", "primitive_grid_add_gizmo"),
)
REFERENCE = ("pick_reference", "Reference", "Click what things stand on")
PICKS = ("move_pick", "Move Picks", "Drag the picks of the active object")


def _tool(verb, label, meaning, icon):
    return type(
        f"MONOCELL_TOOL_{verb}",
        (bpy.types.WorkSpaceTool,),
        {
            "__module__": __name__,
            "bl_space_type": "VIEW_3D",
            "bl_context_mode": "OBJECT",
            "bl_idname": f"monocell.tool_{verb}",
            "bl_label": f"Cell: {label}",
            "bl_description": f"{meaning}. Look through the cell's camera first",
            "bl_icon": icon,
            "bl_widget": None,
            "bl_keymap": ((f"monocell.{verb}", {"type": "LEFTMOUSE", "value": "PRESS"}, None),),
        },
    )


SOLIDS = tuple(_tool(verb, label, told, f"ops.mesh.{icon}") for verb, label, told, icon in TOOLS)
REFERENCE_TOOL = _tool(*REFERENCE, "ops.generic.cursor")
PICKS_TOOL = _tool(*PICKS, "ops.generic.select")


def register():
    """Put them at the end of the toolbar, the solids in one group."""
    first, *more = SOLIDS
    bpy.utils.register_tool(first, separator=True, group=True)
    before = first
    for tool in more:
        bpy.utils.register_tool(tool, after={before.bl_idname})
        before = tool
    bpy.utils.register_tool(REFERENCE_TOOL)
    bpy.utils.register_tool(PICKS_TOOL)


def unregister():
    """Take them away again."""
    for tool in (PICKS_TOOL, REFERENCE_TOOL, *reversed(SOLIDS)):
        bpy.utils.unregister_tool(tool)
