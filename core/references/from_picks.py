# SPDX-License-Identifier: GPL-3.0-or-later
"""Picked pixels and the plane that they show points of in, a plane or line in its place out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array
from ..camera import Camera
from ..errors import PickError
from ..modelling.picks import OUTSIDE_SHARE
from ..modelling.reverse_mapping import (
    grazing_warnings,
    point_derivatives_by_plane,
    point_derivatives_on_plane,
    points_on_plane,
)
from ..reference import ReferencePlane
from ..rotation import hat
from .doubt import doubt_of_tilt, noise_scale
from .fits import PointFit, fit_line, fit_plane
from .influences import Influences, blocks, of_camera, of_cause
from .placed import Placed, Task, raised
from .sides import seen_side
from .sources import PickedPoints, Upright

# closer than this, two picks are one
LEAST_PIXELS = 2.0
# an edge-on pick weighs as much as one that moves across by this share of the most
LEAST_SHARE = 1e-3
# width to length of points that count as one line; what noise makes of a wider strip is told
COLLINEAR = 0.01


def through_picks(task: Task, source: PickedPoints) -> Placed:
    """The plane through picked points of known height above another plane, least squares.

    Raises PickError, naming reference and pick, for picks that show no such points, or points on
    one line.
    """
    picked = _points(task, source.pixels, source.heights, source.above, fewest=3)
    fit = _settled(fit_plane, picked, lambda fit: fit.direction)
    if fit.width < COLLINEAR * fit.length:
        raise PickError(
            f"{task.name}: its picks lie within {1e3 * fit.width:.2g} mm of one line "
            f"{1e3 * fit.length:.4g} mm long; pick one beside it"
        )
    spread = _across(picked, fit.direction)
    spare = len(picked.world) - 3
    error, warnings = _error(task, picked, fit, fit.residuals / spread, spare)
    normal = seen_side(task, fit.point, fit.direction, task.camera().centre_world)
    placed = Placed("plane", fit.point, normal, error, (*picked.warnings, *warnings), fit.residuals)
    return doubt_of_tilt(task.name, placed, fit)


def upright(task: Task, source: Upright) -> Placed:
    """At a right angle to a plane: the plane through a line picked on it, or the line at a pick.

    Raises PickError, naming reference and pick, for picks that show nothing of the plane, or that
    are too few or too many.
    """
    if task.kind == "plane":
        return _upright_plane(task, source)
    if len(source.pixels) != 1:
        raise PickError(
            f"{task.name}: an upright line stands at one pick, and {len(source.pixels)} are given"
        )
    picked = _points(task, source.pixels, np.zeros(1), source.on, fewest=1)
    floor = task.lookup(source.on)
    by_floor = np.vstack([np.eye(3, 6), np.zeros((3, 6))])
    by_points = np.vstack([np.zeros((3, 3)), np.eye(3)])
    error = floor.influences.through(by_floor) + picked.influences.through(by_points)
    return Placed("line", picked.world[0], floor.direction, error, picked.warnings)


def _upright_plane(task: Task, source: Upright) -> Placed:
    picked = _points(task, source.pixels, np.zeros(len(source.pixels)), source.on, fewest=2)
    floor = task.lookup(source.on)

    def across(fit: PointFit) -> Array:
        normal = np.cross(fit.direction, floor.direction)
        return normal / np.linalg.norm(normal)

    fit = _settled(fit_line, picked, across)
    normal = across(fit)
    residuals = (picked.world - fit.point) @ normal
    spread = _across(picked, normal)
    of_line, warnings = _error(task, picked, fit, residuals / spread, len(residuals) - 2)
    # the normal d x n follows the picked line's direction d and the floor's normal n
    flat = (np.eye(3) - np.outer(normal, normal)) @ np.stack(
        [hat(floor.direction) @ hat(fit.direction), -hat(fit.direction) @ hat(floor.direction)]
    )
    turned = hat(normal) @ flat
    by_line, by_floor = np.zeros((6, 6)), np.zeros((6, 6))
    by_line[:3, :3], by_line[3:, 3:], by_floor[:3, :3] = turned[0], np.eye(3), turned[1]
    error = of_line.through(by_line) + floor.influences.through(by_floor)
    side = seen_side(task, fit.point, normal, task.camera().centre_world)
    warnings = (*picked.warnings, *warnings)
    placed = Placed("plane", fit.point, side, error, warnings, residuals)
    return doubt_of_tilt(task.name, placed, fit)


@dataclass(frozen=True, eq=False)
class _PickedInWorld:
    """World points (N, 3) that picks show, `by_pixel` (N, 3, 2), and their whole error (3N,)."""

    world: Array
    by_pixel: Array
    influences: Influences
    labels: tuple[str, ...]
    warnings: tuple[str, ...]


def _points(task: Task, pixels: Array, heights: Array, above: str, fewest: int) -> _PickedInWorld:
    """Each pixel onto the plane raised to its height, with what its error comes from."""
    if len(pixels) < fewest:
        raise PickError(
            f"{task.name}: {len(pixels)} picks make no {task.kind}; pick {fewest} or more"
        )
    camera, ground = task.camera(), task.lookup(above)
    labels = tuple(f"{task.name}: pixels[{i}]" for i in range(len(pixels)))
    _refuse_outside(pixels, camera, labels)
    _refuse_twins(pixels, labels)
    points, by_pixel = np.empty((len(pixels), 3)), np.empty((len(pixels), 3, 2))
    by_twist, by_ground = np.empty((len(pixels), 3, 6)), np.empty((len(pixels), 3, 6))
    warnings: tuple[str, ...] = ()
    for height in np.unique(heights):
        rows = np.flatnonzero(heights == height)
        at, names = pixels[rows], [labels[i] for i in rows]
        plane, lift = _raised_to(float(height), above, ground)
        points[rows] = points_on_plane(camera, plane, at, names)
        by_pixel[rows], by_twist[rows] = point_derivatives_on_plane(camera, plane, at)
        by_ground[rows] = point_derivatives_by_plane(camera, plane, at) @ lift
        warnings += grazing_warnings(camera, plane, at, names)
    noise = task.pick_sigma_pixels**2 * np.eye(2 * len(pixels))
    influences = (
        of_cause(_cause_of(task), blocks(by_pixel), noise)
        + of_camera(by_twist.reshape(-1, 6), camera)
        + ground.influences.through(by_ground.reshape(-1, 6))
    )
    return _PickedInWorld(points, by_pixel, influences, labels, warnings)


def _raised_to(height: float, above: str, ground: Placed) -> tuple[ReferencePlane, Array]:
    """The plane at a height, and how it moves with the one below, (6, 6)."""
    level = raised(ground, height)
    lift = np.eye(6)
    lift[3:, :3] = -hat(height * ground.direction)
    name = above if height == 0 else f"{above} raised by {height:g} m"
    return ReferencePlane(name, level.point, level.direction), lift


def _settled(
    fitted: Callable[[Array, Array], PointFit],
    picked: _PickedInWorld,
    normal_of: Callable[[PointFit], Array],
) -> PointFit:
    """The fit in which every point counts by how well its pick tells the distance across."""
    fit = fitted(picked.world, np.ones(len(picked.world)))
    for _ in range(2):
        fit = fitted(picked.world, _across(picked, normal_of(fit)) ** -2)
    return fit


def _across(picked: _PickedInWorld, normal: Array) -> Array:
    """Metres across the plane for each pixel of a pick, (N,); an edge-on pick tells no more."""
    metres = np.linalg.norm(normal @ picked.by_pixel, axis=1)
    # picks of one height lie in their plane wherever they are made
    if metres.max() < LEAST_SHARE * np.linalg.norm(picked.by_pixel, axis=(1, 2)).max():
        return np.ones(len(metres))
    return np.maximum(metres, LEAST_SHARE * metres.max())


def _error(
    task: Task, picked: _PickedInWorld, fit: PointFit, off_pixels: Array, spare: int
) -> tuple[Influences, tuple[str, ...]]:
    """The fit's error, with the pick noise that the residuals show, and a word where it is more."""
    influences = picked.influences.through(fit.by_points)
    scale = noise_scale(off_pixels / task.pick_sigma_pixels, spare)
    if scale == 1.0:
        return influences, ()
    by, cause = influences.parts[_cause_of(task)]
    assert cause.covariance is not None
    louder = (by, replace(cause, covariance=scale**2 * cause.covariance))
    worst = int(np.argmax(np.abs(off_pixels)))
    told = (
        f"{task.name}: the picks miss the {task.kind} by up to {abs(off_pixels[worst]):.1f} px "
        f"(pixels[{worst}]), {scale:.1f} times what {task.pick_sigma_pixels:g} px of pick noise "
        "explain; its error is stated as that much larger"
    )
    return replace(influences, parts={**influences.parts, _cause_of(task): louder}), (told,)


def _cause_of(task: Task) -> str:
    return f"picks of {task.name}"


def _refuse_outside(pixels: Array, camera: Camera, labels: Sequence[str]) -> None:
    size = np.array([camera.intrinsics.width, camera.intrinsics.height])
    outside = (pixels < -0.5 - OUTSIDE_SHARE * size) | (pixels > (1 + OUTSIDE_SHARE) * size - 0.5)
    for i in np.flatnonzero(outside.any(axis=1)):
        u, v = pixels[i]
        raise PickError(
            f"{labels[i]} at ({u:.1f}, {v:.1f}) lies more than half a picture outside the "
            f"{size[0]} x {size[1]} px picture; pick it again"
        )


def _refuse_twins(pixels: Array, labels: Sequence[str]) -> None:
    for i in range(1, len(pixels)):
        distances = np.linalg.norm(pixels[:i] - pixels[i], axis=1)
        j = int(np.argmin(distances))
        if distances[j] < LEAST_PIXELS:
            raise PickError(
                f"{labels[i]} is {distances[j]:.1f} px from pixels[{j}]: they are one place; "
                "pick them apart"
            )
