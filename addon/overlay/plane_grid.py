# SPDX-License-Identifier: GPL-3.0-or-later
"""The active reference as a grid on the picture: a plane and a camera in, lines of the view out."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...core.arrays import Array
from ...core.camera import Camera
from ...core.modelling.reverse_mapping import points_on_plane_or_nan
from ...core.reference import ReferencePlane

# so many looks across and down the picture find what is seen of the plane
LOOKS = (33, 25)
# a cell of the grid is about so wide in the middle of what is seen, as a share of the picture
CELL_SHARE = 1 / 28
# beyond so many times the middle distance the lines run together
FARTHEST = 2.0
MOST_LINES = 120
MAJOR = 5
# what of a line is nearer to the camera than this is left out, metres
NEAREST = 0.02


@dataclass(frozen=True, eq=False)
class PlaneGrid:
    """Lines (N, 2) in undistorted pixels, the fifth ones apart; `cell` is their distance, metres.

    The lines are those of the plane's own frame, `ReferencePlane.world_from_plane`.
    """

    fine: tuple[Array, ...]
    major: tuple[Array, ...]
    cell: float


def plane_grid(camera: Camera, plane: ReferencePlane) -> PlaneGrid | None:
    """The grid of what the camera sees of a plane; None where it sees nothing of it."""
    pinhole = replace(camera, intrinsics=camera.intrinsics.undistorted())
    seen, cell = _seen(pinhole, plane)
    if seen is None:
        return None
    low, high = np.floor(seen.min(axis=0) / cell), np.ceil(seen.max(axis=0) / cell)
    fine, major = [], []
    for axis in (0, 1):
        for step in np.arange(low[axis], high[axis] + 1):
            line = np.zeros((2, 3))
            line[:, axis] = step * cell
            line[:, 1 - axis] = low[1 - axis] * cell, high[1 - axis] * cell
            into = major if step % MAJOR == 0 else fine
            into += _clipped(pinhole, plane.world_from_plane.apply(line))
    return PlaneGrid(tuple(fine), tuple(major), cell)


def _seen(pinhole: Camera, plane: ReferencePlane) -> tuple[Array | None, float]:
    """Places (N, 2) on the plane that the picture shows, not too far away, and the cell's size."""
    width, height = pinhole.intrinsics.width, pinhole.intrinsics.height
    u, v = np.meshgrid(np.linspace(0, width - 1, LOOKS[0]), np.linspace(0, height - 1, LOOKS[1]))
    pixels = np.stack([u.ravel(), v.ravel()], axis=1)
    points = points_on_plane_or_nan(pinhole, plane, pixels)
    points = points[np.isfinite(points).all(axis=1)]
    if not len(points):
        return None, 0.0
    distances = np.linalg.norm(points - pinhole.centre_world, axis=1)
    middle = float(np.median(distances))
    near = points[distances <= FARTHEST * middle]
    places = plane.world_from_plane.inverse().apply(near)[:, :2]
    cell = _round(middle / pinhole.intrinsics.fx * width * CELL_SHARE)
    extent = float(np.ptp(places, axis=0).max())
    while extent / cell > MOST_LINES:
        cell = _round(2 * cell)
    return places, cell


def _round(length: float) -> float:
    """The nearest of 1, 2 and 5 times a power of ten."""
    power = 10.0 ** np.floor(np.log10(length))
    steps = np.array([1.0, 2.0, 5.0, 10.0])
    return float(power * steps[np.abs(np.log(steps * power / length)).argmin()])


def _clipped(pinhole: Camera, line_world: Array) -> list[Array]:
    """The part of a line (2, 3) that the picture shows, its ends (2, 2); none beside it."""
    ends = pinhole.pose.apply(line_world)
    if (ends[:, 2] <= NEAREST).all():
        return []
    if (ends[:, 2] <= NEAREST).any():
        # what is behind the camera is cut off where it passes it
        share = (NEAREST - ends[0, 2]) / (ends[1, 2] - ends[0, 2])
        ends[int(ends[1, 2] <= NEAREST)] = ends[0] + share * (ends[1] - ends[0])
        ends[:, 2] = np.maximum(ends[:, 2], NEAREST)
    first, last = pinhole.intrinsics.project(ends)
    inner = pinhole.intrinsics
    most = np.array([inner.width, inner.height]) - 0.5
    way = last - first
    with np.errstate(divide="ignore", invalid="ignore"):
        near, far = (-0.5 - first) / way, (most - first) / way
    # a line along a side is outside of it all along, or never
    along = way == 0
    if (along & ((first < -0.5) | (first > most))).any():
        return []
    enter = np.where(along, 0.0, np.minimum(near, far)).max(initial=0.0)
    leave = np.where(along, 1.0, np.maximum(near, far)).min(initial=1.0)
    return [first + np.outer([enter, leave], way)] if enter < leave else []
