# SPDX-License-Identifier: GPL-3.0-or-later
"""A photograph and the sigma of the points it shows of a surface in, the map drawn over it out."""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np

from ..arrays import Array, Mask
from ..calibration.sigma_map import SigmaField, sigma_from
from ..camera import Camera
from .iso_lines import iso_segments
from .overlay import (
    DIAGONAL_PER_CAPITAL,
    HALO,
    PALETTE,
    SMALLEST_CAPITAL,
    BallOutline,
    blend_lines,
    draw_overlay,
    plain_name,
)
from .overlay_label import INK, PAPER, Color, Label, Picture, text_width, write_text
from .wireframe import Polyline

# even steps of the scale look like even steps, and colour-blind eyes see them (van der Walt 2015)
COLORS = cv2.COLORMAP_VIRIDIS
DARKENED, OPACITY = 0.6, 0.5
# the scale ends where sigma is this many times the least: towards the horizon it runs away, and the
# colour fades until sigma is FADED times the most of the scale
SCALE_RATIO, LEAST_RATIO, FADED = 30.0, 1.5, 2.5
STEPS = (1.0, 2.0, 5.0)
FRAME: Color = PALETTE[1]
FOOT_CAPITALS = 8.5
PERCENT = 255.0


def draw_sigma_map(
    picture_bgr: Picture,
    camera: Camera,
    field: SigmaField,
    caption: str,
    balls: Sequence[BallOutline] = (),
    frame: Array | None = None,
) -> Picture:
    """A copy of the picture (H, W, 3), darkened and coloured by sigma, on a footer with the scale.

    Lines of equal sigma at 1, 2, 5, ... mm are labelled; what is above the horizon, grazed or far
    beyond the scale keeps its own grey. `caption` is a line of text for the footer, by which the
    result is higher than the picture. `frame` (N, 2) in pixels is drawn round what is worked at.

    Raises PictureError for a picture that is not 8-bit colour of the camera's size.
    """
    grey = draw_overlay(picture_bgr, camera)
    size = (grey.shape[1], grey.shape[0])
    capital = max(SMALLEST_CAPITAL, float(np.hypot(*size)) / DIAGONAL_PER_CAPITAL)
    scale = _scale(field)
    picture = _coloured(grey, field, scale)
    levels = _levels(scale)
    lines = [
        iso_segments(np.log(field.sigma), np.log(level), field.columns, field.rows)
        for level in levels
    ]
    _draw_lines(picture, lines, capital)
    framed = [] if frame is None else [BallOutline(frame, FRAME)]
    picture = draw_overlay(picture, camera, (), [*framed, *balls])
    _label_lines(picture, lines, levels, scale, capital, balls)
    return np.vstack([picture, _footer(size[0], scale, levels, caption, capital)])


def _scale(field: SigmaField) -> tuple[float, float]:
    """Least and most sigma of the scale, metres."""
    seen = field.sigma[np.isfinite(field.sigma)]
    if not len(seen):
        return 1e-3, 1e-2
    least, most = float(seen.min()), float(seen.max())
    return least, max(LEAST_RATIO * least, min(most, SCALE_RATIO * least))


def _levels(scale: tuple[float, float]) -> list[float]:
    """1, 2, 5, 10, ... mm between the ends of the scale, metres."""
    powers = 10.0 ** np.arange(-7, 5)
    return [p * s for p in powers for s in STEPS if scale[0] * 1.02 < p * s < scale[1] * 0.98]


def _coloured(picture: Picture, field: SigmaField, scale: tuple[float, float]) -> Picture:
    height, width = picture.shape[:2]
    sigma = sigma_from(
        _enlarged(field.scaled, width, height), _enlarged(field.sines, width, height)
    )
    seen: Mask = np.isfinite(sigma)
    beyond = np.log(np.where(seen, sigma, np.inf) / scale[1]) / np.log(FADED)
    opacity = OPACITY * (1 - np.clip(beyond, 0, 1))[..., None]
    grey = cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY).astype(float)[..., None] * DARKENED
    drawn = grey + opacity * (_colors(np.where(seen, sigma, scale[1]), scale) - grey)
    return np.round(drawn).astype(np.uint8)


