# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture and a board in, the board's corners in the picture out, or why there are none."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..errors import BoardNotFound
from .board import Board, CharucoBoard, Chessboard
from .view import BoardView, Grey, edge_blur, edges_of

SECTORS = cv2.CALIB_CB_NORMALIZE_IMAGE | cv2.CALIB_CB_EXHAUSTIVE | cv2.CALIB_CB_ACCURACY
QUADS = cv2.CALIB_CB_ADAPTIVE_THRESH | cv2.CALIB_CB_NORMALIZE_IMAGE | cv2.CALIB_CB_FAST_CHECK
# below it the corners of two squares run into each other
SMALLEST_SPACING = 8.0
# blurred beyond this part of a square, the corners next to one pull at it
MOST_BLUR = 0.15
FEWEST_CORNERS = 8
# pictures twice as large as this are searched in half their size
LARGE_ENOUGH = 1200
# three corners in a row, of which the middle lies farther off than this part of a square
MOST_UNEVEN = 0.2
# half a window as a part of what is clear beside an edge, and in pixels
WINDOW, SMALLEST_WINDOW, LARGEST_WINDOW = 1.0, 3, 20
CLOSE = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_MAX_ITER, 60, 1e-3)
Found = tuple[NDArray[np.intp], Array]


def find_board(picture: NDArray[Any], board: Board, name: str) -> BoardView:
    """The corners of `board` in a picture (H, W, 3) or (H, W), 8 or 16 bits.

    Raises BoardNotFound, saying what is wrong: no board, too small, blurred, too little of it.
    """
    grey = grey_of(picture)
    if isinstance(board, CharucoBoard):
        numbers, pixels = _charuco_corners(grey, board)
    else:
        numbers, pixels = _chessboard_corners(grey, board)
    if len(numbers) == 0:
        raise BoardNotFound(f"no {board} found")
    if len(numbers) < FEWEST_CORNERS or np.linalg.matrix_rank(_spread(board, numbers)) < 2:
        raise BoardNotFound(
            f"only {len(numbers)} corners of the board are seen, at least {FEWEST_CORNERS} that "
            "are not on a line are needed"
        )
    view = BoardView(name, board, numbers, pixels, edge_blur(grey, board, numbers, pixels))
    _refuse_poor(view)
    return view


def seen_pattern(picture: NDArray[Any], board: Board) -> Board:
    """The board with the pattern, of before or since OpenCV 4.6, that this picture shows better.

    The two differ only for an even number of rows; everything else is returned as it is.
    """
    if not isinstance(board, CharucoBoard) or board.rows % 2:
        return board
    grey, other = grey_of(picture), replace(board, legacy=not board.legacy)
    found = [len(_charuco_corners(grey, pattern)[0]) for pattern in (board, other)]
    return board if found[0] >= found[1] else other


