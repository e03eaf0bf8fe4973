# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties that many operators and panels ask for: a name and its meaning in, a property out."""

from bpy.props import (
    BoolProperty,
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    StringProperty,
)
from bpy.types import OperatorFileListElement

UNITS = (
    ("m", "m", "Metres"),
    ("mm", "mm", "Millimetres, as most robot pendants show"),
    ("cm", "cm", "Centimetres"),
    ("in", "in", "Inches"),
)
LENS_MODELS = (
    ("none", "No distortion", "A perfect lens, or a picture that was rectified"),
    ("plumb_bob", "Plumb bob", "k1 k2 p1 p2 k3, as OpenCV and ROS calibrate by default"),
    ("rational_polynomial", "Rational", "k1 k2 p1 p2 k3 k4 k5 k6"),
    ("equidistant", "Fisheye", "k1 k2 k3 k4 of OpenCV's fisheye model"),
)


def length_property(name, description, **more):
    """A length in metres, shown in the scene's unit."""
    return FloatProperty(name=name, description=description, unit="LENGTH", precision=4, **more)


def place_property(name, description, **more):
    """A point of space, x, y and z in metres, shown in the scene's unit."""
    return FloatVectorProperty(
        name=name,
        description=description,
        size=3,
        subtype="XYZ",
        unit="LENGTH",
        precision=4,
        **more,
    )


def pixels_property(name, description, **more):
    """A length in pixels of the picture."""
    return FloatProperty(name=name, description=description, precision=3, **more)


def count_property(name, description, default, least, most):
    """A whole number within limits."""
    return IntProperty(name=name, description=description, default=default, min=least, max=most)


def unit_property():
    """The unit of positions that come as text."""
    return EnumProperty(
        name="Unit",
        description="Unit of pasted and read positions whose heading names none",
        items=UNITS,
    )


def object_property():
    """The object that is meant, by name."""
    return StringProperty(
        name="Object",
        description="Name of the object; empty: the active one",
        options={"SKIP_SAVE"},
    )


def new_name_property(what):
    """The name of what is made."""
    return StringProperty(
        name="Name",
        description=f"What the {what} is called; empty: the first name that is free",
        options={"SKIP_SAVE"},
    )


def everything_property():
    """Whether all objects are meant."""
    return BoolProperty(
        name="All",
        description="All objects, hidden ones too, not the active one alone",
        options={"SKIP_SAVE"},
    )


def folder_property():
    """The folder that Blender's file browser is in."""
    return StringProperty(
        name="Folder",
        description="Where the files are",
        subtype="DIR_PATH",
        options={"HIDDEN", "SKIP_SAVE"},
    )


def files_property():
    """The files that were chosen in Blender's file browser."""
    return CollectionProperty(
        name="Files",
        description="Names of the chosen files in the folder",
        type=OperatorFileListElement,
        options={"SKIP_SAVE"},
    )


def shows_property(what):
    """What Blender's file browser shows; its name has to be filter_image or filter_folder."""
    return BoolProperty(
        name=f"Show {what}",
        description=f"Whether the file browser shows {what}",
        default=True,
        options={"HIDDEN"},
    )


def endings_property(endings):
    """The endings of the files that Blender's file browser shows; its name is filter_glob."""
    return StringProperty(
        name="Endings",
        description="Endings of the files that the file browser shows",
        default=endings,
        options={"HIDDEN"},
    )
