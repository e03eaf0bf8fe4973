# SPDX-License-Identifier: GPL-3.0-or-later
"""The board that a lens is estimated from, filled in by the user, and what came of it."""

import bpy
from bpy.props import EnumProperty, FloatProperty, IntProperty, StringProperty


def _dictionaries(group, context, typed):
    from ..core.lens.board import DICTIONARIES

    return [name for name in DICTIONARIES if typed.lower() in name.lower()]


class LensInputs(bpy.types.PropertyGroup):
    """A board, the lens model, and the last estimate."""

    board: EnumProperty(
        name="Board",
        description="What was held before the camera",
        items=(
            ("chessboard", "Chessboard", "Black and white squares; all of it has to be seen"),
            ("charuco", "ChArUco", "A chessboard with markers; a part of it may be hidden"),
        ),
    )
    corners_x: IntProperty(
        name="Inner corners across",
        description="Inner corners along the chessboard's longer side: one fewer than its squares",
        default=9,
        min=3,
        max=59,
    )
    corners_y: IntProperty(
        name="Inner corners down",
        description="Inner corners along the chessboard's shorter side: one fewer than its squares",
        default=6,
        min=3,
        max=59,
    )
    squares_x: IntProperty(
        name="Squares across",
        description="Squares of the ChArUco board from left to right",
        default=7,
        min=3,
        max=60,
    )
    squares_y: IntProperty(
        name="Squares down",
        description="Squares of the ChArUco board from top to bottom",
        default=5,
        min=3,
        max=60,
    )
    square: FloatProperty(
        name="Square",
        description="Side of one square, metres: measure across all of them and divide",
        default=0.025,
        min=1e-4,
        max=1.0,
        precision=4,
        unit="LENGTH",
    )
    marker: FloatProperty(
        name="Marker",
        description="Side of one marker with its black rim, metres; smaller than a square",
        default=0.018,
        min=1e-4,
        max=1.0,
        precision=4,
        unit="LENGTH",
    )
    dictionary: StringProperty(
        name="Dictionary",
        description="OpenCV's name of the set that the markers are from, as DICT_5X5_100",
        default="DICT_5X5_100",
        search=_dictionaries,
    )
    model: EnumProperty(
        name="Lens",
        description="Model of the lens distortion that is fitted",
        items=(
            ("auto", "Smallest that fits", "The smallest that foretells unseen corners as well"),
            ("none", "No distortion", "A perfect lens, or pictures that were rectified"),
            ("plumb_bob", "Plumb bob", "k1 k2 p1 p2 k3, as OpenCV and ROS calibrate by default"),
            ("rational_polynomial", "Rational", "k1 k2 p1 p2 k3 k4 k5 k6, for wide lenses"),
            ("equidistant", "Fisheye", "k1 k2 k3 k4 of OpenCV's fisheye model"),
        ),
    )
    estimate: StringProperty(
        name="Last estimate", description="The lens, its errors and its verdict, JSON"
    )
