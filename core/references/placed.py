# SPDX-License-Identifier: GPL-3.0-or-later
"""A reference or a feature of an object in, its place with the causes of its error out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ..arrays import Array
from ..camera import Camera
from ..errors import InvalidValue
from ..primitive import Primitive
from ..reference import Reference, ReferenceLine, ReferencePlane
from ..rotation import hat
from ..shape.features import FeatureKind, feature
from ..sketch import Sketch
from .influences import Influences, of_cause, of_object
from .sources import FeatureOf, Source, Stated


@dataclass(frozen=True, eq=False)
class Placed:
    """A plane, line or point in the world with what its error comes from.

    `influences` are of (rotation vector about its point, motion of the point), (6,). `residuals`
    (N,) in metres tell how far each point lies from a plane or line through many.
    """

    kind: FeatureKind
    point: Array
    direction: Array
    influences: Influences
    warnings: tuple[str, ...] = ()
    residuals: Array = field(default_factory=lambda: np.zeros(0))

    @property
    def error(self) -> Influences:
        """`influences` without the motions that change nothing."""
        gauge = np.eye(6)
        if self.kind != "point":
            along = np.outer(self.direction, self.direction)
            gauge[:3, :3] -= along
            gauge[3:, 3:] = along if self.kind == "plane" else np.eye(3) - along
        return self.influences.through(gauge)


# the name of a reference or feature to its place
Lookup = Callable[[str], Placed]


@dataclass(frozen=True, eq=False)
class Task:
    """A reference to be placed, and what there is to place it with.

    `stated` is the normal or direction that the document states, which tells the side; `camera`
    gives the cell's camera where it stands, or raises NoPose.
    """

    name: str
    kind: FeatureKind
    stated: Array | None
    lookup: Lookup
    camera: Callable[[], Camera]
    pick_sigma_pixels: float


def placed_as_given(reference: Reference) -> Placed:
    """A reference whose place is given in the world, with the error that is stated of it."""
    plane = isinstance(reference, ReferencePlane)
    way = reference.normal if isinstance(reference, ReferencePlane) else reference.direction
    covariance = reference.covariance
    if isinstance(reference.source, Stated):
        along = np.outer(way, way)
        across = np.eye(3) - along
        covariance = np.zeros((6, 6))
        covariance[:3, :3] = reference.source.tilt_sigma**2 * across
        covariance[3:, 3:] = reference.source.sigma**2 * (along if plane else across)
    error = of_cause(f"reference {reference.name}", np.eye(6), covariance)
    return Placed("plane" if plane else "line", reference.point, way, error)


def placed_feature(thing: Primitive, name: str, camera: Camera) -> Placed:
    """A feature of a solved object, with the object's error. Raises InvalidValue for no such."""
    found = feature(thing, name)
    by_object = np.vstack([hat(found.direction) @ found.by_direction, found.by_point])
    error = of_object(thing, camera).through(by_object)
    return Placed(found.kind, found.point, found.direction, error)


def reference_of_feature(
    things: Sequence[Primitive | Sketch], path: str, camera: Camera
) -> Reference:
    """The face, edge or axis that a path like `crate.top` names, with the object's error.

    Raises InvalidValue for a path that names none, an object that is not solved yet, or a point.
    """
    owner, _, feature_name = path.rpartition(".")
    thing = next((thing for thing in things if thing.name == owner), None)
    if thing is None:
        raise InvalidValue(f"no reference is called {path!r}")
    if isinstance(thing, Sketch):
        raise InvalidValue(f"{path}: {owner} is picked and not solved yet; model it first")
    placed = placed_feature(thing, feature_name, camera)
    if placed.kind == "point":
        raise InvalidValue(f"{path}: is a point, and a reference is a plane or a line")
    return as_reference(path, placed, FeatureOf(path))


def raised(plane: Placed, height: float) -> Placed:
    """The parallel plane at a height above it, following it as one rigid thing."""
    arm = height * plane.direction
    by_plane = np.eye(6)
    by_plane[3:, :3] = -hat(arm)
    return replace(plane, point=plane.point + arm, influences=plane.influences.through(by_plane))


def as_reference(name: str, placed: Placed, source: Source | None) -> Reference:
    """The reference of that name in its place."""
    noun = ReferencePlane if placed.kind == "plane" else ReferenceLine
    error = placed.error
    return noun(
        name,
        placed.point,
        placed.direction,
        covariance=error.covariance(),
        by_camera=error.by_camera,
        source=source,
    )
