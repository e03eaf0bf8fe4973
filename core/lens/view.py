# SPDX-License-Identifier: GPL-3.0-or-later
"""What one picture shows of a board: corners on the board and their pixels, their size and blur."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import cv2
import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from .board import Board

Grey = NDArray[np.uint8]
# an edge blurred by a Gaussian of sigma s has a slope of its contrast over sqrt(2 pi) s
SLOPE = float(np.sqrt(2 * np.pi))
# places across an edge, and how far they reach at most, in pixels
STEPS, REACH = 49, 12.0


@dataclass(frozen=True, eq=False)
class BoardView:
    """Corners of a board in one picture.

    `numbers` (N,) are the places of the corners in `board.corners`, `pixels` (N, 2) where they are
    seen, and `blur_pixels` is the Gaussian sigma of the edges between them.
    """

    picture: str
    board: Board
    numbers: NDArray[np.intp]
    pixels: Array
    blur_pixels: float

    @cached_property
    def points(self) -> Array:
        """The corners' places on the board, (N, 3) in metres."""
        return self.board.corners[self.numbers]

    @property
    def spacing_pixels(self) -> float:
        """The median distance of neighbouring corners in the picture."""
        start, end = edges_of(self.board, self.numbers)
        return float(np.median(np.linalg.norm(self.pixels[end] - self.pixels[start], axis=1)))

    @cached_property
    def hull(self) -> NDArray[np.float32]:
        """The convex hull of the corners' pixels, (M, 2)."""
        hull = cv2.convexHull(self.pixels.astype(np.float32))
        return np.asarray(hull, np.float32).reshape(-1, 2)


def edges_of(board: Board, numbers: NDArray[np.intp]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Pairs of seen corners that are neighbours on the board, as indices into `numbers`."""
    across = board.shape[0]
    place = np.full(len(board.corners) + across + 1, -1)
    place[numbers] = np.arange(len(numbers))
    beside = np.where((numbers + 1) % across == 0, -1, place[numbers + 1])
    below = place[numbers + across]
    ends = np.concatenate([beside, below])
    starts = np.tile(np.arange(len(numbers)), 2)
    return starts[ends >= 0], ends[ends >= 0]


def moved_pixels(one: BoardView, other: BoardView) -> float:
    """The median distance between the corners that both views show; infinite where none is."""
    both, here, there = np.intersect1d(one.numbers, other.numbers, return_indices=True)
    if len(both) == 0:
        return float("inf")
    return float(np.median(np.linalg.norm(one.pixels[here] - other.pixels[there], axis=1)))


def edge_blur(grey: Grey, board: Board, numbers: NDArray[np.intp], pixels: Array) -> float:
    """The Gaussian sigma in pixels of the edges between neighbouring corners, by their slope.

    Measured half way between two corners, across the edge, as far as a marker leaves it clear.
    """
    start, end = edges_of(board, numbers)
    along = pixels[end] - pixels[start]
    length = np.linalg.norm(along, axis=1, keepdims=True)
    normal = np.stack([-along[:, 1], along[:, 0]], 1) / length
    across = normal * np.minimum(0.9 * board.clear * length, REACH)
    steps = np.linspace(-1, 1, STEPS)
    places = 0.5 * (pixels[end] + pixels[start])[:, None] + steps[:, None] * across[:, None]
    seen = cv2.remap(
        grey.astype(np.float32), places.astype(np.float32), np.zeros(0), cv2.INTER_LINEAR
    )
    contrast = np.ptp(seen, axis=1)
    width = 2 * np.linalg.norm(across, axis=1) / (STEPS - 1)
    slope = np.abs(np.diff(seen, axis=1)).max(axis=1) / width
    return float(np.median(contrast / np.maximum(slope, 1e-9)) / SLOPE)
