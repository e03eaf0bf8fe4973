# SPDX-License-Identifier: GPL-3.0-or-later
"""Known planes and lines in the world: what turns one picked pixel into one point.

Reverse mapping of the paper (section 4, eq. 16-22): a pixel is a ray; the reference gives what the
single picture can't, the depth.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .arrays import Array, frozen
from .errors import InvalidValue
from .pose import Pose

# sine of the tilt (about 2 degrees) up to which a plane counts as a floor
NEARLY_LEVEL = 0.03


@dataclass(frozen=True, eq=False)
class ReferencePlane:
    """The plane through `point` (3,) with unit `normal` (3,), in the world (paper eq. 18)."""

    name: str
    point: Array
    normal: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "point", frozen(self.point, (3,), f"{self.name}: point"))
        object.__setattr__(self, "normal", _unit(self.normal, f"{self.name}: normal"))

    @property
    def world_from_plane(self) -> Pose:
        """A frame on the plane: origin at `point`, z along the normal, x level.

        On a floor or ceiling, where every direction is level, x follows the world's x.
        """
        level = np.cross([0.0, 0.0, 1.0], self.normal)
        if np.linalg.norm(level) < NEARLY_LEVEL:
            level = np.array([1.0, 0.0, 0.0])
        x = level - self.normal * (level @ self.normal)
        x = x / np.linalg.norm(x)
        rotation = np.stack([x, np.cross(self.normal, x), self.normal], axis=1)
        return Pose(rotation, self.point)


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
    # a unit vector that was written and read again keeps its last digit
    return v if abs(length - 1) < 1e-15 else frozen(v / length, (3,), name)