def grey_of(picture: NDArray[Any]) -> Grey:
    """A picture in 8-bit grey."""
    grey = picture if picture.ndim == 2 else cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY)
    return np.asarray(grey if grey.dtype == np.uint8 else (grey // 257), dtype=np.uint8)


def chessboard_seen(grey: Grey, columns: int, rows: int) -> bool:
    """Whether a board of just so many inner corners is seen."""
    found, _ = cv2.findChessboardCornersSB(grey, (columns, rows), flags=SECTORS)
    return bool(found)


def _chessboard_corners(grey: Grey, board: Chessboard) -> Found:
    numbers = np.arange(len(board.corners))
    # a board is found as well in a smaller picture, and measured in the large one
    for shrink in sorted({_shrink(grey), 1}, reverse=True):
        smaller = _shrunk(grey, shrink)
        found, corners = cv2.findChessboardCornersSB(smaller, board.shape, flags=SECTORS)
        if not found:
            # the older detector stands strong blur and low contrast better
            found, corners = cv2.findChessboardCorners(smaller, board.shape, flags=QUADS)
        if found:
            pixels = (_pixels(corners) + 0.5) * shrink - 0.5
            return numbers, _refined(grey, board, numbers, pixels)
    return numbers[:0], np.zeros((0, 2))


def _charuco_corners(grey: Grey, board: CharucoBoard) -> Found:
    detector = cv2.aruco.CharucoDetector(board.opencv())
    corners, numbers, _, _ = detector.detectBoard(grey)
    if numbers is None or len(numbers) == 0:
        return np.zeros(0, np.intp), np.zeros((0, 2))
    order = np.argsort(numbers.ravel())
    seen = numbers.ravel()[order].astype(np.intp)
    return seen, _refined(grey, board, seen, _pixels(corners)[order])


def _refined(grey: Grey, board: Board, numbers: NDArray[np.intp], pixels: Array) -> Array:
    """Corners to sub-pixels, each in the largest window that holds nothing but its own cross.

    Three times as fine as what the sector detector gives, and free of the half pixel by which
    OpenCV's ChArUco detector is off before 4.13 (opencv#25539).
    """
    halves = _window_halves(board, numbers, pixels)
    refined = pixels.astype(np.float32).reshape(-1, 1, 2)
    for half in np.unique(halves):
        own = halves == half
        window = (int(half), int(half))
        refined[own] = cv2.cornerSubPix(grey, refined[own], window, (-1, -1), CLOSE)
    return _pixels(refined)


def _shrink(grey: Grey) -> int:
    return max(1, max(grey.shape) // LARGE_ENOUGH)


def _shrunk(grey: Grey, shrink: int) -> Grey:
    if shrink == 1:
        return grey
    height, width = (size // shrink for size in grey.shape)
    whole = grey[: height * shrink, : width * shrink]
    return np.asarray(cv2.resize(whole, (width, height), interpolation=cv2.INTER_AREA), np.uint8)


def _window_halves(board: Board, numbers: NDArray[np.intp], pixels: Array) -> NDArray[np.intp]:
    """Half the window of each corner, (N,) in pixels, by its shortest way to a neighbour."""
    start, end = edges_of(board, numbers)
    length = np.linalg.norm(pixels[end] - pixels[start], axis=1)
    shortest = np.full(len(numbers), length.min(initial=np.inf))
    near = np.full(len(numbers), np.inf)
    np.minimum.at(near, start, length)
    np.minimum.at(near, end, length)
    shortest = np.where(np.isfinite(near), near, shortest)
    reach = WINDOW * board.clear * shortest
    halves: NDArray[np.intp] = np.clip(reach, SMALLEST_WINDOW, LARGEST_WINDOW).astype(np.intp)
    return halves


def _unevenness(view: BoardView) -> float:
    """How far a corner lies from the middle of its neighbours in its row, in squares (median).

    Small for every lens and tilt; large where the corners were taken for others.
    """
    start, end = edges_of(view.board, view.numbers)
    beside = view.numbers[end] - view.numbers[start] == 1
    after = np.full(len(view.numbers), -1)
    after[start[beside]] = end[beside]
    first = np.flatnonzero(after >= 0)
    first = first[after[after[first]] >= 0]
    if len(first) == 0:
        return 0.0
    middle, last = after[first], after[after[first]]
    off = view.pixels[first] + view.pixels[last] - 2 * view.pixels[middle]
    return float(np.median(np.linalg.norm(off, axis=1)) / 2 / view.spacing_pixels)


def _refuse_poor(view: BoardView) -> None:
    spacing, blur = view.spacing_pixels, view.blur_pixels
    if _unevenness(view) > MOST_UNEVEN:
        raise BoardNotFound(
            "the corners found do not form the board stated; are its squares and its dictionary "
            "right?"
        )
    if spacing < SMALLEST_SPACING:
        raise BoardNotFound(
            f"too small: its squares are {spacing:.1f} px, at least {SMALLEST_SPACING:g} are "
            "needed; bring the board closer"
        )
    if blur > MOST_BLUR * spacing:
        raise BoardNotFound(
            f"blurred: edges of {blur:.1f} px (sigma) on squares of {spacing:.0f} px; hold the "
            "board still and in focus"
        )


def _spread(board: Board, numbers: NDArray[np.intp]) -> Array:
    places = board.corners[numbers, :2] / board.square
    return places - places.mean(axis=0)


def _pixels(corners: Any) -> Array:
    return np.asarray(corners, dtype=float).reshape(-1, 2)
