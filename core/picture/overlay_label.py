# SPDX-License-Identifier: GPL-3.0-or-later
"""Lines of text and a place in, a small legible label drawn into a picture out.

OpenCV's stroke font is drawn four times as large and shrunk, which smooths it; the signs that it
lacks (±, ×, ⌀) are made of its own strokes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from ..arrays import Array

Picture = NDArray[np.uint8]
Color = tuple[int, int, int]
FONT = cv2.FONT_HERSHEY_SIMPLEX
SHRINK = 4
# pixels of a capital letter at scale 1
CAPITAL = 22.0
PAPER: Color = (28, 24, 22)
# a mask has one channel
WHITE = (255,)
INK: Color = (245, 245, 245)
OPACITY = 0.78


@dataclass(frozen=True, eq=False)
class Label:
    """Text lines, the `mark` colour of what they name, and the height of a capital in pixels."""

    lines: tuple[str, ...]
    mark: Color
    capital: float

    @property
    def size(self) -> tuple[int, int]:
        """Width and height in pixels."""
        pad = self._pad
        widest = max(_width(line, self._scale) for line in self.lines)
        height = self._line * (len(self.lines) - 1) + self.capital + 2 * pad
        return round(widest / SHRINK + 2.6 * pad), round(height)

    def draw(self, picture: Picture, left: int, top: int) -> None:
        """Draw into an 8-bit colour picture, in place, with the top left corner at (left, top)."""
        width, height = self.size
        large: Picture = np.zeros((height * SHRINK, width * SHRINK), np.uint8)
        pad = self._pad * SHRINK
        for i, line in enumerate(self.lines):
            base = round(pad + (self.capital + i * self._line) * SHRINK)
            _write(large, line, round(1.6 * pad), base, self._scale, self._stroke)
        text = cv2.resize(large, (width, height), interpolation=cv2.INTER_AREA)
        rows, columns = slice(max(top, 0), top + height), slice(max(left, 0), left + width)
        area = picture[rows, columns].astype(float)
        offset_y, offset_x = max(-top, 0), max(-left, 0)
        ink = text[offset_y:, offset_x:][: area.shape[0], : area.shape[1], None] / 255.0
        area += OPACITY * (np.array(PAPER) - area)
        stripe = max(0, round(0.45 * self._pad) - offset_x)
        area[:, :stripe] = self.mark
        area += ink * (np.array(INK) - area)
        picture[rows, columns] = np.round(area).astype(np.uint8)

    @property
    def _pad(self) -> float:
        return 0.75 * self.capital

    @property
    def _line(self) -> float:
        return 1.75 * self.capital

    @property
    def _scale(self) -> float:
        return SHRINK * self.capital / CAPITAL

    @property
    def _stroke(self) -> int:
        return max(1, round(0.14 * SHRINK * self.capital))


def write_text(
    picture: Picture, line: str, place: tuple[float, float], capital: float, ink: Color = INK
) -> None:
    """One line without a label's paper, its capitals' left top corner at `place`, in place."""
    scale, rim = SHRINK * capital / CAPITAL, round(capital)
    width, height = round(text_width(line, capital)) + 2 * rim, 3 * rim
    large: Picture = np.zeros((height * SHRINK, width * SHRINK), np.uint8)
    base = round((rim + capital) * SHRINK)
    _write(large, line, rim * SHRINK, base, scale, max(1, round(0.14 * SHRINK * capital)))
    text = cv2.resize(large, (width, height), interpolation=cv2.INTER_AREA)
    left, top = round(place[0]) - rim, round(place[1]) - rim
    rows, columns = slice(max(top, 0), max(top + height, 0)), slice(max(left, 0), left + width)
    area = picture[rows, columns].astype(float)
    seen = text[max(-top, 0) :, max(-left, 0) :][: area.shape[0], : area.shape[1], None] / 255.0
    picture[rows, columns] = np.round(area + seen * (np.array(ink) - area)).astype(np.uint8)


def text_width(line: str, capital: float) -> float:
    """How many pixels wide a line is."""
    return _width(line, SHRINK * capital / CAPITAL) / SHRINK


def place_label(
    label: Label, around: Array, taken: Sequence[Array], picture_size: tuple[int, int]
) -> Array:
    """The box (left, top, right, bottom) beside `around` that covers the least of `taken`.

    `around` is what the label names, also as a box; the label stays inside the picture.
    """
    width, height = label.size
    left, top, right, bottom = around
    gap = label.capital
    middle_x, middle_y = (left + right - width) / 2, (top + bottom - height) / 2
    wishes = [
        (middle_x, top - gap - height),
        (right + gap, middle_y),
        (left - gap - width, middle_y),
        (middle_x, bottom + gap),
        (right + gap, top - gap - height),
        (left - gap - width, top - gap - height),
        (right + gap, bottom + gap),
        (left - gap - width, bottom + gap),
    ]
    rim = gap / 2
    room = np.maximum(np.array(picture_size) - [width + rim, height + rim], rim)
    places = [np.clip(wish, rim, room).round() for wish in wishes]
    boxes = [np.array([*p, p[0] + width, p[1] + height]) for p in places]
    # the earlier place wins between equals, and lying on the object itself is the last resort
    costs = [
        sum(_overlap(box, other) for other in taken) + 0.5 * _overlap(box, around) for box in boxes
    ]
    return boxes[int(np.argmin(costs))]


def _overlap(one: Array, other: Array) -> float:
    extent = np.minimum(one[2:], other[2:]) - np.maximum(one[:2], other[:2])
    return float(np.prod(np.maximum(extent, 0.0)))


def _width(line: str, scale: float) -> float:
    return sum(_advance(part, scale) for part in _parts(line))


def _advance(part: str, scale: float) -> float:
    shape = {"±": "+", "×": "x", "⌀": "O"}.get(part, part)
    (width, _), _ = cv2.getTextSize(shape, FONT, scale, 1)
    return float(width)


def _parts(line: str) -> list[str]:
    """Runs of plain text, with every sign that the font lacks by itself."""
    parts: list[str] = []
    for letter in line:
        if letter in "±×⌀" or not parts or parts[-1] in "±×⌀":
            parts.append(letter)
        else:
            parts[-1] += letter
    return parts


def _write(canvas: Picture, line: str, left: int, base: int, scale: float, stroke: int) -> None:
    x = float(left)
    for part in _parts(line):
        advance = _advance(part, scale)
        _write_part(canvas, part, (round(x), base), scale, stroke, advance)
        x += advance


def _write_part(
    canvas: Picture, part: str, at: tuple[int, int], scale: float, stroke: int, advance: float
) -> None:
    x, base = at
    unit = scale * CAPITAL
    middle = x + advance / 2
    arm = 0.30 * unit
    strokes = {
        "±": [(-arm, -0.55, arm, -0.55), (0, -0.85, 0, -0.25), (-arm, 0.0, arm, 0.0)],
        "×": [(-0.8 * arm, -0.62, 0.8 * arm, -0.14), (-0.8 * arm, -0.14, 0.8 * arm, -0.62)],
        "⌀": [(-1.2 * arm, 0.02, 1.2 * arm, -0.92)],
    }
    if part not in strokes:
        cv2.putText(canvas, part, at, FONT, scale, WHITE, stroke, cv2.LINE_AA)
        return
    if part == "⌀":
        centre = (round(middle), round(base - 0.45 * unit))
        cv2.circle(canvas, centre, round(0.36 * unit), WHITE, stroke, cv2.LINE_AA)
    for x0, y0, x1, y1 in strokes[part]:
        start = (round(middle + x0), round(base + y0 * unit))
        end = (round(middle + x1), round(base + y1 * unit))
        cv2.line(canvas, start, end, WHITE, stroke, cv2.LINE_AA)
