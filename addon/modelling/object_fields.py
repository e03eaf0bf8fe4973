# SPDX-License-Identifier: GPL-3.0-or-later
"""The active object's sizes as fields of the sidebar: typed numbers and locks in, edits out."""

import bpy
from bpy.props import BoolProperty, StringProperty

from ...core.errors import MonocellError
from ..camera.place_inputs import decimals
from ..fields import length_property
from .model_changes import active_object, change_model

MOST_SIZES = 3


def active_thing(context):
    """The active object as it stands in Blender now; None without one, or for one edited out of
    its kind."""
    from ...scene.objects import read_object

    ob = active_object(context)
    if ob is None:
        return None
    try:
        return read_object(ob)
    except MonocellError:
        return None


def _size(place):
    def read(group):
        thing = active_thing(bpy.context)
        sizes = () if thing is None else thing.sizes
        return float(sizes[place]) if place < len(sizes) else 0.0

    return read


def _set_size(place):
    def typed(group, value):
        _change(group, place, float(decimals([value])[0]))

    return typed


def _lock(place):
    def read(group):
        thing = active_thing(bpy.context)
        if thing is None or place >= len(thing.size_names):
            return False
        return thing.size_names[place] in thing.known

    return read


def _set_lock(place):
    def locked(group, value):
        thing = active_thing(bpy.context)
        if thing is not None and place < len(thing.size_names):
            _change(group, place, float(thing.sizes[place]) if value else None)

    return locked


def _change(group, place, metres):
    """Solve with the size; a refusal is kept for the panel, where the number was typed."""
    from .editing import with_size

    thing, scene = active_thing(bpy.context), group.id_data
    if thing is None or place >= len(thing.size_names):
        return
    name, size = thing.name, thing.size_names[place]
    try:
        edited = change_model(scene, lambda cell, sigma: with_size(cell, name, size, metres, sigma))
    except MonocellError as error:
        group.about, group.refusal, group.warning = name, str(error), ""
        return
    group.about, group.refusal = name, ""
    group.warning = "; ".join(w for w in edited.warnings if w.startswith(f"{name}:"))


def _length(place):
    return length_property(
        "Size",
        "Full length or radius, metres. What is typed is held; the rest is solved",
        get=_size(place),
        set=_set_size(place),
    )


def _held(place):
    return BoolProperty(
        name="Known",
        description="Held at this value; otherwise the picks tell it",
        get=_lock(place),
        set=_set_lock(place),
    )


class ObjectFields(bpy.types.PropertyGroup):
    """Doors to the active object's sizes, and what was said to the last that was typed."""

    size_0: _length(0)
    size_1: _length(1)
    size_2: _length(2)
    known_0: _held(0)
    known_1: _held(1)
    known_2: _held(2)
    about: StringProperty(name="About", description="The object that the last number was typed of")
    refusal: StringProperty(name="Refusal", description="Why the last number was refused")
    warning: StringProperty(name="Warning", description="What is doubtful about the last number")
