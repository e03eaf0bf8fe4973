# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces laid flat: a face of a solid in, a map between its surface and a unit square out.

(s, t) runs from (0, 0) at the top left to (1, 1) at the bottom right of the face as one looks at it
from outside, its up being the object's +z (of `base` and `top` +y). Flat faces keep their
proportions; a disc or a polygon lies in the rectangle round it. Round sides are unrolled from the
object's +x axis on, and a sphere is laid out by longitude and latitude.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array, Mask
from ..errors import InvalidValue
from ..primitives import Box, Cone, Cylinder, Primitive, Prism, Sphere, Tube
from .intervals import BOX_FACES, face_names

TURN = 2 * np.pi


class Chart(ABC):
    """A map between (s, t) and points of the face in the object's frame, metres."""

    @abstractmethod
    def points(self, st: ArrayLike) -> Array:
        """(s, t) pairs (N, 2) to points (N, 3) of the object's frame."""

    @abstractmethod
    def normals(self, st: ArrayLike) -> Array:
        """The outward unit normals (N, 3) there."""

    @abstractmethod
    def coordinates(self, points: ArrayLike, near: ArrayLike | None = None) -> Array:
        """Points (N, 3) of the face to (s, t), (N, 2).

        Where the chart closes on itself, s comes out within half a turn of that of `near` (N, 2),
        and may leave 0 to 1; without `near` it lies from 0 to 1.
        """

    def covers(self, st: ArrayLike) -> Mask:
        """Which (s, t) pairs (N, 2) lie on the face: not all of the square round a disc does."""
        inside: Mask = ((np.asarray(st) >= 0) & (np.asarray(st) <= 1)).all(axis=1)
        return inside


@dataclass(frozen=True, eq=False)
class FlatChart(Chart):
    """A plane face in its rectangle: top left `corner` (3,), `across` and `down` (3,) its sides.

    Of the rectangle it fills all, or the `polygon` (N, 2) of (s, t), or the ring between the shares
    `ring` (inner, outer) of the half side.
    """

    corner: Array
    across: Array
    down: Array
    polygon: Array | None = None
    ring: tuple[float, float] | None = None

    def points(self, st: ArrayLike) -> Array:
        p = np.asarray(st, dtype=float)
        return self.corner + p[:, :1] * self.across + p[:, 1:] * self.down

    def normals(self, st: ArrayLike) -> Array:
        normal = np.cross(self.down, self.across)
        return np.tile(normal / np.linalg.norm(normal), (len(np.asarray(st)), 1))

    def coordinates(self, points: ArrayLike, near: ArrayLike | None = None) -> Array:
        away = np.asarray(points, dtype=float) - self.corner
        sides = np.stack([side / (side @ side) for side in (self.across, self.down)], axis=1)
        flat: Array = away @ sides
        return flat

    def covers(self, st: ArrayLike) -> Mask:
        p = np.asarray(st, dtype=float)
        if self.ring is not None:
            radius = 2 * np.hypot(p[:, 0] - 0.5, p[:, 1] - 0.5)
            return (radius >= self.ring[0]) & (radius <= self.ring[1])
        if self.polygon is None:
            return super().covers(p)
        return _in_polygon(self.polygon, p)


@dataclass(frozen=True, eq=False)
class RoundChart(Chart):
    """An unrolled side of radius `low` at the bottom and `high` at the top, `height` metres high.

    s runs anticlockwise seen from above, and clockwise on an `inner` wall, as one sees it.
    """

    low: float
    high: float
    height: float
    inner: bool = False

    def points(self, st: ArrayLike) -> Array:
        p = np.asarray(st, dtype=float)
        angle, up = self._way * TURN * p[:, 0], 1 - p[:, 1]
        radius = self.low + (self.high - self.low) * up
        z = self.height * (up - 0.5)
        return np.stack([radius * np.cos(angle), radius * np.sin(angle), z], axis=1)

    def normals(self, st: ArrayLike) -> Array:
        angle = self._way * TURN * np.asarray(st, dtype=float)[:, 0]
        slope = (self.high - self.low) / self.height
        normal = np.stack([np.cos(angle), np.sin(angle), np.full(len(angle), -slope)], axis=1)
        turned: Array = normal * (self._way / np.hypot(1.0, slope))
        return turned

    def coordinates(self, points: ArrayLike, near: ArrayLike | None = None) -> Array:
        p = np.asarray(points, dtype=float)
        s = self._way * np.arctan2(p[:, 1], p[:, 0]) / TURN
        # the angle of a point on the axis, where a cone ends, is free
        on_axis = np.hypot(p[:, 0], p[:, 1]) < 1e-9 * max(self.low, self.high)
        t = 0.5 - p[:, 2] / self.height
        return _wrapped(np.stack([s, t], axis=1), near, on_axis)

    @property
    def _way(self) -> float:
        return -1.0 if self.inner else 1.0


