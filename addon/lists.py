# SPDX-License-Identifier: GPL-3.0-or-later
"""How the lists of the sidebar show sightings, references and objects."""

from pathlib import PurePath

import bpy

STATUS_ICONS = {
    "": "BLANK1",
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
    "prism": "MESH_DATA",
}


class SightingList(bpy.types.UIList):
    """Ball sightings: picture, place of the ball, and what calibration made of it."""

    bl_idname = "MONOCELL_UL_sightings"

    def draw_item(self, context, layout, data, item, icon, active_data, active_property, index):
        """One row."""
        columns(layout, PurePath(item.picture).stem, item.place, item.residual, item)


def columns(layout, picture, place, residual, item=None):
    """Three columns, the same for the rows and their heading."""
    icon = STATUS_ICONS[item.status] if item is not None else "BLANK1"
    named = layout.split(factor=0.34, align=True)
    named.label(text=picture, icon=icon)
    row = named.split(factor=0.72, align=True)
    row.label(text=place)
    row.label(text=residual)


class ReferenceList(bpy.types.UIList):
    """References: name and where they lie."""

    bl_idname = "MONOCELL_UL_references"

    def draw_item(self, context, layout, data, item, icon, active_data, active_property, index):
        """One row."""
        row = layout.row(align=True)
        row.label(text=item.name, icon="MESH_PLANE" if item.kind == "plane" else "IPO_LINEAR")
        row.label(text=item.place)


class ObjectList(bpy.types.UIList):
    """The cell's objects."""

    bl_idname = "MONOCELL_UL_objects"

    def draw_item(self, context, layout, data, item, icon, active_data, active_property, index):
        """One row."""
        entry = item.get("monocell")
        kind = entry["kind"] if entry else ""
        layout.prop(item, "name", text="", emboss=False, icon=KIND_ICONS.get(kind, "ERROR"))


CLASSES = (SightingList, ReferenceList, ObjectList)
