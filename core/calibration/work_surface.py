# SPDX-License-Identifier: GPL-3.0-or-later
"""Where on which surface accuracy counts: a cell in, the plane and the points worked at out."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array, finite
from ..camera import Camera
from ..cell import Cell
from ..errors import InvalidValue
from ..modelling.reverse_mapping import GRAZING_DEGREES, points_on_plane_or_nan
from ..primitives import Primitive
from ..reference import ReferencePlane
from ..sketch import Sketch
from .sigma_map import plane_derivatives

# picks of these roles lie on the reference itself, not above it
ON_REFERENCE = ("base", "rim")
POINTS_A_SIDE = 7
SIDE_POINTS = 24


@dataclass(frozen=True, eq=False)
class WorkArea:
    """Points of the plane where accuracy counts.

    - `told`: where they are, in words; `points_world` (M, 3)
    - `corners_world` (4, 3) of the box of what stands there; None for all that is seen
    - `by_twist` (M, 3, 6): how they move with the camera's twist, in the camera's axes
    """

    plane: ReferencePlane
    told: str
    points_world: Array
    by_twist: Array
    corners_world: Array | None = None

    def sigmas(self, covariances: Array) -> Array:
        """1 sigma (K,) in metres of the middle one of the points, for poses known to (K, 6, 6)."""
        squares = np.einsum("mij,mik->mjk", self.by_twist, self.by_twist)
        traces = covariances.reshape(len(covariances), -1) @ squares.reshape(len(squares), -1).T
        return np.median(np.sqrt(np.maximum(traces, 0.0)), axis=1)

    def frame_pixels(self, camera: Camera) -> Array | None:
        """The box's sides (N, 2) as the camera's lens images them, all round; None without one."""
        if self.corners_world is None:
            return None
        share = np.linspace(0, 1, SIDE_POINTS, endpoint=False)[:, None]
        ends = np.roll(self.corners_world, -1, axis=0)
        sides = [a + share * (b - a) for a, b in zip(self.corners_world, ends, strict=True)]
        return camera.project(np.concatenate(sides))


def surface_of(cell: Cell, asked: str | None = None) -> ReferencePlane:
    """The plane asked for: a reference's name or `z=0.1`; else the first plane, else z = 0.

    Raises InvalidValue for a name that no plane has.
    """
    planes = [r for r in cell.references if isinstance(r, ReferencePlane)]
    if asked is None:
        return planes[0] if planes else _level(0.0)
    for plane in planes:
        if plane.name == asked:
            return plane
    name, equals, height = asked.partition("=")
    if equals and name.strip() == "z":
        try:
            return _level(finite(float(height), "z"))
        except ValueError:
            raise InvalidValue(f"surface: {asked!r} has no number; write z=0.1") from None
    known = ", ".join(plane.name for plane in planes) or "none in this cell"
    raise InvalidValue(f"surface: no plane is called {asked!r}; there is {known}; or write z=0.1")


def work_area(cell: Cell, camera: Camera, plane: ReferencePlane) -> WorkArea | None:
    """The box of what stands on the plane, else all that the picture shows of the plane.

    None where the picture shows nothing of it.
    """
    corners = _footprints(cell, camera, plane)
    if len(corners) >= 2:
        frame = plane.world_from_plane
        flat = frame.inverse().apply(corners)
        low, high = flat[:, :2].min(axis=0), flat[:, :2].max(axis=0)
        grid = [np.linspace(a, b, POINTS_A_SIDE) for a, b in zip(low, high, strict=True)]
        x, y = np.meshgrid(*grid)
        points = frame.apply(np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1))
        wide, deep = high - low
        area = _area(camera, plane, f"where things stand ({wide:.2f} x {deep:.2f} m)", points)
        if area is not None:
            rim = np.array([low, [high[0], low[1]], high, [low[0], high[1]]])
            return replace(area, corners_world=frame.apply(np.column_stack([rim, np.zeros(4)])))
    inner = camera.intrinsics
    steps = (np.arange(POINTS_A_SIDE) + 0.5) / POINTS_A_SIDE
    u, v = np.meshgrid(steps * inner.width - 0.5, steps * inner.height - 0.5)
    pixels = np.stack([u.ravel(), v.ravel()], axis=1)
    return _area(
        camera, plane, "over all that is seen", points_on_plane_or_nan(camera, plane, pixels)
    )


def _area(camera: Camera, plane: ReferencePlane, told: str, points: Array) -> WorkArea | None:
    """The points that are seen, and not at a grazing angle."""
    pixels = camera.project(points)
    rays = camera.pose.apply(points)
    rays = rays / np.linalg.norm(rays, axis=1, keepdims=True)
    sines = rays @ camera.pose.rotate(plane.normal)
    seen = np.abs(sines) > np.sin(np.radians(GRAZING_DEGREES))
    seen &= np.isfinite(pixels).all(axis=1) & camera.intrinsics.contains(np.nan_to_num(pixels))
    if not seen.any():
        return None
    by_twist = plane_derivatives(camera, plane, rays[seen]) / sines[seen, None, None] ** 2
    return WorkArea(plane, told, points[seen], by_twist)


def _footprints(cell: Cell, camera: Camera, plane: ReferencePlane) -> Array:
    """Points (N, 3) of the plane that things on it were picked at, or stand at."""
    on_it = [thing for thing in cell.things if thing.on == plane.name]
    pixels = [p for thing in on_it for p in _picked(thing)]
    points = points_on_plane_or_nan(camera, plane, np.array(pixels).reshape(-1, 2))
    stood = [
        thing.world_from_object.translation
        for thing in on_it
        if isinstance(thing, Primitive) and not _picked(thing)
    ]
    found: Array = np.concatenate([points, np.array(stood).reshape(-1, 3)])
    return found[np.isfinite(found).all(axis=1)]


def _picked(thing: Primitive | Sketch) -> list[Array]:
    return [
        np.asarray(pixel, dtype=float)
        for role, pixels in thing.picks.items()
        if role in ON_REFERENCE
        for pixel in pixels
        if pixel is not None
    ]


def _level(height: float) -> ReferencePlane:
    return ReferencePlane(f"z = {height:g} m", np.array([0.0, 0.0, height]), np.array([0, 0, 1.0]))
