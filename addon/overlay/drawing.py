# SPDX-License-Identifier: GPL-3.0-or-later
"""Lines and words over a region, in region pixels: the only file that talks to the graphics card.

Blender draws in float32 with the origin at the region's lower left corner.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.arrays import Array
from ..on_picture.beside_cursor import Box, words_box

Floats = NDArray[np.float32]
Color = tuple[float, float, float, float]
HALO: Color = (0.05, 0.05, 0.06, 0.6)
# Okabe and Ito's colours, which colour-blind eyes tell apart
SKY: Color = (0.34, 0.71, 0.91, 1.0)
YELLOW: Color = (0.94, 0.89, 0.26, 1.0)
GREEN: Color = (0.16, 0.78, 0.45, 1.0)
ORANGE: Color = (0.98, 0.66, 0.1, 1.0)
RED: Color = (0.94, 0.33, 0.2, 1.0)
VIOLET: Color = (0.86, 0.62, 0.92, 1.0)
GREY: Color = (0.62, 0.62, 0.62, 1.0)
WHITE: Color = (1.0, 1.0, 1.0, 1.0)
TEXT_SIZE = 13.0
LABEL_SIZE = 11.0
# what a line that is called straight may bend, in pixels
STRAIGHT_PIXELS = 0.02


class LineBatch:
    """Polylines (N, 2) of one colour and width, kept on the graphics card between redraws."""

    def __init__(self, lines: Iterable[Array], color: Color, width: float) -> None:
        self._keep(ends_of(lines), color, width)

    @classmethod
    def of_ends(cls, ends: Floats, color: Color, width: float) -> LineBatch:
        """From what `ends_of` gave, joined."""
        batch = cls.__new__(cls)
        batch._keep(ends, color, width)
        return batch

    def _keep(self, ends: Floats, color: Color, width: float) -> None:
        import gpu
        from gpu_extras.batch import batch_for_shader

        self._shader = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR")
        self._color, self._width = color, width
        self._batch = batch_for_shader(self._shader, "LINES", {"pos": ends}) if len(ends) else None

    def draw(self, scale: float) -> None:
        """Draw under the current matrices; `scale` is Blender's interface scale."""
        import gpu

        if self._batch is None:
            return
        gpu.state.blend_set("ALPHA")
        self._shader.bind()
        self._shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
        self._shader.uniform_float("lineWidth", self._width * scale)
        self._shader.uniform_float("color", self._color)
        self._batch.draw(self._shader)
        gpu.state.blend_set("NONE")


def ends_of(lines: Iterable[Array]) -> Floats:
    """Both ends (2 M, 3) of every straight part of polylines (N, 2), as a graphics card wants.

    Of a line that is straight all along only the ends are kept.
    """
    kept = [line for line in lines if len(line) > 1]
    if not kept:
        return np.zeros((0, 3), np.float32)
    lengths = np.array([len(line) for line in kept])
    joined = np.concatenate(kept)
    lasts = np.cumsum(lengths) - 1
    firsts = lasts - lengths + 1
    begins = np.ones(len(joined), dtype=bool)
    begins[lasts] = False
    # every point begins a part but the last of its line, and those inside a straight one
    straight = _straight(joined, firsts, lasts)
    begins &= ~np.repeat(straight, lengths)
    begins[firsts] = True
    first = np.flatnonzero(begins)
    after = first + 1
    after[np.searchsorted(first, firsts[straight])] = lasts[straight]
    ends = np.zeros((2 * len(first), 3), np.float32)
    ends[0::2, :2], ends[1::2, :2] = joined[first], joined[after]
    return ends


