# SPDX-License-Identifier: GPL-3.0-or-later
"""How far round things have the ball's colour: an 8-bit picture and circles in, shares out.

Colours are compared as chromaticities of linear light: shade and brightness do not count, and hue
counts more than saturation, which highlights and dust take away.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..picture.pictures import linear_light
from .circle_votes import Circle

# less chromatic than this is grey: white, black, aluminium
GREY = 0.06
# a chromaticity this far from grey or white is as good as another colour
GREY_TOLERANCE = 0.08
# light below this share of white has no colour that noise leaves
DARK = 0.006
BRIGHT = 0.25
# an even grid in a disc of radius 1
SQUARE = np.array(np.meshgrid(np.arange(-5, 6) / 5, np.arange(-5, 6) / 5)).reshape(2, -1)
DISC_X, DISC_Y = SQUARE[:, np.square(SQUARE).sum(axis=0) <= 1]


def color_shares(
    picture: NDArray[np.uint8], circles: Sequence[Circle], color: tuple[float, float, float]
) -> Array:
    """For each circle, how far its inside has the colour (red, green, blue in sRGB), 0 to 1."""
    target = linear_light(np.array([[color[::-1]]]).round().astype(np.uint8))[0, 0].astype(float)
    return np.array([_share(_inside(picture, circle), target) for circle in circles])


def inside_of(shape: tuple[int, ...], circle: Circle) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Rows and columns of about a hundred pixels within 0.85 of a circle's radius."""
    column = np.rint(circle.u + 0.85 * circle.radius * DISC_X).astype(int)
    row = np.rint(circle.v + 0.85 * circle.radius * DISC_Y).astype(int)
    seen = (row >= 0) & (row < shape[0]) & (column >= 0) & (column < shape[1])
    return row[seen], column[seen]


def _inside(picture: NDArray[np.uint8], circle: Circle) -> Array:
    row, column = inside_of(picture.shape, circle)
    return linear_light(np.ascontiguousarray(picture[row, column][None]))[0].astype(float)


def _share(light: Array, target: Array) -> float:
    if len(light) == 0:
        return 0.0
    wanted = _chroma(target[None])[0]
    chroma = _chroma(light)
    length = np.linalg.norm(chroma, axis=1)
    brightness = light.mean(axis=1)
    if np.linalg.norm(wanted) < GREY:
        likeness = np.exp(-((length / GREY_TOLERANCE) ** 2))
        if target.mean() > BRIGHT:
            likeness = likeness * np.clip(brightness / BRIGHT, 0, 1)
        if target.mean() < DARK * 4:
            likeness = np.clip(1.5 - brightness / 0.08, 0, 1)
        return float(likeness.mean())
    hue = (chroma @ wanted) / np.maximum(length * np.linalg.norm(wanted), 1e-9)
    # a third of the saturation is left under any light; less is grey
    likeness = np.clip((hue - 0.5) / 0.4, 0, 1) * np.clip(
        3 * length / np.linalg.norm(wanted) - 0.3, 0, 1
    )
    # what is too dark to have a colour speaks neither for nor against
    return float(np.where(brightness < DARK, 0.5, likeness).mean())


def _chroma(light: Array) -> Array:
    """Chromaticities (N, 3) less that of grey."""
    chroma: Array = light / np.maximum(light.sum(axis=1, keepdims=True), 1e-6) - 1 / 3
    return chroma
