# SPDX-License-Identifier: GPL-3.0-or-later
"""The metric objects of a virtual environment: where each stands, its sizes, and their error."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from .appearance import Appearance
from .arrays import Array, frozen, positive
from .covariance import checked_covariance
from .errors import InvalidValue
from .pose import Pose

# picks as the document holds them: a role ("base", "top", ...) to a list of pixels
Picks = Mapping[str, Any]


@dataclass(frozen=True, eq=False)
class Primitive:
    """What all primitives share.

    The object's frame is at its centre of volume, z along its axis or height. `on` names the
    reference it stands on. `picks` are the operator's pixels, kept so that the object can be solved
    again after a better calibration; `known` are the sizes that were typed, not solved.

    `covariance` is on (twist of `world_from_object` as in `Pose.perturbed` but with the rotation
    taken about the object's own centre, then the sizes in order): its first three rows are the
    rotation vector in world axes (radians), the next three the centre's position (metres).
    """

    name: str
    world_from_object: Pose
    on: str | None = field(default=None, kw_only=True)
    picks: Picks = field(default_factory=dict, kw_only=True)
    known: Mapping[str, float] = field(default_factory=dict, kw_only=True)
    appearance: Appearance | None = field(default=None, kw_only=True)
    covariance: Array | None = field(default=None, kw_only=True)

    kind: ClassVar[str]
    size_names: ClassVar[tuple[str, ...]]

    def __post_init__(self) -> None:
        if not self.name:
            raise InvalidValue("name: an object needs a name that is not empty")
        if self.covariance is not None:
            rows = 6 + len(self.size_names)
            matrix = checked_covariance(self.covariance, rows, f"{self.name}: covariance")
            object.__setattr__(self, "covariance", matrix)

    @property
    def sizes(self) -> Array:
        """The sizes in the order of `size_names`, metres."""
        raise NotImplementedError

    @property
    def half_extent(self) -> Array:
        """Half of the bounding box in the object's own frame, (3,) in metres."""
        raise NotImplementedError

    def position_sigma(self) -> Array | None:
        """1 sigma of the centre along the world axes, (3,) in metres."""
        return None if self.covariance is None else np.sqrt(np.diag(self.covariance)[3:6])

    def size_sigma(self) -> Array | None:
        """1 sigma of each size, metres."""
        return None if self.covariance is None else np.sqrt(np.diag(self.covariance)[6:])


@dataclass(frozen=True, eq=False)
class Box(Primitive):
    """A cuboid; `size` (3,) holds its full edge lengths along its own x, y, z in metres."""

    size: Array = field(kw_only=True)

    kind = "box"
    size_names = ("size_x", "size_y", "size_z")

    def __post_init__(self) -> None:
        super().__post_init__()
        size = frozen(self.size, (3,), f"{self.name}: size")
        if (size <= 0).any():
            raise InvalidValue(f"{self.name}: size must be above zero, got {size.tolist()}")
        object.__setattr__(self, "size", size)

    @property
    def sizes(self) -> Array:
        return self.size

    @property
    def half_extent(self) -> Array:
        return self.size / 2

    def corners_world(self) -> Array:
        """The eight corners (8, 3) in the world: bit 0, 1, 2 of the index chooses +x, +y, +z."""
        signs = np.array([[i >> axis & 1 for axis in range(3)] for i in range(8)]) * 2 - 1
        return self.world_from_object.apply(signs * self.half_extent)


@dataclass(frozen=True, eq=False)
class Cylinder(Primitive):
    """A circular cylinder: `radius` and `height` (along its own z) in metres."""

    radius: float = field(kw_only=True)
    height: float = field(kw_only=True)

    kind = "cylinder"
    size_names = ("radius", "height")

    def __post_init__(self) -> None:
        super().__post_init__()
        for name in self.size_names:
            object.__setattr__(self, name, positive(getattr(self, name), f"{self.name}: {name}"))

    @property
    def sizes(self) -> Array:
        return np.array([self.radius, self.height])

    @property
    def half_extent(self) -> Array:
        return np.array([self.radius, self.radius, self.height / 2])
