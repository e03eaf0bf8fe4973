# SPDX-License-Identifier: GPL-3.0-or-later
"""A board in, the black rectangles that make it out: what is printed, and what is rendered."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from .board import Board, CharucoBoard


def black_rectangles(board: Board) -> Array:
    """Rectangles (N, 4) as x, y, width, height in squares, from the board's top left corner."""
    columns, rows = board.squares
    y, x = np.mgrid[:rows, :columns].reshape(2, -1)
    # an old ChArUco board with an even number of rows begins with a white square
    shift = isinstance(board, CharucoBoard) and board.legacy and rows % 2 == 0
    black = (x + y + int(shift)) % 2 == 0
    squares = np.stack([x, y, np.ones_like(x), np.ones_like(x)], 1)[black].astype(float)
    if not isinstance(board, CharucoBoard):
        return squares
    white = zip(x[~black], y[~black], strict=True)
    markers = [_marker(board, i, int(a), int(b)) for i, (a, b) in enumerate(white)]
    return np.concatenate([squares, *markers])


def board_picture(board: Board, pixels_per_square: int, margin: float) -> NDArray[np.uint8]:
    """The board in black (0) on white (255), with a white `margin` in squares round it."""
    wide, high = board.squares
    pad = round(margin * pixels_per_square)
    shape = (high * pixels_per_square + 2 * pad, wide * pixels_per_square + 2 * pad)
    picture = np.full(shape, 255, np.uint8)
    for x, y, width, height in black_rectangles(board):
        left, right = (round(pad + v * pixels_per_square) for v in (x, x + width))
        top, bottom = (round(pad + v * pixels_per_square) for v in (y, y + height))
        picture[top:bottom, left:right] = 0
    return picture


def _marker(board: CharucoBoard, number: int, x: int, y: int) -> Array:
    """A marker's black cells, joined along each row."""
    cells = board.markers.markerSize + 2
    drawn = cv2.aruco.generateImageMarker(board.markers, number, cells)
    cell = board.marker / board.square / cells
    gap = 0.5 * (1 - board.marker / board.square)
    rows = []
    for row, line in enumerate(np.asarray(drawn) == 0):
        edges = np.flatnonzero(np.diff(np.concatenate([[0], line.astype(np.int8), [0]])))
        for start, end in zip(edges[::2], edges[1::2], strict=True):
            place = (x + gap + start * cell, y + gap + row * cell)
            rows.append((*place, (end - start) * cell, cell))
    return np.array(rows)