def _straight(points: Array, firsts: NDArray[Any], lasts: NDArray[Any]) -> NDArray[np.bool_]:
    """Which of the joined lines leave the chord between their ends by no visible amount.

    A point at a distance h off the chord c makes the way at least sqrt(c^2 + 4 h^2) long.
    """
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    # the step from a line's last point to the next line's first is none of either
    steps[lasts[:-1]] = 0.0
    way = np.add.reduceat(steps, firsts)
    chord = np.linalg.norm(points[lasts] - points[firsts], axis=1)
    straight: NDArray[np.bool_] = way**2 - chord**2 <= 4 * STRAIGHT_PIXELS**2
    return straight


def draw_lines(lines: Sequence[Array], color: Color, width: float, scale: float) -> None:
    """Draw polylines (N, 2) once, with a dark halo that keeps them readable on any picture."""
    LineBatch(lines, HALO, width + 2.0).draw(scale)
    LineBatch(lines, color, width).draw(scale)


def draw_crosses(points: Iterable[Array], color: Color, scale: float) -> None:
    """Draw a small upright cross at each of the points (N, 2), its middle left open."""
    inner, outer = 2.5 * scale, 8.0 * scale
    arms = [np.array(way) for way in ((1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0))]
    lines = [
        np.array([p + inner * arm, p + outer * arm]) for p in map(np.array, points) for arm in arms
    ]
    draw_lines(lines, color, 1.5, scale)


def draw_ring(point: Array, color: Color, scale: float) -> None:
    """Draw a small circle round a region point (2,): something was found there."""
    angles = np.linspace(0, 2 * np.pi, 33)
    ring = point + 11.0 * scale * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    draw_lines([ring], color, 1.5, scale)


def draw_words(
    rows: Sequence[tuple[str, Color]],
    cursor: tuple[float, float],
    free: Box,
    scale: float,
    loupe: Box | None = None,
) -> None:
    """Write rows of text on a dark plate near the cursor, in the `free` part and off the loupe."""
    import blf

    rows = [row for row in rows if row[0]]
    if not rows:
        return
    blf.size(0, TEXT_SIZE * scale)
    line, pad = 1.45 * TEXT_SIZE * scale, 6.0 * scale
    width = max(blf.dimensions(0, text)[0] for text, _ in rows) + 2 * pad
    height = line * len(rows) + pad
    left, bottom, right, top = words_box((width, height), cursor, free, scale, loupe)
    _plates([(left, bottom, right, top)])
    for i, (text, color) in enumerate(rows):
        blf.position(0, left + pad, top - line * (i + 1) + 0.22 * line, 0)
        blf.color(0, *color)
        blf.draw(0, text)


def draw_labels(labels: Iterable[tuple[Array, str, Color]], scale: float) -> None:
    """Write short texts beside region points (2,), each on a small dark plate."""
    import blf

    blf.size(0, LABEL_SIZE * scale)
    pad, line = 3.0 * scale, 1.3 * LABEL_SIZE * scale
    placed = [(float(x) + 4 * scale, float(y), text, color) for (x, y), text, color in labels]
    _plates(
        [(x, y, x + blf.dimensions(0, text)[0] + 2 * pad, y + line) for x, y, text, _ in placed]
    )
    for x, y, text, color in placed:
        blf.position(0, x + pad, y + 0.28 * line, 0)
        blf.color(0, *color)
        blf.draw(0, text)


def _plates(sides: Sequence[tuple[float, float, float, float]]) -> None:
    """Dark rectangles: left, bottom, right and top of each."""
    import gpu
    from gpu_extras.batch import batch_for_shader

    if not sides:
        return
    shader: Any = gpu.shader.from_builtin("UNIFORM_COLOR")
    corners = [
        (x, y, 0.0)
        for left, bottom, right, top in sides
        for x, y in (
            (left, bottom),
            (right, bottom),
            (left, top),
            (right, bottom),
            (left, top),
            (right, top),
        )
    ]
    batch = batch_for_shader(shader, "TRIS", {"pos": corners})
    gpu.state.blend_set("ALPHA")
    shader.bind()
    shader.uniform_float("color", (0.06, 0.06, 0.07, 0.82))
    batch.draw(shader)
    gpu.state.blend_set("NONE")
