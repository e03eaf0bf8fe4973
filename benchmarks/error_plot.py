# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors one by one as dots in strips, one above the other: numbers in, a picture out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np

WIDTH, STRIP, TOP, BOTTOM, LEFT, RIGHT, GAP = 1160, 190, 24, 62, 96, 290, 26
# all is drawn four times as large and shrunk, which smooths it
SHRINK = 4
PAPER, INK, FAINT, GRID = (255, 255, 255), (45, 40, 38), (120, 112, 108), (226, 222, 220)
BAND, DOT, MEAN = (246, 235, 222), (166, 92, 28), (48, 64, 200)
TICKS = 3


@dataclass(frozen=True, eq=False)
class Strip:
    """A name, one error (N,) a ball, and lines of text that stand beside them."""

    name: str
    errors: np.ndarray
    notes: tuple[str, ...] = ()


def draw_strips(strips: Sequence[Strip], along: str, unit: str) -> np.ndarray:
    """A picture (H, W, 3): each strip's dots, mean and band of one standard deviation."""
    height = TOP + len(strips) * (STRIP + GAP) + BOTTOM - GAP
    canvas = np.full((height * SHRINK, WIDTH * SHRINK, 3), 255, np.uint8)
    for i, strip in enumerate(strips):
        _draw(canvas, strip, TOP + i * (STRIP + GAP), unit)
    below = TOP + len(strips) * (STRIP + GAP) - GAP
    for number in range(0, len(strips[0].errors) + 1, 10):
        _text(canvas, str(number), _x(number - 0.5, strips[0]), below + 20, FAINT, 0.5)
    middle = (LEFT + WIDTH - RIGHT) / 2
    _text(canvas, along, middle, below + 44, INK, 0.5)
    return cv2.resize(canvas, None, fx=1 / SHRINK, fy=1 / SHRINK, interpolation=cv2.INTER_AREA)


def _draw(canvas: np.ndarray, strip: Strip, top: int, unit: str) -> None:
    mean, spread = float(strip.errors.mean()), float(strip.errors.std())
    step = _step(float(np.abs(strip.errors).max()))
    reach = step * (TICKS + 0.3)

    def y(value: float) -> float:
        return top + STRIP / 2 * (1 - value / reach)

    right = WIDTH - RIGHT
    _box(canvas, (LEFT, y(mean + spread)), (right, y(mean - spread)), BAND)
    for tick in range(-TICKS, TICKS + 1):
        _line(canvas, (LEFT, y(tick * step)), (right, y(tick * step)), FAINT if tick == 0 else GRID)
        _text(
            canvas,
            f"{tick * step:+.4g}" if tick else "0",
            LEFT - 8,
            y(tick * step) + 5,
            FAINT,
            0.42,
            1,
        )
    _line(canvas, (LEFT, y(mean)), (right, y(mean)), MEAN)
    for i, error in enumerate(strip.errors):
        _dot(canvas, (_x(i, strip), y(float(error))))
    _text(canvas, strip.name, right + 16, top + 40, INK, 0.62, 0)
    _text(canvas, f"mean {mean:+.4f} %", right + 16, top + 76, MEAN, 0.5, 0)
    _text(canvas, f"s.d. {spread:.4f} %", right + 16, top + 102, DOT, 0.5, 0)
    for k, note in enumerate((unit, *strip.notes)):
        _text(canvas, note, right + 16, top + 128 + 20 * k, FAINT, 0.42, 0)


def _step(largest: float) -> float:
    """A round step of which TICKS reach the largest."""
    rough = largest / TICKS
    power = 10 ** np.floor(np.log10(rough))
    return float(next(m for m in (1, 2, 2.5, 5, 10) if m * power >= rough) * power)


def _x(i: float, strip: Strip) -> float:
    return LEFT + (WIDTH - RIGHT - LEFT) * (i + 0.5) / len(strip.errors)


def _at(point: tuple[float, float]) -> tuple[int, int]:
    return round(point[0] * SHRINK), round(point[1] * SHRINK)


def _line(canvas: np.ndarray, a, b, color) -> None:
    cv2.line(canvas, _at(a), _at(b), color, SHRINK)


def _box(canvas: np.ndarray, a, b, color) -> None:
    cv2.rectangle(canvas, _at(a), _at(b), color, -1)


def _dot(canvas: np.ndarray, point) -> None:
    cv2.circle(canvas, _at(point), round(3.6 * SHRINK), DOT, -1, cv2.LINE_AA)


def _text(canvas, said: str, x: float, y: float, color, scale: float, side: float = 0.5) -> None:
    """`side` 0 begins at x, 0.5 is centred on it, 1 ends there."""
    font, large, stroke = cv2.FONT_HERSHEY_SIMPLEX, scale * SHRINK, round(1.1 * SHRINK)
    width = cv2.getTextSize(said, font, large, stroke)[0][0] / SHRINK
    cv2.putText(canvas, said, _at((x - side * width, y)), font, large, color, stroke, cv2.LINE_AA)
