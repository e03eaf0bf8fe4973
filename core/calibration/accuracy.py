# SPDX-License-Identifier: GPL-3.0-or-later
"""How accurate a calibration is, in millimetres where it counts: a calibrated cell in, the whole
report's numbers out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..cell import Cell
from ..errors import InvalidValue
from ..reference import ReferencePlane
from .advise import Advice, TypicalOutline, advise
from .calibrate import Calibration
from .ellipsoid import PoseError, pose_error
from .leave_one_out import LeftOut, leave_one_out, leverage_warnings
from .picture_span import PictureSpan, span_of
from .sigma_map import surface_sigma
from .work_surface import WorkArea, work_area

GRID = 5
FINE_GRID = (64, 48)


@dataclass(frozen=True, eq=False)
class SurfaceAccuracy:
    """1 sigma in metres of the points of `plane` that the picture shows, over all directions.

    - `at_work`: the middle one of the points in `area`, where accuracy counts
    - `at_centre` of the picture; `median` and `worst` of what is seen of the plane at more than two
      degrees; `seen`: which share of the picture that is
    - `grid` (5, 5): at `grid_pixels` (5, 5, 2), the middles of the picture's fields; NaN where
      nothing of the plane is seen
    """

    plane: ReferencePlane
    area: WorkArea
    at_work: float
    at_centre: float
    median: float
    worst: float
    seen: float
    grid: Array
    grid_pixels: Array


@dataclass(frozen=True, eq=False)
class Accuracy:
    """How well the camera's pose is known, and what it hangs on.

    `error` and `surface` are None where nothing is known of the error (a baseline's) or the picture
    shows nothing of the surface. `without`: one a sighting of the cell, None for those not used
    and for those without which nothing holds the pose.
    """

    error: PoseError | None
    span: PictureSpan
    surface: SurfaceAccuracy | None
    without: tuple[LeftOut | None, ...]
    warnings: tuple[str, ...]


def accuracy_of(cell: Cell, calibration: Calibration, plane: ReferencePlane) -> Accuracy:
    """The numbers of the report for a cell that `calibrate_cell` has returned."""
    fit, used = calibration.fit, calibration.used_indices
    error = pose_error(calibration.camera, fit)
    changes = leave_one_out(fit)
    without: list[LeftOut | None] = [None] * len(calibration.sightings)
    for index, change in zip(used, changes, strict=True):
        without[index] = change
    warnings: tuple[str, ...] = ()
    if error is not None:
        warnings = leverage_warnings(_names(calibration, used), changes, error.position_total)
    surface = None if error is None else surface_accuracy(cell, calibration, plane)
    centres_camera = fit.camera_from_base.apply(fit.places_base)
    span = span_of(calibration.camera.intrinsics, centres_camera)
    return Accuracy(error, span, surface, tuple(without), warnings)


def surface_accuracy(
    cell: Cell, calibration: Calibration, plane: ReferencePlane
) -> SurfaceAccuracy | None:
    """How well points of a plane are known; None where the picture shows nothing of it.

    Raises NoPose for a baseline's pose, which has no covariance.
    """
    camera = calibration.camera
    inner = camera.intrinsics
    fine = surface_sigma(camera, plane, _middles(inner.width, inner.height, *FINE_GRID))
    area = work_area(cell, camera, plane)
    if area is None or camera.covariance is None or np.isnan(fine).all():
        return None
    pixels = _middles(inner.width, inner.height, GRID, GRID)
    middle = np.array([[(inner.width - 1) / 2, (inner.height - 1) / 2]])
    return SurfaceAccuracy(
        plane,
        area,
        float(area.sigmas(camera.covariance[None])[0]),
        float(surface_sigma(camera, plane, middle)[0]),
        float(np.nanmedian(fine)),
        float(np.nanmax(fine)),
        float(np.isfinite(fine).mean()),
        surface_sigma(camera, plane, pixels).reshape(GRID, GRID),
        pixels.reshape(GRID, GRID, 2),
    )


def advised(calibration: Calibration, area: WorkArea, candidates_world: Array) -> Advice:
    """Which of candidate positions (N, 3) lower the error in `area` most.

    Raises InvalidValue when none of them can be seen well, when there are only points, and for an
    offset or a camera on the flange.
    """
    reports = [calibration.sightings[i] for i in calibration.used_indices]
    outlines = [r.outline for r in reports if r.outline is not None]
    if not outlines:
        raise InvalidValue("advice needs at least one ball: points tell nothing of its outline")
    grown = next((one.factor for one in calibration.fit.refined if one.name == "radius"), 1.0)
    typical = TypicalOutline.of(outlines, grown)
    places = np.array([report.center_world for report in reports])
    return advise(calibration.camera, calibration.fit, area, typical, candidates_world, places)


def _names(calibration: Calibration, used: tuple[int, ...]) -> list[str]:
    """The pictures' names; with the ball's place where one picture shows several."""
    pictures = [report.picture for report in calibration.sightings]
    return [
        f"{pictures[i]} at {calibration.sightings[i].center_world.round(3).tolist()}"
        if pictures.count(pictures[i]) > 1
        else pictures[i]
        for i in used
    ]


def _middles(width: int, height: int, columns: int, rows: int) -> Array:
    """The middles (columns * rows, 2) of equal fields of a picture, row by row."""
    u = (np.arange(columns) + 0.5) / columns * width - 0.5
    v = (np.arange(rows) + 0.5) / rows * height - 0.5
    grid_u, grid_v = np.meshgrid(u, v)
    return np.stack([grid_u.ravel(), grid_v.ravel()], axis=1)
