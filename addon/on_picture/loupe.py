# SPDX-License-Identifier: GPL-3.0-or-later
"""The loupe: the view's picture, a place in it and a zoom in, the enlarged pixels drawn."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...core.arrays import Array
from ..overlay.drawing import HALO, WHITE, LineBatch, draw_lines
from .beside_cursor import Box, loupe_box

# how many pixels of the picture it shows across
ACROSS = 23


class Loupe:
    """Where the loupe stands in the region, and what it maps to it."""

    def __init__(self, cursor: tuple[float, float], free: Box, zoom: int, scale: float) -> None:
        self.zoom = zoom * scale
        self.side = ACROSS * self.zoom
        self.box = loupe_box(self.side, cursor, free, scale)
        self.left, self.bottom = self.box[:2]

    @property
    def middle(self) -> Array:
        return np.array([self.left + self.side / 2, self.bottom + self.side / 2])

    def points(self, view_pixels: Array, centre: Array) -> Array:
        """View pixels (N, 2) to region points, `centre` (2,) being in the middle."""
        return self.middle + (np.asarray(view_pixels) - centre) * [self.zoom, -self.zoom]

    def draw(self, picture: Any, centre: Array, lines: list[tuple[Array, Any]], scale: float):
        """Draw the picture round `centre` (2,), view pixels, with lines of the view over it."""
        import gpu

        region = gpu.state.scissor_get()
        _quads(*enlarged(picture, centre, self.middle, self.zoom))
        x, y = int(region[0] + self.left), int(region[1] + self.bottom)
        gpu.state.scissor_test_set(True)
        gpu.state.scissor_set(x, y, int(self.side), int(self.side))
        for pixels, color in lines:
            draw_lines([self.points(pixels, centre)], color, 1.2, scale)
        gpu.state.scissor_set(*region)
        self._frame(scale)

    def _frame(self, scale: float) -> None:
        x, y = self.left, self.bottom
        right, top = x + self.side, y + self.side
        corners = np.array([[x, y], [right, y], [right, top], [x, top], [x, y]])
        LineBatch([corners], HALO, 4.0).draw(scale)
        LineBatch([corners], WHITE, 1.2).draw(scale)
        u, v = self.middle
        gap, arm = 0.5 * self.zoom, 2.5 * self.zoom
        ways = [np.array(way) for way in ((1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0))]
        cross = [np.array([[u, v] + gap * way, [u, v] + arm * way]) for way in ways]
        draw_lines(cross, WHITE, 1.0, scale)


def enlarged(picture: Any, centre: Array, middle: Array, zoom: float) -> tuple[Array, Array]:
    """Corners (N, 4, 2) of each enlarged pixel in the region, and their colours (N, 3).

    They end at a square of ACROSS pixels round `centre`; beside the picture there are none. The
    picture is an array (H, W, 3) or `ViewPixels`.
    """
    half = ACROSS / 2
    first, last = np.floor(centre - half + 0.5), np.ceil(centre + half - 0.5)
    height, width = picture.shape[:2]
    columns = np.arange(max(first[0], 0), min(last[0], width - 1) + 1).astype(int)
    rows = np.arange(max(first[1], 0), min(last[1], height - 1) + 1).astype(int)
    u, v = (m.ravel() for m in np.meshgrid(columns, rows))
    low = np.maximum(np.stack([u, v], 1) - 0.5 - centre, -half)
    high = np.minimum(np.stack([u, v], 1) + 0.5 - centre, half)
    x = middle[0] + zoom * np.stack([low[:, 0], high[:, 0], high[:, 0], low[:, 0]], axis=1)
    y = middle[1] - zoom * np.stack([low[:, 1], low[:, 1], high[:, 1], high[:, 1]], axis=1)
    corners = np.stack([x, y], axis=2)
    if not len(corners):
        return corners, np.zeros((0, 3))
    part = picture[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
    return corners, part.reshape(-1, 3)


def _quads(corners: Array, colors: Array) -> None:
    import gpu
    from gpu_extras.batch import batch_for_shader

    count = len(corners)
    if not count:
        return
    position = np.concatenate([corners, np.zeros((count, 4, 1))], axis=2).reshape(-1, 3)
    color = np.repeat(np.column_stack([colors, np.ones(count)]), 4, axis=0)
    triangles = (4 * np.arange(count)[:, None] + [0, 1, 2, 0, 2, 3]).reshape(-1, 3)
    shader: Any = gpu.shader.from_builtin("FLAT_COLOR")
    batch = batch_for_shader(
        shader,
        "TRIS",
        {"pos": position.astype(np.float32), "color": color.astype(np.float32)},
        indices=triangles.astype(np.int32),
    )
    shader.bind()
    batch.draw(shader)