@dataclass(frozen=True, eq=False)
class BallChart(Chart):
    """A sphere by longitude from +x anticlockwise, and by the angle down from +z."""

    radius: float

    def points(self, st: ArrayLike) -> Array:
        return self.radius * self.normals(st)

    def normals(self, st: ArrayLike) -> Array:
        p = np.asarray(st, dtype=float)
        longitude, polar = TURN * p[:, 0], np.pi * p[:, 1]
        flat = np.stack([np.cos(longitude), np.sin(longitude)], axis=1)
        return np.column_stack([flat * np.sin(polar)[:, None], np.cos(polar)])

    def coordinates(self, points: ArrayLike, near: ArrayLike | None = None) -> Array:
        p = np.asarray(points, dtype=float)
        flat = np.hypot(p[:, 0], p[:, 1])
        s = np.arctan2(p[:, 1], p[:, 0]) / TURN
        t = np.arctan2(flat, p[:, 2]) / np.pi
        return _wrapped(np.stack([s, t], axis=1), near, flat < 1e-9 * self.radius)


def chart_of(thing: Primitive, face: str) -> Chart:
    """The chart of a face by its name. Raises InvalidValue for a face that the solid has not."""
    if face not in face_names(thing):
        raise InvalidValue(
            f"{thing.name}: a {thing.kind} has no face {face!r}; it has "
            f"{', '.join(face_names(thing))}"
        )
    if isinstance(thing, Box):
        return _box_chart(thing, face)
    if isinstance(thing, Prism):
        return _prism_chart(thing, face)
    if isinstance(thing, Sphere):
        return BallChart(thing.radius)
    if isinstance(thing, Cylinder | Cone | Tube):
        return _turned_chart(thing, face)
    raise TypeError(f"{thing.kind}: its faces are not known")


def _box_chart(box: Box, face: str) -> Chart:
    index = BOX_FACES.index(face)
    normal = np.zeros(3)
    normal[index // 2] = 1.0 if index % 2 else -1.0
    return _rectangle(normal, np.zeros(3), box.half_extent)


def _rectangle(
    normal: Array, centre: Array, half: Array, polygon: Array | None = None,
    ring: tuple[float, float] | None = None,
) -> FlatChart:  # fmt: skip
    """The face of a box about `centre` that looks along `normal`, an axis of the object."""
    up = np.array([0.0, 1, 0]) if normal[2] else np.array([0.0, 0, 1])
    right = np.cross(up, normal)
    right, up = right * (np.abs(right) @ half), up * (np.abs(up) @ half)
    middle = centre + normal * (np.abs(normal) @ half)
    return FlatChart(middle - right + up, 2 * right, -2 * up, polygon, ring)


def _prism_chart(prism: Prism, face: str) -> Chart:
    corners, half = prism.polygon, prism.height / 2
    if face.startswith("side"):
        index = int(face[4:])
        here, after = corners[index], corners[(index + 1) % len(corners)]
        return FlatChart(
            np.array([*here, half]),
            np.array([*(after - here), 0.0]),
            np.array([0, 0, -prism.height]),
        )
    low, high = corners.min(axis=0), corners.max(axis=0)
    normal = np.array([0, 0, 1.0 if face == "top" else -1.0])
    centre, size = np.array([*(low + high) / 2, 0.0]), np.array([*(high - low) / 2, half])
    whole = _rectangle(normal, centre, size)
    flat = whole.coordinates(np.column_stack([corners, np.full(len(corners), half * normal[2])]))
    return _rectangle(normal, centre, size, polygon=flat)


def _turned_chart(thing: Cylinder | Cone | Tube, face: str) -> Chart:
    top_radius = thing.top_radius if isinstance(thing, Cone) else thing.radius
    if face == "side":
        return RoundChart(thing.radius, top_radius, thing.height)
    hollow = thing.inner_radius if isinstance(thing, Tube) else 0.0
    if face == "inside":
        return RoundChart(hollow, hollow, thing.height, inner=True)
    radius = top_radius if face == "top" else thing.radius
    normal = np.array([0, 0, 1.0 if face == "top" else -1.0])
    size = np.array([radius, radius, thing.height / 2])
    return _rectangle(normal, np.zeros(3), size, ring=(hollow / radius, 1.0))


def _wrapped(st: Array, near: ArrayLike | None, free: Mask) -> Array:
    """s into the turn round that of `near`; where it is free, s of `near` itself."""
    if near is None:
        st[:, 0] %= 1.0
        return st
    beside = np.asarray(near, dtype=float)[:, 0]
    st[:, 0] -= np.round(st[:, 0] - beside)
    st[free, 0] = beside[free]
    return st


def _in_polygon(corners: Array, points: Array) -> Mask:
    """Even-odd: how often a line to the right of each point crosses the polygon."""
    after = np.roll(corners, -1, axis=0)
    x, y = points[:, 0, None], points[:, 1, None]
    spans = (corners[:, 1] > y) != (after[:, 1] > y)
    rise = np.where(after[:, 1] == corners[:, 1], 1.0, after[:, 1] - corners[:, 1])
    at = corners[:, 0] + (y - corners[:, 1]) * (after[:, 0] - corners[:, 0]) / rise
    inside: Mask = (spans & (at > x)).sum(axis=1) % 2 == 1
    return inside
