# SPDX-License-Identifier: GPL-3.0-or-later
"""Known planes and lines in the world: what turns one picked pixel into one point.

Reverse mapping of the paper (section 4, eq. 16-22): a pixel is a ray; the reference gives what the
single picture can't, the depth.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from .arrays import Array, frozen
from .covariance import checked_covariance
from .errors import InvalidValue
from .pose import FARTHEST, Pose
from .references.sources import Source

# sine of the tilt (about 2 degrees) up to which a plane counts as a floor
NEARLY_LEVEL = 0.03


@dataclass(frozen=True, eq=False)
class ReferencePlane:
    """The plane through `point` (3,) with unit `normal` (3,), in the world (paper eq. 18).

    `covariance` (6, 6) is on (rotation vector in world axes about its point, motion of the point),
    zero for a motion that changes nothing: along the plane, about its normal. None when no error is
    stated. `source` is what it was made from, None for a plane that was given in the world.

    `by_camera` (6, 6) says how it follows the camera's twist (`Pose.perturbed`): what was made
    through the camera shares the camera's error, and `covariance` includes that share. None stands
    for not at all where there is no source, and for not known where there is one.
    """

    name: str
    point: Array
    normal: Array
    covariance: Array | None = field(default=None, kw_only=True)
    by_camera: Array | None = field(default=None, kw_only=True)
    source: Source | None = field(default=None, kw_only=True)

    def __post_init__(self) -> None:
        object.__setattr__(self, "point", _place(self.point, f"{self.name}: point"))
        object.__setattr__(self, "normal", _unit(self.normal, f"{self.name}: normal"))
        _check_error(self)

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
    """The line through `point` (3,) along unit `direction` (3,), in the world (paper eq. 19).

    `covariance`, `by_camera` and `source` are as a plane's; what changes nothing here is a motion
    along the line and a rotation about it.
    """

    name: str
    point: Array
    direction: Array
    covariance: Array | None = field(default=None, kw_only=True)
    by_camera: Array | None = field(default=None, kw_only=True)
    source: Source | None = field(default=None, kw_only=True)

    def __post_init__(self) -> None:
        object.__setattr__(self, "point", _place(self.point, f"{self.name}: point"))
        direction = _unit(self.direction, f"{self.name}: direction")
        object.__setattr__(self, "direction", direction)
        _check_error(self)


@dataclass(frozen=True, eq=False)
class PendingReference:
    """A plane or line (`kind`) whose source is known and whose place is not worked out yet."""

    name: str
    kind: str
    source: Source

    def __post_init__(self) -> None:
        if self.kind not in self.source.makes:
            raise InvalidValue(
                f"{self.name}: {self.source.way!r} makes a {' or '.join(self.source.makes)}, "
                f"not a {self.kind}"
            )


Reference = ReferencePlane | ReferenceLine


def kind_of(reference: Reference | PendingReference) -> str:
    """`plane` or `line`."""
    if isinstance(reference, PendingReference):
        return reference.kind
    return "plane" if isinstance(reference, ReferencePlane) else "line"


def _check_error(reference: Reference) -> None:
    name = reference.name
    if reference.source is not None:
        PendingReference(name, kind_of(reference), reference.source)
    if reference.covariance is not None:
        matrix = checked_covariance(reference.covariance, 6, f"{name}: covariance")
        object.__setattr__(reference, "covariance", matrix)
    if reference.by_camera is not None:
        matrix = frozen(reference.by_camera, (6, 6), f"{name}: by_camera")
        object.__setattr__(reference, "by_camera", matrix)


def _place(point: Array, name: str) -> Array:
    place = frozen(point, (3,), name)
    if np.abs(place).max() > FARTHEST:
        raise InvalidValue(
            f"{name}: {np.abs(place).max():.3g} m is farther than any cell ({FARTHEST:g} m); "
            "positions are in metres"
        )
    return place


def _unit(vector: Array, name: str) -> Array:
    v = frozen(vector, (3,), name)
    length = float((v @ v) ** 0.5)
    if length < 1e-9:
        raise InvalidValue(f"{name}: has no length, so it gives no direction")
    # a unit vector that was written and read again keeps its last digit
    return v if abs(length - 1) < 1e-15 else frozen(v / length, (3,), name)
