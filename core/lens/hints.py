# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture without the board asked for in, which other board it shows out, in words."""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from .board import DICTIONARIES, Board, Chessboard
from .detection import SECTORS, chessboard_seen, grey_of
from .view import Grey

# what people print most; then what OpenCV believes to see
COMMON = ((9, 6), (8, 6), (7, 6), (8, 5), (10, 7), (7, 5), (11, 8), (6, 4), (5, 4), (7, 4), (9, 7))
FEWEST_MARKERS = 4
LONGEST_SIDE = 1000


def seen_instead(picture: NDArray[Any], board: Board) -> str | None:
    """A sentence that names another board and how to ask for it, or None where none is seen."""
    grey = _small(grey_of(picture))
    markers = _markers(grey, board)
    if markers is not None:
        return _told_of_markers(*markers, board)
    size = _chessboard(grey, board)
    if size is None:
        return None
    columns, rows = size
    return (
        f"a chessboard of {columns}x{rows} inner corners is seen; did you mean --board chessboard "
        f"{columns}x{rows} {board.square:g}?"
    )


def _told_of_markers(name: str, highest: int, board: Board) -> str | None:
    if isinstance(board, Chessboard):
        return f"markers of {name} are seen; did you mean --board charuco ... {name}?"
    if name != board.dictionary:
        return f"markers of {name} are seen; did you mean {name}?"
    held = board.columns * board.rows // 2
    if highest >= held:
        return (
            f"a marker of number {highest} is seen, a board of {board.columns}x{board.rows} "
            f"squares ends with {held - 1}; count the squares again"
        )
    return (
        f"markers of {name} are seen, but not as on a board of {board.columns}x{board.rows} "
        f"squares; did you mean {board.rows}x{board.columns}?"
    )


def _markers(grey: Grey, board: Board) -> tuple[str, int] | None:
    """The dictionary of which most markers are seen, and the highest number."""
    best: tuple[int, str, int] | None = None
    asked = None if isinstance(board, Chessboard) else board.dictionary
    # of dictionaries that share their markers the one asked for wins, then the smallest
    ordered = sorted(DICTIONARIES.items(), key=lambda one: (one[0] != asked, one[1]))
    for name, number in ordered:
        dictionary = cv2.aruco.getPredefinedDictionary(number)
        _, found, _ = cv2.aruco.ArucoDetector(dictionary).detectMarkers(grey)
        count = 0 if found is None else len(np.unique(found))
        if found is not None and count >= FEWEST_MARKERS and (best is None or count > best[0]):
            best = count, name, int(found.max())
    return None if best is None else best[1:]


def _chessboard(grey: Grey, board: Board) -> tuple[int, int] | None:
    found, _, shape = cv2.findChessboardCornersSBWithMeta(
        grey, (3, 3), flags=SECTORS | cv2.CALIB_CB_LARGER
    )
    believed = [(max(shape.shape), min(shape.shape))] if found and shape is not None else []
    asked = (max(board.shape), min(board.shape))
    for columns, rows in dict.fromkeys([*believed, *COMMON]):
        # a small pattern is seen in any texture
        if (columns, rows) != asked and rows >= 4 and chessboard_seen(grey, columns, rows):
            return columns, rows
    return None


def _small(grey: Grey) -> Grey:
    factor = LONGEST_SIDE / max(grey.shape)
    if factor >= 1:
        return grey
    return np.asarray(
        cv2.resize(grey, None, fx=factor, fy=factor, interpolation=cv2.INTER_AREA), np.uint8
    )