def _enlarged(nodes: Array, width: int, height: int) -> Array:
    """Values at the nodes, which include the picture's rim, at every pixel's centre."""
    rows, columns = nodes.shape
    u = (np.arange(width, dtype=np.float32) + 0.5) * ((columns - 1) / width)
    v = (np.arange(height, dtype=np.float32) + 0.5) * ((rows - 1) / height)
    grid_u, grid_v = np.meshgrid(u, v)
    values = cv2.remap(nodes, grid_u, grid_v, cv2.INTER_LINEAR, None, cv2.BORDER_REPLICATE)
    return np.asarray(values, dtype=float)


def _colors(sigma: Array, scale: tuple[float, float]) -> Picture:
    """Colours (..., 3) of sigmas, even in their logarithm."""
    share = np.log(sigma / scale[0]) / np.log(scale[1] / scale[0])
    level = np.round(PERCENT * np.clip(share, 0, 1)).astype(np.uint8)
    return np.asarray(cv2.applyColorMap(level.reshape(-1, 1), COLORS)).reshape(*level.shape, 3)


def _draw_lines(picture: Picture, lines: Sequence[Array], capital: float) -> None:
    thin = max(1, round(capital / 9))
    halo = [(Polyline(segment, True), HALO) for line in lines for segment in line]
    ink = [(Polyline(segment, True), INK) for line in lines for segment in line]
    blend_lines(picture, halo, thin + 2 * max(1, thin // 2), 0.35)
    blend_lines(picture, ink, thin, 0.85)


def _label_lines(
    picture: Picture,
    lines: Sequence[Array],
    levels: Sequence[float],
    scale: tuple[float, float],
    capital: float,
    balls: Sequence[BallOutline],
) -> None:
    """A label on each line, off the balls and off each other."""
    size = np.array([picture.shape[1], picture.shape[0]])
    taken = [_box(ball.pixels) for ball in balls if np.isfinite(ball.pixels).any()]
    for line, level in zip(lines, levels, strict=True):
        if not len(line):
            continue
        blue, green, red = (int(c) for c in _colors(np.array([level]), scale)[0])
        label = Label((f"{1e3 * level:g} mm",), (blue, green, red), 0.9 * capital)
        box = _place_on(line.mean(axis=1), np.array(label.size), taken, size, capital)
        if box is not None:
            label.draw(picture, round(box[0]), round(box[1]))
            taken.append(box)


def _place_on(
    places: Array, label: Array, taken: Sequence[Array], size: Array, gap: float
) -> Array | None:
    """The box of a label on one of `places` (N, 2), as near the middle as leaves all else free."""
    corners = places - label / 2
    boxes = np.concatenate([corners, corners + label], axis=1)
    free = (corners > gap).all(axis=1) & (corners + label < size - gap).all(axis=1)
    for other in taken:
        apart = (boxes[:, :2] > other[2:] + gap) | (boxes[:, 2:] < other[:2] - gap)
        free &= apart.any(axis=1)
    if not free.any():
        return None
    off = np.linalg.norm(places[free] - size / 2, axis=1)
    chosen: Array = boxes[free][int(np.argmin(off))]
    return chosen


def _box(pixels: Array) -> Array:
    return np.concatenate([np.nanmin(pixels, axis=0), np.nanmax(pixels, axis=0)])


def _footer(
    width: int, scale: tuple[float, float], levels: Sequence[float], caption: str, capital: float
) -> Picture:
    """The caption, and below it the scale of colours over the picture's whole width."""
    foot = np.full((round(FOOT_CAPITALS * capital), width, 3), PAPER, np.uint8)
    left, right = round(1.5 * capital), width - round(1.5 * capital)
    write_text(foot, _fitting(caption, right - left, capital), (left, 1.2 * capital), capital)
    top, bottom = round(3.2 * capital), round(4.9 * capital)
    logs = np.linspace(np.log(scale[0]), np.log(scale[1]), right - left)
    foot[top:bottom, left:right] = _colors(np.exp(logs), scale)
    for level in levels:
        share = np.log(level / scale[0]) / np.log(scale[1] / scale[0])
        at, text = left + share * (right - left), f"{1e3 * level:g} mm"
        foot[bottom : bottom + round(0.7 * capital), round(at)] = INK
        half = text_width(text, capital) / 2
        if left < at - half and at + half < right:
            write_text(foot, text, (at - half, bottom + 1.2 * capital), capital)
    return foot


def _fitting(text: str, width: float, capital: float) -> str:
    """The text, cut short where it is wider than `width` pixels."""
    fitting = plain_name(text)
    while len(fitting) > 4 and text_width(fitting, capital) > width:
        fitting = fitting[:-4] + "..."
    return fitting
