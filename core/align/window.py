# SPDX-License-Identifier: GPL-3.0-or-later
"""A part of a picture round one object, at a scale that keeps the search for it quick."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from ..arrays import Array
from ..picture.pictures import Picture

# sides are shrunk by whole numbers until the window's area has at most so many pixels
MOST_PIXELS = 14000


@dataclass(frozen=True, eq=False)
class Window:
    """Pixels (x, y) to (x + step columns, y + step rows) of a picture, `step` to one of its own."""

    x: int
    y: int
    step: int
    columns: int
    rows: int

    @staticmethod
    def around(pixels: Array, margin: float, width: int, height: int) -> Window | None:
        """The window that holds pixels (N, 2) and a margin; None where it lies outside."""
        low = np.maximum(np.floor(pixels.min(axis=0) - margin), 0).astype(int)
        high = np.minimum(np.ceil(pixels.max(axis=0) + margin) + 1, [width, height]).astype(int)
        if (high - low < 4).any():
            return None
        step = int(np.ceil(np.sqrt((high - low).prod() / MOST_PIXELS)))
        columns, rows = (high - low) // step
        return Window(int(low[0]), int(low[1]), step, int(columns), int(rows))

    @property
    def finest(self) -> Window:
        """The same part of the picture, pixel by pixel."""
        return Window(self.x, self.y, 1, self.columns * self.step, self.rows * self.step)

    @property
    def right(self) -> int:
        return self.x + self.step * self.columns

    @property
    def bottom(self) -> int:
        return self.y + self.step * self.rows

    @property
    def shape(self) -> tuple[int, int]:
        return self.rows, self.columns

    def cut(self, picture: Picture) -> Picture:
        """This part of a picture, (rows, columns, ...): means over step x step pixels."""
        part = picture[self.y : self.bottom, self.x : self.right]
        if self.step == 1:
            return part
        size = (self.columns, self.rows)
        return np.asarray(cv2.resize(part, size, interpolation=cv2.INTER_AREA))

    def places(self, pixels: Array) -> Array:
        """Pixels (..., 2) of the picture in the window's own."""
        placed: Array = (pixels - [self.x, self.y] + 0.5) / self.step - 0.5
        return placed

    def mask(self, hull: Array) -> Picture:
        """Ones (rows, columns), uint8, inside the hull of pixels (M, 2) of the picture."""
        filled = np.zeros(self.shape, dtype=np.uint8)
        corners = cv2.convexHull(self.places(hull).astype(np.float32))[:, 0]
        cv2.fillConvexPoly(filled, np.round(corners * 16).astype(np.int32), (1,), shift=4)
        return filled


def looked_up(maps: Array, places: Array) -> Array:
    """Maps (rows, columns, C) at places (..., 2), between pixels bilinearly, (..., C).

    Beyond the rim the nearest pixel counts.
    """
    rows, columns = maps.shape[:2]
    x = np.clip(places[..., 0], 0, columns - 1.001)
    y = np.clip(places[..., 1], 0, rows - 1.001)
    i, j = x.astype(np.intp), y.astype(np.intp)
    flat = maps.reshape(rows * columns, -1)
    at, p, q = j * columns + i, (x - i)[..., None], (y - j)[..., None]
    upper = flat[at] * (1 - p) + flat[at + 1] * p
    lower = flat[at + columns] * (1 - p) + flat[at + columns + 1] * p
    mixed: Array = upper * (1 - q) + lower * q
    return mixed
