# SPDX-License-Identifier: GPL-3.0-or-later
"""What an object looks like: a uniform colour in linear light."""

from __future__ import annotations

from dataclasses import dataclass

from .arrays import Array, frozen
from .errors import InvalidValue


@dataclass(frozen=True, eq=False)
class Appearance:
    """`color` (3,): red, green, blue from 0 to 1, linear (not sRGB-encoded), as in glTF."""

    color: Array

    def __post_init__(self) -> None:
        color = frozen(self.color, (3,), "appearance.color")
        if (color < 0).any() or (color > 1).any():
            raise InvalidValue(
                f"appearance.color: each part must be from 0 to 1, got {color.round(4).tolist()}"
            )
        object.__setattr__(self, "color", color)
