# SPDX-License-Identifier: GPL-3.0-or-later
"""What all metric objects of a virtual environment share: name, place, sizes, and their error."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar, Self

import numpy as np

from .appearance import Appearance
from .arrays import Array, frozen
from .covariance import checked_covariance
from .errors import InvalidValue
from .motion import Motion
from .pose import Pose
from .relation import Relation

# picks as the document holds them: a role ("base", "top", ...) to a list of pixels
Picks = Mapping[str, Any]


@dataclass(frozen=True, eq=False)
class Primitive:
    """What all primitives share.

    The object's frame has z along its axis or height, its origin in the middle of that: the centre
    of volume, but for a cone. `on` names the reference it stands on (a reference of the cell, or a
    face of an object as `crate.top`); `relations` say what else holds it. `picks` are the
    operator's pixels, kept so that the object can be solved again after a better calibration;
    `known` are the sizes that were typed, not solved.

    `parameters` (P,) are its sizes in the order of `size_names`, and after them what else its shape
    has (a prism's polygon). `covariance` (6 + P, 6 + P) is on (twist of `world_from_object` as in
    `Pose.perturbed` but with the rotation taken about the object's own origin, then the
    parameters): its first three rows are the rotation vector in world axes (radians), the next
    three the origin's position (metres).
    `by_camera` (6 + P, 6) says how all of these follow the camera's twist when the picks stay: the
    part of the covariance that everything seen through the camera shares. None where not known.
    """

    name: str
    world_from_object: Pose
    on: str | None = field(default=None, kw_only=True)
    relations: tuple[Relation, ...] = field(default=(), kw_only=True)
    picks: Picks = field(default_factory=dict, kw_only=True)
    known: Mapping[str, float] = field(default_factory=dict, kw_only=True)
    appearance: Appearance | None = field(default=None, kw_only=True)
    motion: Motion = field(default_factory=Motion, kw_only=True)
    covariance: Array | None = field(default=None, kw_only=True)
    by_camera: Array | None = field(default=None, kw_only=True)

    kind: ClassVar[str]
    size_names: ClassVar[tuple[str, ...]]

    def __post_init__(self) -> None:
        if not self.name:
            raise InvalidValue("name: an object needs a name that is not empty")
        if self.covariance is not None:
            rows = 6 + len(self.parameters)
            matrix = checked_covariance(self.covariance, rows, f"{self.name}: covariance")
            object.__setattr__(self, "covariance", matrix)
        if self.by_camera is not None:
            rows = 6 + len(self.parameters)
            by_camera = frozen(self.by_camera, (rows, 6), f"{self.name}: by_camera")
            object.__setattr__(self, "by_camera", by_camera)

    @property
    def sizes(self) -> Array:
        """The sizes in the order of `size_names`, metres."""
        return np.array([getattr(self, name) for name in self.size_names])

    @property
    def parameters(self) -> Array:
        """All numbers of the shape, (P,): the sizes first."""
        return self.sizes

    @property
    def half_extent(self) -> Array:
        """Half of the bounding box about the origin of the object's own frame, (3,) in metres."""
        raise NotImplementedError

    def with_parameters(self, parameters: Array) -> Self:
        """The same object of another shape. Raises InvalidValue for an impossible one."""
        sizes: dict[str, Any] = dict(zip(self.size_names, map(float, parameters), strict=True))
        return replace(self, **sizes)

    def position_sigma(self) -> Array | None:
        """1 sigma of the origin along the world axes, (3,) in metres."""
        return None if self.covariance is None else np.sqrt(np.diag(self.covariance)[3:6])

    def size_sigma(self) -> Array | None:
        """1 sigma of each of `sizes`, metres."""
        if self.covariance is None:
            return None
        return np.sqrt(np.diag(self.covariance)[6 : 6 + len(self.size_names)])
