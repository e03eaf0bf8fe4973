# SPDX-License-Identifier: GPL-3.0-or-later
"""The ways a reference plane or line can come about, each with what it was made from.

Where a source names another plane or line, it may name a reference of the cell (`floor`) or a
feature of an object (`crate.top`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..arrays import Array, finite, frozen, positive
from ..errors import InvalidValue
from ..pose import FARTHEST

# metres or radians: nothing is known better, and nothing in a cell worse
LEAST_SIGMA, MOST_SIGMA = 1e-9, 1e3


@dataclass(frozen=True, eq=False)
class Stated:
    """A place given in the world with 1 sigma: `sigma` in metres across the plane or line, and
    `tilt_sigma` in radians."""

    sigma: float = 0.0
    tilt_sigma: float = 0.0

    way: ClassVar[str] = "stated"
    makes: ClassVar[tuple[str, ...]] = ("plane", "line")

    def __post_init__(self) -> None:
        for name in ("sigma", "tilt_sigma"):
            object.__setattr__(self, name, _sigma(getattr(self, name), name))

    @property
    def needs(self) -> tuple[str, ...]:
        """The references and features that it is made from."""
        return ()


@dataclass(frozen=True, eq=False)
class ThroughPoints:
    """Through world points (N, 3): three or more for a plane, two or more for a line.

    `sigma` (N,) is 1 sigma of each in metres along every axis, one number for all of them, or None
    where it is not known: the scatter about the fit then tells it, if there is any.
    """

    points: Array
    sigma: Array | None = None

    way: ClassVar[str] = "points"
    makes: ClassVar[tuple[str, ...]] = ("plane", "line")

    def __post_init__(self) -> None:
        points = _near(frozen(self.points, (None, 3), "points"), "points")
        object.__setattr__(self, "points", points)
        if self.sigma is None:
            return
        sigma = np.asarray(self.sigma, dtype=float)
        sigma = np.full(len(points), sigma) if sigma.ndim == 0 else sigma
        sigma = frozen(sigma, (None,), "sigma")
        if len(sigma) != len(points):
            raise InvalidValue(f"sigma: {len(sigma)} numbers for {len(points)} points")
        for one in sigma:
            _sigma(one, "sigma")
        # one exact point among others would outweigh them without bound
        if (sigma == 0).any() and (sigma > 0).any():
            raise InvalidValue("sigma: zero for some points and not for others; give each its own")
        object.__setattr__(self, "sigma", sigma)

    @property
    def needs(self) -> tuple[str, ...]:
        """The references and features that it is made from."""
        return ()


@dataclass(frozen=True, eq=False)
class PickedPoints:
    """Through three or more picked pixels (N, 2), each `heights` (N,) metres above a plane."""

    pixels: Array
    heights: Array
    above: str

    way: ClassVar[str] = "picks"
    makes: ClassVar[tuple[str, ...]] = ("plane",)

    def __post_init__(self) -> None:
        pixels = frozen(self.pixels, (None, 2), "pixels")
        heights = np.asarray(self.heights, dtype=float)
        heights = np.full(len(pixels), heights) if heights.ndim == 0 else heights
        heights = _near(frozen(heights, (None,), "heights"), "heights")
        if len(heights) != len(pixels):
            raise InvalidValue(f"heights: {len(heights)} numbers for {len(pixels)} pixels")
        object.__setattr__(self, "pixels", pixels)
        object.__setattr__(self, "heights", heights)

    @property
    def needs(self) -> tuple[str, ...]:
        """The references and features that it is made from."""
        return (self.above,)


@dataclass(frozen=True, eq=False)
class FeatureOf:
    """A face of an object for a plane, an edge or axis for a line: `of` is like `crate.top`."""

    of: str

    way: ClassVar[str] = "feature"
    makes: ClassVar[tuple[str, ...]] = ("plane", "line")

    @property
    def needs(self) -> tuple[str, ...]:
        """The references and features that it is made from."""
        return (self.of,)


@dataclass(frozen=True, eq=False)
class FacingCamera:
    """The plane through a line, `axis`, that faces the camera as much as it can."""

    axis: str

    way: ClassVar[str] = "facing_camera"
    makes: ClassVar[tuple[str, ...]] = ("plane",)

    @property
    def needs(self) -> tuple[str, ...]:
        """The references and features that it is made from."""
        return (self.axis,)


@dataclass(frozen=True, eq=False)
class Upright:
    """At a right angle to the plane `on`: a plane through a floor line picked at two or more
    pixels (N, 2) of it, or a line at one pixel."""

    pixels: Array
    on: str

    way: ClassVar[str] = "upright"
    makes: ClassVar[tuple[str, ...]] = ("plane", "line")

    def __post_init__(self) -> None:
        object.__setattr__(self, "pixels", frozen(self.pixels, (None, 2), "pixels"))

    @property
    def needs(self) -> tuple[str, ...]:
        """The references and features that it is made from."""
        return (self.on,)


@dataclass(frozen=True, eq=False)
class Parallel:
    """Parallel to the plane `to`, `distance` metres from it along its normal, with 1 `sigma`."""

    to: str
    distance: float
    sigma: float = 0.0

    way: ClassVar[str] = "parallel"
    makes: ClassVar[tuple[str, ...]] = ("plane",)

    def __post_init__(self) -> None:
        distance = finite(self.distance, "distance")
        object.__setattr__(self, "distance", float(_near(np.array(distance), "distance")))
        object.__setattr__(self, "sigma", _sigma(self.sigma, "sigma"))

    @property
    def needs(self) -> tuple[str, ...]:
        """The references and features that it is made from."""
        return (self.to,)


@dataclass(frozen=True, eq=False)
class Intersection:
    """The line in which two planes meet, along the cross product of their normals."""

    planes: tuple[str, str]

    way: ClassVar[str] = "intersection"
    makes: ClassVar[tuple[str, ...]] = ("line",)

    def __post_init__(self) -> None:
        if len(self.planes) != 2 or self.planes[0] == self.planes[1]:
            raise InvalidValue(f"planes: expected two that differ, got {list(self.planes)}")

    @property
    def needs(self) -> tuple[str, ...]:
        """The references and features that it is made from."""
        return self.planes


@dataclass(frozen=True, eq=False)
class AlongDirection:
    """The line through a point in a direction.

    `through` is a world point (3,) or a point feature such as `ball.centre`; `along` a vector (3,),
    or the name of a line, or of a plane whose normal is meant. `sigma` in metres and `tilt_sigma`
    in radians are those of the numbers that were typed.
    """

    through: Array | str
    along: Array | str
    sigma: float = 0.0
    tilt_sigma: float = 0.0

    way: ClassVar[str] = "direction"
    makes: ClassVar[tuple[str, ...]] = ("line",)

    def __post_init__(self) -> None:
        for name in ("through", "along"):
            if not isinstance(getattr(self, name), str):
                object.__setattr__(self, name, frozen(getattr(self, name), (3,), name))
        if not isinstance(self.through, str):
            _near(self.through, "through")
        if not isinstance(self.along, str):
            positive(np.linalg.norm(self.along), "along: its length")
        for name, typed in (("sigma", "through"), ("tilt_sigma", "along")):
            object.__setattr__(self, name, _sigma(getattr(self, name), name))
            if getattr(self, name) > 0 and isinstance(getattr(self, typed), str):
                raise InvalidValue(
                    f"{name}: is of numbers that are typed, and {typed} names "
                    f"{getattr(self, typed)!r}, which has its own error; leave one of the two"
                )

    @property
    def needs(self) -> tuple[str, ...]:
        """The references and features that it is made from."""
        return tuple(name for name in (self.through, self.along) if isinstance(name, str))


Source = (
    Stated
    | ThroughPoints
    | PickedPoints
    | FeatureOf
    | FacingCamera
    | Upright
    | Parallel
    | Intersection
    | AlongDirection
)
WAYS: dict[str, type[Source]] = {
    noun.way: noun
    for noun in (
        *(Stated, ThroughPoints, PickedPoints, FeatureOf, FacingCamera),
        *(Upright, Parallel, Intersection, AlongDirection),
    )
}


def _sigma(value: float, name: str) -> float:
    """Zero, or what an error can be: metres up to a kilometre, radians up to half a turn."""
    number, most = finite(value, name), np.pi if name == "tilt_sigma" else MOST_SIGMA
    if number < 0:
        raise InvalidValue(f"{name}: must not be below zero, got {number:g}")
    if number > most or 0 < number < LEAST_SIGMA:
        raise InvalidValue(
            f"{name}: {number:g} is no error; give 0, or {LEAST_SIGMA:g} to {most:g}"
        )
    return number


def _near(array: Array, name: str) -> Array:
    """Refuses places that no cell reaches to."""
    if array.size and np.abs(array).max() > FARTHEST:
        raise InvalidValue(
            f"{name}: {np.abs(array).max():.3g} m is farther than any cell ({FARTHEST:g} m); "
            "positions are in metres"
        )
    return array
