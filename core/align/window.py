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
MOST_ROWS = 30000
# pixels; whole numbers of OpenCV's drawing end not far beyond
FARTHEST = 1e5


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
        places = self.places(hull)
        places = places[np.isfinite(places).all(axis=-1)]
        if not len(places):
            return filled
        # what lies that far out bounds the window as well as what lies farther
        near = np.clip(places, -FARTHEST, FARTHEST)
        corners = cv2.convexHull(near.astype(np.float32))[:, 0]
        cv2.fillConvexPoly(filled, np.round(corners * 16).astype(np.int32), (1,), shift=4)
        return filled


def looked_up(maps: Picture, places: Array) -> Array:
    """Maps (rows, columns, C) at places (..., 2), between pixels bilinearly, (..., C).

    Beyond the rim the nearest pixel counts. C is four at most.
    """
    flat = places.reshape(-1, places.shape[-2], 2).astype(np.float32)
    if not flat.size:
        return np.zeros((*places.shape[:-1], maps.shape[2]))
    found = np.empty((*flat.shape[:2], maps.shape[2]), dtype=np.float32)
    source = np.ascontiguousarray(maps, dtype=np.float32)
    # remap takes less than 32768 rows at once
    for start in range(0, len(flat), MOST_ROWS):
        part = slice(start, start + MOST_ROWS)
        u, v = flat[part, :, 0], flat[part, :, 1]
        mixed = cv2.remap(source, u, v, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        found[part] = np.asarray(mixed).reshape(found[part].shape)
    return found.astype(float).reshape(*places.shape[:-1], maps.shape[2])
