# SPDX-License-Identifier: GPL-3.0-or-later
"""A fitted view in, its picture with corners and enlarged residuals drawn on it out."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..picture.overlay import HALO, PALETTE, SHIFT
from ..picture.overlay_label import Color, Label, Picture
from .bundle import LensFit

CORNER, RESIDUAL = PALETTE[0], PALETTE[1]
PAPER = 244
DOT: Color = (150, 110, 60)
HULL: Color = (226, 214, 200)
# pixels of a picture's diagonal to one of line width, and to one of a capital letter
DIAGONAL_PER_LINE, DIAGONAL_PER_CAPITAL = 1000.0, 110.0
# the median residual is drawn as long as this part of the diagonal
MEDIAN_ARROW = 0.012


def draw_view(picture: NDArray[Any], fit: LensFit, i: int, gain: float) -> Picture:
    """A copy of the picture (H, W, 3) of view `i` with its corners and residuals times `gain`."""
    drawn = np.asarray(picture if picture.dtype == np.uint8 else picture // 257, np.uint8).copy()
    view = fit.views[i]
    _draw(drawn, view.pixels, fit.residuals[i], gain)
    rms = float(fit.rms_of_views[i])
    text = f"{len(view.pixels)} corners, {rms:.3f} px rms, arrows {gain:.0f} times as long"
    _caption(drawn, text)
    return drawn


def draw_coverage(fit: LensFit, gain: float) -> Picture:
    """All corners of all pictures in one frame (H, W, 3), with residuals times `gain`."""
    drawn = np.full((fit.lens.height, fit.lens.width, 3), PAPER, np.uint8)
    for view in fit.views:
        shade = drawn.copy()
        cv2.fillConvexPoly(shade, _fixed(view.hull), HULL, cv2.LINE_AA, SHIFT)
        cv2.addWeighted(shade, 0.45, drawn, 0.55, 0, dst=drawn)
    for view, residuals in zip(fit.views, fit.residuals, strict=True):
        _draw(drawn, view.pixels, residuals, gain, halo=False)
    count = sum(len(view.pixels) for view in fit.views)
    text = f"{count} corners of {len(fit.views)} pictures, {fit.rms_pixels:.3f} px rms"
    _caption(drawn, f"{text}, arrows {gain:.0f} times as long")
    return drawn


def residual_gain(fit: LensFit) -> float:
    """A round factor that makes residuals visible, the same for all pictures."""
    lengths = np.linalg.norm(np.concatenate(fit.residuals), axis=1)
    wanted = MEDIAN_ARROW * float(np.hypot(fit.lens.width, fit.lens.height))
    raw = wanted / max(float(np.median(lengths)), 1e-6)
    steps = np.array([1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000])
    return float(steps[np.argmin(np.abs(np.log(steps / raw)))])


def _draw(drawn: Picture, pixels: Array, residuals: Array, gain: float, halo: bool = True) -> None:
    diagonal = _diagonal(drawn)
    width = max(1, round(diagonal / DIAGONAL_PER_LINE))
    lines: Sequence[tuple[Color, int]] = [(HALO, width + 2), (RESIDUAL, width)]
    for color, thickness in lines if halo else lines[1:]:
        for start, end in zip(pixels, pixels + gain * residuals, strict=True):
            ends = (_place(start), _place(end))
            cv2.line(drawn, *ends, color, thickness, cv2.LINE_AA, SHIFT)
    radius = round((2.2 if halo else 0.8) * width * (1 << SHIFT))
    for pixel in pixels:
        place = _place(pixel)
        cv2.circle(drawn, place, radius, HALO if halo else DOT, -1, cv2.LINE_AA, SHIFT)
        if halo:
            cv2.circle(drawn, place, radius * 2 // 3, CORNER, -1, cv2.LINE_AA, SHIFT)


def _caption(drawn: Picture, text: str) -> None:
    capital = max(7.0, _diagonal(drawn) / DIAGONAL_PER_CAPITAL)
    label = Label((text,), RESIDUAL, capital)
    label.draw(drawn, round(capital), drawn.shape[0] - label.size[1] - round(capital))


def _diagonal(drawn: Picture) -> float:
    return float(np.hypot(drawn.shape[0], drawn.shape[1]))


def _place(pixel: Array) -> tuple[int, int]:
    x, y = np.round(pixel * (1 << SHIFT)).astype(int)
    return int(x), int(y)


def _fixed(pixels: NDArray[np.float32]) -> NDArray[np.int32]:
    return np.asarray(np.round(pixels * (1 << SHIFT)), np.int32)
