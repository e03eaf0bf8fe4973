# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture in, where its light changes sharply out, as thin edges with their directions.

Soft changes, such as most shadows' edges, are left out: a sharp edge loses most of its slope by a
coarse blur, a soft one hardly any.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from ..arrays import Array
from ..picture.pictures import Picture
from .window import Window

FINE_BLUR, COARSE_BLUR = 0.9, 2.7
# slope lost by the coarse blur, as a factor: that of soft edges, and of sharp ones
SOFT, SHARP = 1.25, 1.9
# slopes, in units of the picture's usual one, that are an edge, and an edge beyond doubt
FAINT, CLEAR = 4.0, 12.0
# the grain of eight-bit colours
LEAST_SLOPE = 0.35


@dataclass(frozen=True, eq=False)
class EdgeMap:
    """Of each pixel (H, W, 3): weight times (nx nx, nx ny, ny ny) of the edge's unit normal.

    The weight is 1 on a clear and sharp edge, 0 beside it. `usual` is the slope that noise shows,
    in grey levels per pixel.
    """

    structure: Picture
    usual: float

    def around(self, window: Window, free: Picture, blur: float) -> Array:
        """The part in a window at full resolution, widened: 1 on a straight edge's ridge.

        `free` (rows, columns) of the part is 0 where edges belong to something in front.
        """
        part = self.structure[window.y : window.bottom, window.x : window.right]
        spread = cv2.GaussianBlur(part * free[:, :, None], (0, 0), blur)
        ridges: Array = np.minimum(spread * (blur * np.sqrt(2 * np.pi)), 1.0)
        return ridges


def edge_map(picture: Picture) -> EdgeMap:
    """The edges of an 8-bit picture (H, W, 3), in the channel that changes most."""
    fine, coarse = (_slopes(picture, blur) for blur in (FINE_BLUR, COARSE_BLUR))
    size = np.hypot(fine[..., 0], fine[..., 1])
    usual = max(float(np.median(size[::4, ::4])), LEAST_SLOPE)
    scaled = np.round(np.clip(fine * 64, -32000, 32000)).astype(np.int16)
    thin = cv2.Canny(
        np.ascontiguousarray(scaled[..., 0]),
        np.ascontiguousarray(scaled[..., 1]),
        64 * FAINT * usual,
        64 * 1.5 * FAINT * usual,
        L2gradient=True,
    )
    rows, columns = np.nonzero(thin)
    n = fine[rows, columns] / size[rows, columns][:, None]
    lost = size[rows, columns] / (np.abs((coarse[rows, columns] * n).sum(axis=1)) + usual)
    sharp = np.clip((lost - SOFT) / (SHARP - SOFT), 0, 1)
    clear = np.clip(size[rows, columns] / (CLEAR * usual), 0, 1)
    structure = np.zeros((*thin.shape, 3), dtype=np.float32)
    structure[rows, columns] = (sharp * clear)[:, None] * np.stack(
        [n[:, 0] ** 2, n[:, 0] * n[:, 1], n[:, 1] ** 2], axis=1
    )
    return EdgeMap(structure, usual)


def _slopes(picture: Picture, blur: float) -> Array:
    """Derivatives (H, W, 2) of the channel that changes most."""
    smooth = cv2.GaussianBlur(picture.astype(np.float32), (0, 0), blur)
    du = cv2.Sobel(smooth, cv2.CV_32F, 1, 0, scale=0.125)
    dv = cv2.Sobel(smooth, cv2.CV_32F, 0, 1, scale=0.125)
    power = du * du + dv * dv
    loudest = power.argmax(axis=2)[:, :, None]
    return np.concatenate(
        [np.take_along_axis(du, loudest, 2), np.take_along_axis(dv, loudest, 2)], axis=2
    )
