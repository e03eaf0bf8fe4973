# SPDX-License-Identifier: GPL-3.0-or-later
"""Calibration boards: their squares in, the places of their corners on the board out."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import cv2
import numpy as np

from ..arrays import Array, positive
from ..errors import InvalidValue

# a square of a metre is a wall; a number above it was meant in millimetres
LARGEST_SQUARE = 1.0
FEWEST_INNER, MOST_SQUARES = 3, 60
DICTIONARIES: dict[str, int] = {
    name: int(getattr(cv2.aruco, name)) for name in dir(cv2.aruco) if name.startswith("DICT_")
}
KINDS = "chessboard 9x6 0.025, or charuco 7x5 0.03 0.022 DICT_5X5_100"


@dataclass(frozen=True)
class Chessboard:
    """A plain chessboard, named by its **inner** corners: 9x6 has 10 by 7 squares of side `square`.

    The board's frame has its origin at the first inner corner, x along the `columns`, y along the
    `rows`, z into the board. Lengths in metres. Raises InvalidValue.
    """

    columns: int
    rows: int
    square: float

    def __post_init__(self) -> None:
        _check_count(min(self.columns, self.rows), max(self.columns, self.rows) + 1, "corners")
        object.__setattr__(self, "square", _side(self.square, "the board's square"))

    @property
    def squares(self) -> tuple[int, int]:
        """Squares across and down."""
        return self.columns + 1, self.rows + 1

    @property
    def clear(self) -> float:
        """The part of a square beside an edge in which nothing else is printed."""
        return 0.4

    @cached_property
    def corners(self) -> Array:
        """Inner corners (rows * columns, 3) on the board, row by row, z = 0."""
        return _grid(self.columns, self.rows, self.square)

    @cached_property
    def shape(self) -> tuple[int, int]:
        """Inner corners across and down."""
        return self.columns, self.rows

    def __str__(self) -> str:
        return f"chessboard of {self.columns}x{self.rows} inner corners"


@dataclass(frozen=True)
class CharucoBoard:
    """A chessboard with markers in its white squares, named by its **squares**, as OpenCV does.

    `legacy` is the pattern of boards made before OpenCV 4.6: with an even number of rows their
    first square is white. Lengths in metres. Raises InvalidValue.
    """

    columns: int
    rows: int
    square: float
    marker: float
    dictionary: str
    legacy: bool = False

    def __post_init__(self) -> None:
        _check_count(min(self.columns, self.rows), max(self.columns, self.rows), "squares")
        object.__setattr__(self, "square", _side(self.square, "the board's square"))
        object.__setattr__(self, "marker", _side(self.marker, "the board's marker"))
        if not self.marker < self.square:
            raise InvalidValue(
                f"the board's marker of {self.marker:g} m must be smaller than its square of "
                f"{self.square:g} m: the square comes first"
            )
        object.__setattr__(self, "dictionary", dictionary_name(self.dictionary))
        stored = len(self.markers.bytesList)
        if self.columns * self.rows // 2 > stored:
            raise InvalidValue(
                f"a {self.columns}x{self.rows} board needs {self.columns * self.rows // 2} "
                f"markers, {self.dictionary} has {stored}; take a larger dictionary"
            )

    @property
    def squares(self) -> tuple[int, int]:
        """Squares across and down."""
        return self.columns, self.rows

    @property
    def clear(self) -> float:
        """The part of a square beside an edge in which nothing else is printed."""
        return 0.5 * (1 - self.marker / self.square)

    @property
    def markers(self) -> Any:
        """OpenCV's dictionary of the markers."""
        return cv2.aruco.getPredefinedDictionary(DICTIONARIES[self.dictionary])

    @cached_property
    def corners(self) -> Array:
        """Inner corners ((rows-1) * (columns-1), 3) on the board, row by row, z = 0."""
        return _grid(self.columns - 1, self.rows - 1, self.square)

    @cached_property
    def shape(self) -> tuple[int, int]:
        """Inner corners across and down."""
        return self.columns - 1, self.rows - 1

    def opencv(self) -> Any:
        """OpenCV's board."""
        board = cv2.aruco.CharucoBoard(self.squares, self.square, self.marker, self.markers)
        board.setLegacyPattern(self.legacy)
        return board

    def __str__(self) -> str:
        pattern = ", pattern of before OpenCV 4.6" if self.legacy else ""
        return f"ChArUco board of {self.columns}x{self.rows} squares, {self.dictionary}{pattern}"


Board = Chessboard | CharucoBoard


def board_from_words(words: Sequence[str]) -> Board:
    """`chessboard 9x6 0.025` or `charuco 7x5 0.03 0.022 5X5_100` as a board. Raises InvalidValue.

    A chessboard is counted in inner corners, a ChArUco board in squares; sides are in metres.
    """
    kind, *rest = [*words, ""]
    wanted = {"chessboard": 2, "charuco": 4}.get(kind)
    if wanted is None or len(rest) - 1 != wanted:
        raise InvalidValue(f"--board {' '.join(words)}: give it as {KINDS}")
    found = re.fullmatch(r"(\d{1,3})[xX*](\d{1,3})", rest[0])
    if found is None:
        raise InvalidValue(f"--board {kind} {rest[0]}: the size is two numbers such as 9x6")
    columns, rows = int(found[1]), int(found[2])
    square = _number(rest[1], "square")
    if kind == "chessboard":
        return Chessboard(columns, rows, square)
    return CharucoBoard(columns, rows, square, _number(rest[2], "marker"), rest[3])


def dictionary_name(name: str) -> str:
    """OpenCV's own name of a dictionary, with or without DICT_. Raises InvalidValue."""
    full = name.upper() if name.upper().startswith("DICT_") else f"DICT_{name.upper()}"
    # OpenCV writes the AprilTag families with a small h
    for known in DICTIONARIES:
        if known.upper() == full:
            return known
    raise InvalidValue(
        f"{name!r} is no dictionary of OpenCV; such as DICT_4X4_50, DICT_5X5_100, DICT_6X6_250, "
        "DICT_ARUCO_ORIGINAL, DICT_APRILTAG_36h11"
    )


def _grid(columns: int, rows: int, square: float) -> Array:
    y, x = np.mgrid[:rows, :columns].reshape(2, -1)
    return np.stack([x * square, y * square, np.zeros(len(x))], 1)


def _check_count(fewest: int, most: int, what: str) -> None:
    if fewest < FEWEST_INNER or most > MOST_SQUARES:
        raise InvalidValue(
            f"a board needs at least {FEWEST_INNER} {what} and at most {MOST_SQUARES} squares on "
            f"a side, got {fewest} {what} and {most} squares"
        )


def _side(value: float, name: str) -> float:
    side = positive(value, name)
    if side > LARGEST_SQUARE:
        raise InvalidValue(
            f"{name}: {side:g} m is no board's; sides are in metres ({side / 1e3:g} for {side:g} "
            "mm?)"
        )
    return side


def _number(text: str, name: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise InvalidValue(
            f"--board: the {name}'s side must be a number of metres, got {text!r}"
        ) from None
