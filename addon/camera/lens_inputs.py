# SPDX-License-Identifier: GPL-3.0-or-later
"""The board that a lens is estimated from, filled in by the user, and what came of it."""

import bpy
from bpy.props import EnumProperty, StringProperty

from ..fields import LENS_MODELS, count_property, length_property


def _dictionaries(group, context, typed):
    from ...core.lens.board import DICTIONARIES

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
    corners_x: count_property(
        "Inner corners across",
        "Inner corners along the chessboard's longer side: one fewer than its squares",
        9,
        3,
        59,
    )
    corners_y: count_property(
        "Inner corners down",
        "Inner corners along the chessboard's shorter side: one fewer than its squares",
        6,
        3,
        59,
    )
    squares_x: count_property(
        "Squares across",
        "Squares of the ChArUco board from left to right",
        7,
        3,
        60,
    )
    squares_y: count_property(
        "Squares down",
        "Squares of the ChArUco board from top to bottom",
        5,
        3,
        60,
    )
    square: length_property(
        "Square",
        "Side of one square, metres: measure across all of them and divide",
        default=0.025,
        min=1e-4,
        max=1.0,
    )
    marker: length_property(
        "Marker",
        "Side of one marker with its black rim, metres; smaller than a square",
        default=0.018,
        min=1e-4,
        max=1.0,
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
            *LENS_MODELS,
        ),
    )
    estimate: StringProperty(
        name="Last estimate", description="The lens, its errors and its verdict, JSON"
    )
