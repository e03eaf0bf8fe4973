# SPDX-License-Identifier: GPL-3.0-or-later
"""What a scene holds of its cell: the document's text, its report, and rows for the lists."""

import bpy
from bpy.props import (
    CollectionProperty,
    FloatProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)


class SightingRow(bpy.types.PropertyGroup):
    """One line of the list of sightings: texts to show, nothing to compute with."""

    picture: StringProperty(name="Picture")
    place: StringProperty(name="Centre of the ball in the world, m, to a centimetre")
    status: StringProperty(name="Status")
    residual: StringProperty(name="Residual, pixels rms")
    reason: StringProperty(name="Reason")


class ReferenceRow(bpy.types.PropertyGroup):
    """One line of the list of references."""

    name: StringProperty(name="Name")
    kind: StringProperty(name="Kind")
    place: StringProperty(name="Where it lies in the world")


def _active_index(cell):
    active = bpy.context.view_layer.objects.active
    return cell.collection.objects.find(active.name) if active and cell.collection else -1


def _activate(cell, index):
    ob = cell.collection.objects[index]
    for other in bpy.context.selected_objects:
        other.select_set(False)
    # hidden and excluded objects can't be selected, and are listed all the same
    if ob.name in bpy.context.view_layer.objects:
        bpy.context.view_layer.objects.active = ob
        ob.select_set(True)


class SceneCell(bpy.types.PropertyGroup):
    """The scene's cell. `text` is the document without objects: those are Blender's own.

    All of it is undone, saved and loaded with the scene. `document.py` alone writes it.
    """

    text: StringProperty(name="Cell document without objects, JSON")
    report: StringProperty(name="Last calibration, JSON")
    folder: StringProperty(name="Folder that picture names start from")
    path: StringProperty(name="Document this was read from or last written to")
    shown_picture: StringProperty(name="Picture behind the camera view")
    camera: PointerProperty(type=bpy.types.Object, name="The cell's camera")
    collection: PointerProperty(type=bpy.types.Collection, name="The cell's objects")
    sightings: CollectionProperty(type=SightingRow)
    sighting_index: IntProperty(name="Active sighting")
    references: CollectionProperty(type=ReferenceRow)
    reference_index: IntProperty(name="Active reference: what new objects stand on")
    object_index: IntProperty(
        name="Active object",
        description="The object whose sizes are shown; choosing one selects it",
        get=_active_index,
        set=_activate,
    )


class SceneInputs(bpy.types.PropertyGroup):
    """What the user fills in before there is a cell, and how sure the picks are."""

    picture: StringProperty(
        name="Picture",
        description="The picture of the cell, as it came from the camera",
        subtype="FILE_PATH",
    )
    camera: StringProperty(
        name="Camera file",
        description="Camera file: ROS camera_info YAML, OpenCV FileStorage or monocell JSON",
        subtype="FILE_PATH",
    )
    pick_sigma_pixels: FloatProperty(
        name="Pick noise",
        description="How far off your clicks are, 1 sigma in pixels of the picture",
        default=1.0,
        min=0.05,
        max=50.0,
        precision=2,
    )


CLASSES = (SightingRow, ReferenceRow, SceneCell, SceneInputs)


def register():
    """Put the property groups on every scene."""
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Scene.monocell_cell = PointerProperty(type=SceneCell)
    bpy.types.Scene.monocell_inputs = PointerProperty(type=SceneInputs)


def unregister():
    """Take them off again; what they hold stays in the file."""
    del bpy.types.Scene.monocell_inputs
    del bpy.types.Scene.monocell_cell
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
