# SPDX-License-Identifier: GPL-3.0-or-later
"""What a user fills in before a cell, a sighting or an object is made; nothing is computed here."""

import bpy
from bpy.props import (
    BoolProperty,
    EnumProperty,
    FloatProperty,
    StringProperty,
)

from ..core.sighting import LEAST_RADIUS, MOST_RADIUS
from .fields import LENS_MODELS, length_property, pixels_property, place_property, unit_property

CENTRE_TOLD = "Centre of the ball, or the point, in the world, metres"


class SceneInputs(bpy.types.PropertyGroup):
    """What the user fills in before there is a cell, and how sure the picks are."""

    picture: StringProperty(
        name="Picture",
        description="The picture of the cell, as it came from the camera",
        subtype="FILE_PATH",
    )
    camera_source: EnumProperty(
        name="Camera",
        description="Where the camera's numbers come from",
        items=(
            (
                "FILE",
                "File",
                "A camera file: ROS, OpenCV, Kalibr, COLMAP, fSpy, ViSP, nerfstudio, "
                "or what `monocell lens` wrote",
            ),
            ("PIXELS", "Pixels", "Focal lengths and principal point in pixels, typed"),
            ("ANGLE", "Angle", "The horizontal field of view in degrees, as data sheets give it"),
            ("BOARD", "Board", "Estimated from pictures of a chessboard or ChArUco board"),
        ),
    )
    camera: StringProperty(
        name="Camera file",
        description="ROS camera_info YAML, OpenCV FileStorage, Kalibr camchain, COLMAP "
        "cameras.txt, fSpy or nerfstudio JSON, ViSP XML, monocell JSON, or what `monocell lens` "
        "wrote or told with --json",
        subtype="FILE_PATH",
    )
    focal_x: pixels_property(
        "fx",
        "Focal length along the picture's rows, pixels",
        default=1000.0,
        min=1.0,
        soft_max=5000.0,
    )
    focal_y: pixels_property(
        "fy",
        "Focal length down the picture, pixels; 0: the same as fx",
        min=0.0,
        soft_max=5000.0,
    )
    field_degrees: FloatProperty(
        name="Field of view",
        description="Angle in degrees between the left and the right rim of the picture",
        default=60.0,
        min=0.5,
        max=170.0,
        precision=2,
    )
    centred: BoolProperty(
        name="Centred",
        description="Whether the principal point is taken to be the middle of the picture",
        default=True,
    )
    centre_x: pixels_property(
        "cx",
        "Principal point, pixels to the right of the centre of the top-left pixel",
    )
    centre_y: pixels_property(
        "cy",
        "Principal point, pixels down from the centre of the top-left pixel",
    )
    lens_model: EnumProperty(
        name="Lens",
        description="Model of the lens distortion",
        items=LENS_MODELS,
    )
    coefficients: StringProperty(
        name="Coefficients",
        description="The lens model's coefficients, without units, parted by blanks or commas",
    )
    pick_sigma_pixels: FloatProperty(
        name="Pick noise",
        description="How far off your clicks are, 1 sigma in pixels of the picture",
        default=1.0,
        min=0.05,
        max=50.0,
        precision=2,
    )
    show_grid: BoolProperty(
        name="Grid",
        description="Draw the active reference as a grid on the picture",
        default=True,
    )
    ball_radius: length_property(
        "Ball radius",
        "Radius of the ball of new sightings, metres",
        default=0.04,
        min=LEAST_RADIUS,
        max=MOST_RADIUS,
        soft_max=0.5,
    )
    position_unit: unit_property()
    place_source: EnumProperty(
        name="Place",
        description="What tells where the ball or the point is in the world",
        items=(
            ("TYPED", "Typed", "x, y and z in the world"),
            ("CURSOR", "3D Cursor", "Where Blender's 3D cursor is"),
            ("OBJECT", "Object", "The active object, or the active bone of a posed robot"),
            ("JOINTS", "Joints", "Joint angles through the robot's URDF"),
        ),
    )
    place: place_property("Place", CENTRE_TOLD)
    urdf: StringProperty(
        name="URDF",
        description="Robot description file; meshes need not be there",
        subtype="FILE_PATH",
    )
    flange: StringProperty(
        name="Flange", description="The URDF's link that carries the ball; empty: its last one"
    )
    joints: StringProperty(
        name="Joints",
        description="Values of the moving joints from the base on, parted by blanks or commas; "
        "sliding joints in metres",
    )
    joint_unit: EnumProperty(
        name="Angles",
        description="Unit of the joint angles",
        items=(
            ("DEGREES", "Degrees", "A full turn is 360"),
            ("RADIANS", "Radians", "A full turn is 2 π"),
        ),
    )
    offset_known: BoolProperty(
        name="Offset known",
        description="Whether it is known where on the flange the ball sits. Otherwise it is solved "
        "for, from the flange's poses; then every sighting has to tell its flange",
        default=True,
    )
    offset: place_property(
        "Offset", "The ball's centre, or the point, in the frame of the flange or object, metres"
    )
