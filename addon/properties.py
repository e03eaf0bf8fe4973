# SPDX-License-Identifier: GPL-3.0-or-later
"""What a scene holds of its cell: the document's text, its report, and rows for the lists."""

import bpy
import numpy as np
from bpy.props import (
    BoolProperty,
    CollectionProperty,
    FloatProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)

from ..core.sighting import LEAST_RADIUS, MOST_RADIUS
from .camera.lens_inputs import LensInputs
from .camera.place_inputs import decimals
from .camera.sightings import edit_sighting
from .cell.document import bare_cell
from .fields import length_property, place_property
from .inputs import CENTRE_TOLD, SceneInputs
from .modelling.object_fields import ObjectFields


def _sighting(row):
    return bare_cell(row.id_data).sightings[row.index]


def _use(row):
    return _sighting(row).use


def _set_use(row, value):
    edit_sighting(row.id_data, row.index, use=value)


def _place(row):
    place = _sighting(row).center_world
    return (0.0, 0.0, 0.0) if place is None else tuple(place)


def _set_place(row, value):
    """The numbers that were typed; the others keep the digits that Blender does not hold."""
    old = np.array(_place(row))
    typed = np.float32(value) != np.float32(old)
    edit_sighting(row.id_data, row.index, center_world=np.where(typed, decimals(value), old))


def _radius(row):
    return getattr(_sighting(row), "radius", 0.0)


def _set_radius(row, value):
    # a point has none; the field is not shown for it
    if row.kind == "ball":
        radius = min(max(float(decimals([value])[0]), LEAST_RADIUS), MOST_RADIUS)
        edit_sighting(row.id_data, row.index, radius=radius)


class SightingRow(bpy.types.PropertyGroup):
    """One line of the list of sightings: texts to show, and doors to the document's numbers."""

    index: IntProperty(name="Index", description="Its number in the document, from 0")
    kind: StringProperty(name="Kind", description="Whether a ball or a point was seen")
    use: BoolProperty(
        name="Use",
        description="Whether it takes part in finding and calibrating",
        get=_use,
        set=_set_use,
    )
    center: place_property("Place", CENTRE_TOLD, get=_place, set=_set_place)
    radius: length_property(
        "Radius",
        "Radius of the ball, metres",
        min=LEAST_RADIUS,
        max=MOST_RADIUS,
        get=_radius,
        set=_set_radius,
    )
    picture: StringProperty(name="Picture", description="Its name as the document has it")
    status: StringProperty(name="Status", description="What the search or calibration made of it")
    residual: StringProperty(name="Residual", description="What the pose leaves of it, pixels rms")
    reason: StringProperty(name="Reason", description="Why it is doubtful or rejected")


class ReferenceRow(bpy.types.PropertyGroup):
    """One line of the list of references."""

    name: StringProperty(name="Name", description="What objects call it by")
    kind: StringProperty(name="Kind", description="Whether it is a plane or a line")
    place: StringProperty(name="Place", description="Where it lies in the world, metres")


def _active_index(cell):
    active = bpy.context.view_layer.objects.active
    return cell.id_data.objects.find(active.name) if active else -1


def _activate(cell, index):
    if index >= len(cell.id_data.objects):
        # a script may name any; the list never does
        return
    ob = cell.id_data.objects[index]
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

    text: StringProperty(name="Document", description="The cell without its objects, JSON")
    report: StringProperty(name="Report", description="The last search or calibration, JSON")
    folder: StringProperty(name="Folder", description="Where picture names start")
    path: StringProperty(name="File", description="Document it was read from or last saved as")
    folder_beside: StringProperty(
        name="Folder beside", description="The same as seen from the .blend file when it was saved"
    )
    outdated: StringProperty(
        name="Outdated", description="Why objects have to be solved again; empty: they need not"
    )
    shown_picture: StringProperty(name="Shown", description="Picture behind the camera view")
    shown_told: StringProperty(name="Told", description="What is to say of that picture")
    camera: PointerProperty(
        type=bpy.types.Object, name="Camera", description="The camera that took the picture"
    )
    collection: PointerProperty(
        type=bpy.types.Collection, name="Objects", description="Where the cell's objects are"
    )
    sightings: CollectionProperty(
        type=SightingRow, name="Sightings", description="Balls and points whose places are known"
    )
    sighting_index: IntProperty(
        name="Active sighting", description="Its number in the list, from 0"
    )
    references: CollectionProperty(
        type=ReferenceRow, name="References", description="What objects can stand on"
    )
    reference_index: IntProperty(
        name="Active reference", description="What new objects stand on: its number, from 0"
    )
    object_index: IntProperty(
        name="Active object",
        description="Number of the object whose sizes are shown; choosing one selects it",
        get=_active_index,
        set=_activate,
    )


class Work(bpy.types.PropertyGroup):
    """What runs in the background, for the panels; an empty title when nothing does."""

    title: StringProperty(name="Work", description="What is being done; empty: nothing is")
    name: StringProperty(name="Step", description="What it has come to")
    share: FloatProperty(
        name="Done", description="How much of it is done", min=0.0, max=1.0, subtype="FACTOR"
    )
    cancel: BoolProperty(name="Cancel", description="Whether it was told to end")
    reviewing: BoolProperty(
        name="Reviewing", description="Whether what would change is shown, and the model is not"
    )
    picking: BoolProperty(
        name="Picking", description="Whether an object is being picked, and sightings are hidden"
    )


CLASSES = (SightingRow, ReferenceRow, SceneCell, SceneInputs, LensInputs, ObjectFields, Work)


def register():
    """Put the property groups on every scene."""
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Scene.monocell_cell = PointerProperty(type=SceneCell)
    bpy.types.Scene.monocell_inputs = PointerProperty(type=SceneInputs)
    bpy.types.Scene.monocell_lens = PointerProperty(type=LensInputs)
    bpy.types.Scene.monocell_object = PointerProperty(type=ObjectFields)
    bpy.types.WindowManager.monocell_work = PointerProperty(type=Work)


def unregister():
    """Take them off again; what they hold stays in the file."""
    del bpy.types.WindowManager.monocell_work
    del bpy.types.Scene.monocell_object
    del bpy.types.Scene.monocell_lens
    del bpy.types.Scene.monocell_inputs
    del bpy.types.Scene.monocell_cell
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
