# SPDX-License-Identifier: GPL-3.0-or-later
"""How the lists of the sidebar show sightings, references and objects."""

from pathlib import PurePath

import bpy

STATUS_ICONS = {
    "": "BLANK1",
    "found": "MESH_CIRCLE",
    "used": "CHECKMARK",
    "doubtful": "QUESTION",
    "rejected": "CANCEL",
}
KIND_ICONS = {
    "box": "MESH_CUBE",
    "cylinder": "MESH_CYLINDER",
    "sphere": "MESH_UVSPHERE",
    "cone": "MESH_CONE",
    "tube": "MESH_TORUS",
    "prism": "MESH_ICOSPHERE",
}


class SightingList(bpy.types.UIList):
    """Sightings: whether in use, number and picture, and what the pose leaves of it in pixels."""

    bl_idname = "MONOCELL_UL_sightings"

    def draw_item(self, context, layout, data, item, icon, active_data, active_property, index):
        """One row."""
        row = layout.row(align=True)
        row.prop(item, "use", text="")
        rest = row.row(align=True)
        rest.active = item.use
        named = rest.split(factor=0.78, align=True)
        name = f"{item.index + 1}  {PurePath(item.picture).stem}"
        named.label(text=name, icon=STATUS_ICONS[item.status])
        named.label(text=item.residual)


class ReferenceList(bpy.types.UIList):
    """References: name and where they lie."""

    bl_idname = "MONOCELL_UL_references"

    def draw_item(self, context, layout, data, item, icon, active_data, active_property, index):
        """One row."""
        row = layout.row(align=True)
        row.label(text=item.name, icon="MESH_PLANE" if item.kind == "plane" else "IPO_LINEAR")
        row.label(text=item.place)


class ObjectList(bpy.types.UIList):
    """The cell's objects, of all that the scene has."""

    bl_idname = "MONOCELL_UL_objects"

    def filter_items(self, context, data, property):
        """Blender's question what is listed, and in which order."""
        from ...scene.objects import is_modelled

        typed = self.filter_name.lower()
        shown = [is_modelled(ob) and typed in ob.name.lower() for ob in data.objects]
        return [self.bitflag_filter_item if show else 0 for show in shown], []

    def draw_item(self, context, layout, data, item, icon, active_data, active_property, index):
        """One row."""
        entry = item.get("monocell")
        kind = entry["kind"] if entry else ""
        layout.prop(item, "name", text="", emboss=False, icon=KIND_ICONS.get(kind, "ERROR"))


CLASSES = (SightingList, ReferenceList, ObjectList)
