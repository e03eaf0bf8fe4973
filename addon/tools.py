# SPDX-License-Identifier: GPL-3.0-or-later
"""The toolbar: a table of kinds in, a tool for each out, whose first click is the first pick."""

import bpy

ICONS = "ops.mesh.primitive_{}_add_gizmo"
# verb, name, icon
TOOLS = (
    ("add_box", "Picked Box", "cube"),
    ("add_cylinder", "Picked Cylinder", "cylinder"),
    ("add_sphere", "Picked Sphere", "sphere"),
    ("add_prism", "Picked Prism", "grid"),
    ("add_cone", "Picked Cone", "cone"),
    ("add_frustum", "Picked Frustum", "cone"),
    ("add_tube", "Picked Tube", "torus"),
)


def register():
    """Put the tools below Blender's own, as one group."""
    classes = [_tool(*row) for row in TOOLS]
    for i, cls in enumerate(classes):
        after = {classes[0].bl_idname} if i else None
        bpy.utils.register_tool(cls, after=after, separator=not i, group=not i)
    bpy.types.WindowManager.monocell_tools = classes


def unregister():
    """Take them away again."""
    for cls in reversed(bpy.types.WindowManager.monocell_tools):
        bpy.utils.unregister_tool(cls)
    del bpy.types.WindowManager.monocell_tools


def _tool(verb, name, icon):
    """Blender wants a class a tool; all are alike but for their verb."""
    return type(
        f"MONOCELL_TOOL_{verb}",
        (bpy.types.WorkSpaceTool,),
        {
            "bl_space_type": "VIEW_3D",
            "bl_context_mode": "OBJECT",
            "bl_idname": f"monocell.tool_{verb}",
            "bl_label": name,
            "bl_description": f"{name}: click on the picture; the status bar says what is next",
            "bl_icon": ICONS.format(icon),
            "bl_cursor": "CROSSHAIR",
            "bl_widget": None,
            "bl_keymap": ((f"monocell.{verb}", {"type": "LEFTMOUSE", "value": "PRESS"}, None),),
        },
    )
