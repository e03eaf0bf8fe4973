# SPDX-License-Identifier: GPL-3.0-or-later
"""A solid and a camera in, places along its visible edges in the picture with derivatives out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, Mask
from ..camera import Camera
from ..modelling.solid import Solid
from ..pose import point_jacobian
from ..rotation import hat
from ..shape.curve_set import CurveSet
from ..shape.curves import curves

# between samples, and how much of each end of an edge is left out: another edge begins there
SPACING_PIXELS, END_PIXELS = 2.0, 3.0
MOST, PROBES = 60, 9
# an edge shorter than this in the picture tells nothing
SHORTEST_PIXELS = 7.0


@dataclass(frozen=True, eq=False)
class CurveSamples:
    """N places on visible edges, in order along each.

    `pixels` and unit `normals` (N, 2), outwards where the edge is of the outline; `curve` (N,) the
    number of its edge, `names` those of the edges, `outline` (N,). A motion of the solid or of the
    camera moves the edge along the normal by `by_object` (N, 6 + P) and `by_camera` (N, 6).
    `spacing` (N,) is how much of the edge each place stands for, in pixels.
    """

    pixels: Array
    normals: Array
    curve: NDArray[np.intp]
    names: tuple[str, ...]
    outline: Mask
    by_object: Array
    by_camera: Array
    spacing: Array

    def __len__(self) -> int:
        return len(self.pixels)

    def chosen(self, rows: Mask) -> CurveSamples:
        """The samples of a mask (N,)."""
        return CurveSamples(
            self.pixels[rows],
            self.normals[rows],
            self.curve[rows],
            self.names,
            self.outline[rows],
            self.by_object[rows],
            self.by_camera[rows],
            self.spacing[rows],
        )


def curve_samples(solid: Solid, camera: Camera) -> CurveSamples:
    """Samples of all edges that the solid itself does not hide and that lie in the picture."""
    every = curves(solid.kind, solid.parameters, solid.eye(camera.centre_world))
    seen = every.chosen(np.flatnonzero(every.visible))
    curve, t, spacing = _places(seen, solid, camera)
    local, tangent = _at(seen, curve, t)
    arms = local @ solid.rotation.T
    points_camera = camera.pose.apply(arms + solid.place)
    pixels, by_point = camera.intrinsics.project_with_jacobian(points_camera)
    along = _applied(by_point @ camera.pose.rotation @ solid.rotation, tangent)
    normals = _outward(pixels, along, solid, camera)
    across = normals[:, None, :] @ by_point
    by_world = across @ camera.pose.rotation
    by_shape = solid.rotation @ _points_by(seen, curve, t)
    moved = np.concatenate([-hat(arms), np.broadcast_to(np.eye(3), (len(arms), 3, 3)), by_shape], 2)
    samples = CurveSamples(
        pixels,
        normals,
        curve,
        seen.names,
        seen.outline[curve],
        (by_world @ moved)[:, 0],
        (across @ point_jacobian(points_camera))[:, 0],
        spacing,
    )
    good = np.isfinite(samples.by_object).all(axis=1) & np.isfinite(pixels).all(axis=1)
    return samples.chosen(good & camera.intrinsics.contains(np.nan_to_num(pixels, nan=-9.0)))


def _places(seen: CurveSet, solid: Solid, camera: Camera) -> tuple[NDArray[np.intp], Array, Array]:
    """The curve (N,) and parameter (N,) of each sample, about equally far apart, and how far."""
    share = np.linspace(0, 1, PROBES)[:, None]
    t = seen.ends[:, 0] + share * (seen.ends[:, 1] - seen.ends[:, 0])
    world = seen.points(t) @ solid.rotation.T + solid.place
    pixels = camera.project(world.reshape(-1, 3)).reshape(*t.shape, 2)
    steps = np.linalg.norm(np.diff(pixels, axis=0), axis=2)
    reached = np.concatenate([np.zeros((1, len(seen))), steps.cumsum(axis=0)])
    curve, place, spacing = [], [], []
    for i, length in enumerate(reached[-1]):
        if not SHORTEST_PIXELS <= length < 1e5:
            continue
        closed = seen.round[i] and np.ptp(seen.ends[i]) > 2 * np.pi - 1e-6
        end = 0.0 if closed else END_PIXELS
        count = int(np.clip((length - 2 * end) / SPACING_PIXELS, 2, MOST))
        wanted = end + (np.arange(count) + 0.5) / count * (length - 2 * end)
        curve.append(np.full(count, i))
        place.append(np.interp(wanted, reached[:, i], t[:, i]))
        spacing.append(np.full(count, length / count))
    if not curve:
        return np.zeros(0, dtype=np.intp), np.zeros(0), np.zeros(0)
    return np.concatenate(curve), np.concatenate(place), np.concatenate(spacing)


def _at(seen: CurveSet, curve: NDArray[np.intp], t: Array) -> tuple[Array, Array]:
    """Points and tangents (N, 3) of curves (N,) at parameters (N,)."""
    f, g = _factors(seen, curve, t)
    first, second = seen.first[curve], seen.second[curve]
    turning = seen.round[curve][:, None]
    tangent = np.where(turning, f * second - g * first, first)
    return seen.origin[curve] + f * first + g * second, tangent


def _points_by(seen: CurveSet, curve: NDArray[np.intp], t: Array) -> Array:
    f, g = _factors(seen, curve, t)
    by: Array = (
        seen.origin_by[curve]
        + f[:, None] * seen.first_by[curve]
        + g[:, None] * seen.second_by[curve]
    )
    return by


def _factors(seen: CurveSet, curve: NDArray[np.intp], t: Array) -> tuple[Array, Array]:
    turning = seen.round[curve]
    f, g = np.where(turning, np.cos(t), t), np.where(turning, np.sin(t), 0.0)
    return f[:, None], g[:, None]


def _outward(pixels: Array, along: Array, solid: Solid, camera: Camera) -> Array:
    """Unit normals (N, 2) that point away from the middle of the solid."""
    across = np.stack([along[:, 1], -along[:, 0]], axis=1)
    across /= np.maximum(np.linalg.norm(across, axis=1), 1e-12)[:, None]
    middle = camera.project(solid.place[None])[0]
    away = ((pixels - middle) * across).sum(axis=1)
    return across * np.where(away < 0, -1.0, 1.0)[:, None]


def _applied(matrices: Array, vectors: Array) -> Array:
    product: Array = (matrices @ vectors[:, :, None])[:, :, 0]
    return product
