# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture, its camera, objects and ball outlines in, the picture with all of these drawn out."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from ..arrays import Array
from ..camera import Camera
from ..errors import PictureError
from ..length_unit import MILLIMETRES, LengthUnit
from ..primitives import Box, Primitive, Prism
from .overlay_label import Color, Label, Picture, place_label
from .wireframe import Polyline, finite_parts, wireframe

# blue, green, red: colour-blind eyes tell them apart (Okabe and Ito 2008), and photos carry them
PALETTE: tuple[Color, ...] = (
    (233, 180, 86),
    (0, 159, 230),
    (66, 228, 240),
    (115, 200, 40),
    (167, 121, 224),
    (80, 110, 255),
)
HALO: Color = (20, 16, 14)
# OpenCV takes sub-pixel places as integers with so many binary digits behind the point
SHIFT = 6
# pixels of a picture's diagonal to one pixel of line width, and to one of a capital letter
DIAGONAL_PER_LINE = 800.0
DIAGONAL_PER_CAPITAL = 145.0
HALO_OPACITY, HIDDEN_OPACITY = 0.55, 0.7
SMALLEST_CAPITAL = 7.0
# an error below this, in metres, is told with one digit more
SMALL_SIGMA = 1e-4


@dataclass(frozen=True, eq=False)
class BallOutline:
    """A ball's outline: pixels (N, 2) round it, NaN where not imaged, and its colour (BGR)."""

    pixels: Array
    color: Color = PALETTE[1]


def draw_overlay(
    picture_bgr: Picture,
    camera: Camera,
    objects: Sequence[Primitive] = (),
    balls: Iterable[BallOutline] = (),
) -> Picture:
    """A copy of the picture with wire-frames, names with sizes ± 1 sigma in mm, and balls.

    Lines are antialiased and placed to 1/64 px; their width follows the picture's size. Hidden
    edges are thinner and fainter.

    Raises PictureError for a picture that is not 8-bit colour of the camera's size.
    """
    _refuse_other_pictures(picture_bgr, camera)
    picture = picture_bgr.copy()
    diagonal = float(np.linalg.norm(picture.shape[:2]))
    width = max(1, round(diagonal / DIAGONAL_PER_LINE))
    frames = [wireframe(thing, camera) for thing in objects]
    colors = [PALETTE[i % len(PALETTE)] for i in range(len(frames))]
    rings = [(Polyline(p, True), ball.color) for ball in balls for p in _ring(ball.pixels)]
    lines = [(line, color) for f, color in zip(frames, colors, strict=True) for line in f]
    blend_lines(picture, [c for c in lines if not c[0].visible], max(1, width // 2), HIDDEN_OPACITY)
    seen = [c for c in lines if c[0].visible] + rings
    blend_lines(
        picture, [(line, HALO) for line, _ in seen], width + 2 * max(1, width // 2), HALO_OPACITY
    )
    blend_lines(picture, seen, width, 1.0)
    named = list(zip(objects, frames, colors, strict=True))
    capital = max(SMALLEST_CAPITAL, diagonal / DIAGONAL_PER_CAPITAL)
    _draw_labels(picture, named, [ring for ring, _ in rings], capital)
    return picture


def caption(thing: Primitive, unit: LengthUnit = MILLIMETRES) -> str:
    """The sizes in a unit, with ± 1 sigma where a size was solved and its error is known."""
    sigmas = thing.size_sigma()
    texts = [
        _told(size, None if sigmas is None else sigmas[i], unit)
        for i, size in enumerate(thing.sizes)
    ]
    if isinstance(thing, Box):
        return f"{' × '.join(texts)} {unit.sign}"
    named = [
        f"{name.replace('_', ' ')} {text}"
        for name, text, size in zip(thing.size_names, texts, thing.sizes, strict=True)
        # the end of a cone that is a point has no size to tell
        if size > 0
    ]
    if isinstance(thing, Prism):
        named = [f"{len(thing.polygon)} corners", *named]
    return ", ".join(named) + f" {unit.sign}"


def blend_lines(
    picture: Picture, lines: Sequence[tuple[Polyline, Color]], thickness: int, opacity: float
) -> None:
    """Draw the lines into the picture, in place."""
    drawn = picture if opacity == 1.0 else picture.copy()
    for line, color in lines:
        places = np.round(line.pixels * (1 << SHIFT)).astype(np.int32)
        cv2.polylines(drawn, [places], False, color, thickness, cv2.LINE_AA, SHIFT)
    if opacity < 1.0:
        cv2.addWeighted(drawn, opacity, picture, 1.0 - opacity, 0.0, dst=picture)


def plain_name(name: str) -> str:
    """The name in letters that OpenCV's font has."""
    return unicodedata.normalize("NFKD", name).encode("ascii", "ignore").decode() or "object"


def _told(size: float, sigma: float | None, unit: LengthUnit) -> str:
    # a size that was given has no error of its own to show
    if sigma is None or sigma == 0:
        return unit.number(size)
    finer = 1 if sigma < SMALL_SIGMA else 0
    return f"{unit.number(size, finer)} ± {unit.number(sigma, finer)}"


def _ring(pixels: Array) -> list[Array]:
    return finite_parts(np.concatenate([pixels, pixels[:1]]))


def _draw_labels(
    picture: Picture,
    named: Sequence[tuple[Primitive, Sequence[Polyline], Color]],
    rings: Sequence[Polyline],
    capital: float,
) -> None:
    """A label beside every object that is in the picture, off the others and off the balls."""
    height, width = picture.shape[:2]
    bounds = [_bounds(frame, width, height) for _, frame, _ in named]
    balls = [_bounds([ring], width, height) for ring in rings]
    taken = [box for box in (*bounds, *balls) if box is not None]
    for (thing, _, color), box in zip(named, bounds, strict=True):
        if box is None:
            continue
        label = Label((plain_name(thing.name), caption(thing)), color, capital)
        others = [other for other in taken if other is not box]
        place = place_label(label, box, others, (width, height))
        label.draw(picture, round(place[0]), round(place[1]))
        taken.append(place)


def _bounds(frame: Sequence[Polyline], width: int, height: int) -> Array | None:
    """The box (left, top, right, bottom) of what is in the picture; None for nothing."""
    pixels = np.concatenate([line.pixels for line in frame]) if frame else np.zeros((0, 2))
    inside = ((pixels >= 0) & (pixels < [width, height])).all(axis=1)
    if not inside.any():
        return None
    return np.concatenate([pixels[inside].min(axis=0), pixels[inside].max(axis=0)])


def _refuse_other_pictures(picture: Picture, camera: Camera) -> None:
    inner = camera.intrinsics
    shape = (inner.height, inner.width, 3)
    if picture.shape != shape or picture.dtype != np.uint8:
        raise PictureError(
            f"the picture is {picture.shape} of {picture.dtype}; this camera needs an 8-bit colour "
            f"picture of shape {shape}"
        )
