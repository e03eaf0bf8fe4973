# SPDX-License-Identifier: GPL-3.0-or-later
"""Known planes and lines in the world: what turns one picked pixel into one point.

Reverse mapping of the paper (section 4, eq. 16-22): a pixel is a ray; the reference gives what the
single picture can't, the depth.
"""

from __future__ import annotations

from dataclasses import dataclass

from .arrays import Array, frozen
from .errors import InvalidValue


@dataclass(frozen=True, eq=False)
class ReferencePlane:
    """The plane through `point` (3,) with unit `normal` (3,), in the world (paper eq. 18)."""

    name: str
    point: Array
    normal: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "point", frozen(self.point, (3,), f"{self.name}: point"))
        object.__setattr__(self, "normal", _unit(self.normal, f"{self.name}: normal"))


@dataclass(frozen=True, eq=False)
class ReferenceLine:
    """The line through `point` (3,) along unit `direction` (3,), in the world (paper eq. 19)."""

    name: str
    point: Array
    direction: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "point", frozen(self.point, (3,), f"{self.name}: point"))
        direction = _unit(self.direction, f"{self.name}: direction")
        object.__setattr__(self, "direction", direction)


def _unit(vector: Array, name: str) -> Array:
    v = frozen(vector, (3,), name)
    length = float((v @ v) ** 0.5)
    if length < 1e-9:
        raise InvalidValue(f"{name}: has no length, so it gives no direction")
    return frozen(v / length, (3,), name)
