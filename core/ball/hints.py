# SPDX-License-Identifier: GPL-3.0-or-later
"""What a person knows of a ball beforehand: rough size, colour, background, all checked here."""

from __future__ import annotations

from dataclasses import dataclass

from ..arrays import frozen, positive
from ..errors import InvalidValue
from ..picture.pictures import Picture

# outlines of fewer pixels can't be measured
SMALLEST_PIXELS = 4.0
# a rough radius may be off by this factor, either way
ROUGHLY = 1.6
# sRGB, as people name them
COLORS = {
    "red": (200, 30, 30),
    "orange": (230, 110, 20),
    "yellow": (230, 210, 40),
    "green": (40, 150, 60),
    "cyan": (40, 190, 200),
    "blue": (30, 60, 190),
    "purple": (120, 40, 160),
    "pink": (240, 120, 170),
    "white": (240, 240, 240),
    "grey": (128, 128, 128),
    "gray": (128, 128, 128),
    "black": (20, 20, 20),
}


@dataclass(frozen=True, eq=False)
class FindHints:
    """Hints that rank round things in a picture, and keep impossible ones out.

    - `rough_radius_pixels`: of the ball in the picture; up to 1.6 times more or less is looked for
    - `color`: the ball's, (red, green, blue) in sRGB from 0 to 255; it weighs, and never decides
    - `background`: another picture of the same fixed camera, empty or with the ball elsewhere

    Raises InvalidValue for a radius or colour that can't be.
    """

    rough_radius_pixels: float | None = None
    color: tuple[float, float, float] | None = None
    background: Picture | None = None

    def __post_init__(self) -> None:
        if self.rough_radius_pixels is not None:
            rough = positive(self.rough_radius_pixels, "rough_radius_pixels")
            if rough < SMALLEST_PIXELS:
                raise InvalidValue(
                    f"rough_radius_pixels: {rough:g} px is too small to be measured; "
                    f"{SMALLEST_PIXELS:g} px are needed"
                )
            object.__setattr__(self, "rough_radius_pixels", rough)
        if self.color is not None:
            red, green, blue = frozen(self.color, (3,), "color").tolist()
            if not 0 <= min(red, green, blue) <= max(red, green, blue) <= 255:
                raise InvalidValue(
                    f"color: {red:g} {green:g} {blue:g} is none; give red, green and blue "
                    "from 0 to 255"
                )
            object.__setattr__(self, "color", (red, green, blue))

    @property
    def weigh(self) -> bool:
        """Whether anything but the size tells one round thing from another."""
        return self.color is not None or self.background is not None


def color_named(words: list[str]) -> tuple[float, float, float]:
    """A colour by its name, or by three numbers from 0 to 255. Raises InvalidValue."""
    if len(words) == 1 and words[0].lower() in COLORS:
        return COLORS[words[0].lower()]
    try:
        red, green, blue = (float(word) for word in words)
    except ValueError:
        raise InvalidValue(
            f"color: {' '.join(words)!r} is unknown; give three numbers from 0 to 255 or one of "
            f"{', '.join(COLORS)}"
        ) from None
    return red, green, blue
