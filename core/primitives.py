# SPDX-License-Identifier: GPL-3.0-or-later
"""The solids that a cell is modelled with: box, cylinder, sphere, cone, tube and prism."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Self

import numpy as np

from .arrays import Array, finite, frozen, positive
from .errors import InvalidValue
from .primitive import Picks, Primitive
from .shape.polygons import crossing_sides

# twice a polygon's area over its squared extent, below which it is no more than a line
THINNEST_POLYGON = 1e-6


@dataclass(frozen=True, eq=False)
class Box(Primitive):
    """A cuboid; `size` (3,) holds its full edge lengths along its own x, y, z in metres."""

    size: Array = field(kw_only=True)

    kind = "box"
    size_names = ("size_x", "size_y", "size_z")

    def __post_init__(self) -> None:
        size = frozen(self.size, (3,), f"{self.name}: size")
        if (size <= 0).any():
            raise InvalidValue(f"{self.name}: size must be above zero, got {size.tolist()}")
        object.__setattr__(self, "size", size)
        super().__post_init__()

    @property
    def sizes(self) -> Array:
        return self.size

    @property
    def half_extent(self) -> Array:
        return self.size / 2

    def with_parameters(self, parameters: Array) -> Self:
        return replace(self, size=parameters)

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
        _check_sizes(self, self.size_names)
        super().__post_init__()

    @property
    def half_extent(self) -> Array:
        return np.array([self.radius, self.radius, self.height / 2])


@dataclass(frozen=True, eq=False)
class Sphere(Primitive):
    """A ball of `radius` metres about its origin."""

    radius: float = field(kw_only=True)

    kind = "sphere"
    size_names = ("radius",)

    def __post_init__(self) -> None:
        _check_sizes(self, self.size_names)
        super().__post_init__()

    @property
    def half_extent(self) -> Array:
        return np.full(3, self.radius)


@dataclass(frozen=True, eq=False)
class Cone(Primitive):
    """A circular cone or frustum: `radius` at z = -height/2, `top_radius` at z = +height/2.

    `top_radius` is 0 for a cone that ends in a point, and may be the larger of the two.
    """

    radius: float = field(kw_only=True)
    top_radius: float = field(default=0.0, kw_only=True)
    height: float = field(kw_only=True)

    kind = "cone"
    size_names = ("radius", "top_radius", "height")

    def __post_init__(self) -> None:
        _check_sizes(self, ("radius", "height"))
        top = finite(self.top_radius, f"{self.name}: top_radius")
        if top < 0:
            raise InvalidValue(f"{self.name}: top_radius must not be below zero, got {top:g}")
        object.__setattr__(self, "top_radius", top)
        super().__post_init__()

    @property
    def half_extent(self) -> Array:
        widest = max(self.radius, self.top_radius)
        return np.array([widest, widest, self.height / 2])


@dataclass(frozen=True, eq=False)
class Tube(Primitive):
    """A hollow cylinder, open at both ends: outer `radius`, `inner_radius`, `height`, metres."""

    radius: float = field(kw_only=True)
    inner_radius: float = field(kw_only=True)
    height: float = field(kw_only=True)

    kind = "tube"
    size_names = ("radius", "inner_radius", "height")

    def __post_init__(self) -> None:
        _check_sizes(self, self.size_names)
        if self.inner_radius >= self.radius:
            raise InvalidValue(
                f"{self.name}: inner_radius {self.inner_radius:g} leaves no wall inside a radius "
                f"of {self.radius:g}"
            )
        super().__post_init__()

    @property
    def half_extent(self) -> Array:
        return np.array([self.radius, self.radius, self.height / 2])


@dataclass(frozen=True, eq=False)
class Prism(Primitive):
    """A polygon (N, 2) of the object's x-y plane, anticlockwise, extruded over `height` along z.

    The frame's origin is the polygon's centre of area, half way up: a polygon given about another
    point is refused (`Prism.around` moves it). Its parameters are the height and then x0, y0, x1...
    """

    polygon: Array = field(kw_only=True)
    height: float = field(kw_only=True)

    kind = "prism"
    size_names = ("height",)

    def __post_init__(self) -> None:
        _check_sizes(self, self.size_names)
        polygon = frozen(self.polygon, (None, 2), f"{self.name}: polygon")
        _check_polygon(polygon, self.name)
        away = float(np.linalg.norm(polygon_centre(polygon)))
        if away > 1e-6 * float(np.abs(polygon).max()):
            raise InvalidValue(
                f"{self.name}: polygon: its centre of area lies {1e3 * away:.3g} mm from the "
                "object's origin; move the origin there"
            )
        object.__setattr__(self, "polygon", polygon)
        super().__post_init__()

    @property
    def parameters(self) -> Array:
        return np.concatenate([[self.height], self.polygon.ravel()])

    @property
    def half_extent(self) -> Array:
        return np.array([*np.abs(self.polygon).max(axis=0), self.height / 2])

    def with_parameters(self, parameters: Array) -> Self:
        """The polygon is taken about its own centre of area: its place is the pose's alone."""
        polygon = np.asarray(parameters[1:], dtype=float).reshape(-1, 2)
        centred = polygon - polygon_centre(polygon)
        return replace(self, height=float(parameters[0]), polygon=centred)


def polygon_centre(polygon: Array) -> Array:
    """The centre of area (2,) of a simple polygon (N, 2) in order round."""
    after = np.roll(polygon, -1, axis=0)
    cross = polygon[:, 0] * after[:, 1] - polygon[:, 1] * after[:, 0]
    centre: Array = ((polygon + after) * cross[:, None]).sum(axis=0) / (3 * cross.sum())
    return centre


def _check_sizes(thing: Primitive, names: tuple[str, ...]) -> None:
    for name in names:
        object.__setattr__(thing, name, positive(getattr(thing, name), f"{thing.name}: {name}"))


def _check_polygon(polygon: Array, name: str) -> None:
    if len(polygon) < 3:
        raise InvalidValue(f"{name}: polygon: {len(polygon)} corners make no prism; give three")
    after = np.roll(polygon, -1, axis=0)
    double_area = float((polygon[:, 0] * after[:, 1] - polygon[:, 1] * after[:, 0]).sum())
    if double_area <= THINNEST_POLYGON * float(np.ptp(polygon, axis=0).max()) ** 2:
        raise InvalidValue(
            f"{name}: polygon: its corners lie on a line, cross, or go clockwise "
            f"(area {5e5 * double_area:.3g} mm^2); give them anticlockwise seen from above"
        )
    crossing = crossing_sides(polygon)
    if crossing is not None:
        i, j = crossing
        raise InvalidValue(
            f"{name}: polygon: the side from corner {i} meets the side from corner {j}; "
            "give the corners in order round, each once"
        )


KINDS: dict[str, type[Primitive]] = {
    kind.kind: kind for kind in (Box, Cylinder, Sphere, Cone, Tube, Prism)
}

__all__ = [
    "KINDS",
    "Box",
    "Cone",
    "Cylinder",
    "Picks",
    "Primitive",
    "Prism",
    "Sphere",
    "Tube",
    "polygon_centre",
]
