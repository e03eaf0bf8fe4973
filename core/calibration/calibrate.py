# SPDX-License-Identifier: GPL-3.0-or-later
"""Calibration from ball sightings: a cell with pictures in, the camera's pose and a report out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from ..ball.outline import SphereOutline
from ..camera import Camera
from ..cell import Cell
from ..errors import InvalidValue, MonocellError, NotConverged, SphereNotFound
from ..intrinsics import Intrinsics
from ..picture.pictures import Picture, read_picture
from ..pose import Pose
from ..sighting import SphereSighting
from .baselines import PoseCandidate, baseline_poses
from .joint_pose import JointFit
from .pose_search import ConsistentFit, SeenBall, fit_consistent
from .position_geometry import PositionGeometry, check_positions
from .sighting_report import SightingReport, robust_rms, sighting_reports
from .verdict import Verdict, verdict_of

METHODS = ("joint", "frames", "p3p", "pnp")
Method = Literal["joint", "frames", "p3p", "pnp"]


@dataclass(frozen=True, eq=False)
class Calibration:
    """A calibrated camera, and how far to believe it.

    `misfit` is the factor by which the sightings disagree beyond their own noise (1: not at all);
    the covariance already carries it. `verdict` is good, weak or failed, `warnings` say why.
    For a baseline, `candidates` are all its answers, the closest first, and `camera` stands at
    that; all else is of the joint fit that it is held against. `fit` is that fit, of the sightings
    `used_indices`, in its order.
    """

    camera: Camera
    method: str
    verdict: Verdict
    warnings: tuple[str, ...]
    sightings: tuple[SightingReport, ...]
    geometry: PositionGeometry
    rms_pixels: float
    edge_bias_pixels: float
    edge_bias_sigma_pixels: float
    misfit: float
    fit: JointFit
    used_indices: tuple[int, ...]
    candidates: tuple[PoseCandidate, ...] = ()

    @property
    def count_used(self) -> int:
        return sum(report.status != "rejected" for report in self.sightings)


def calibrate_cell(cell: Cell, method: Method = "joint") -> tuple[Cell, Calibration]:
    """Find the balls in the cell's pictures and the camera's pose from them.

    A ball that is not found where it was looked for, or that does not fit the others, is looked for
    again where the others put it.

    Raises TooFewSightings and DegeneratePositions for positions that can't hold a pose,
    PictureError, SphereNotFound when fewer than three balls are found, NotConverged when no three
    of them fit together.
    """
    check_positions([s.center_world for s in cell.sightings])
    pictures = {s.picture: _read(cell, s.picture) for s in cell.sightings}
    return _calibrated(cell, pictures, method)


def calibrate_outlines(
    camera: Camera,
    sightings: Sequence[SphereSighting],
    outlines: Sequence[SphereOutline | None],
    method: Method = "joint",
) -> Calibration:
    """The pose from outlines already measured, None where a ball was not found.

    Raises as `calibrate_cell` does.
    """
    failures = {i: "not found" for i, outline in enumerate(outlines) if outline is None}
    return _solve(camera, sightings, list(outlines), failures, method)[0]


def _calibrated(
    cell: Cell, pictures: dict[str, Picture], method: Method
) -> tuple[Cell, Calibration]:
    from ..ball.find import find_sphere

    intrinsics = cell.camera.intrinsics
    outlines: list[SphereOutline | None] = []
    failures: dict[int, str] = {}
    for i, sighting in enumerate(cell.sightings):
        try:
            picture = pictures[sighting.picture]
            outlines.append(find_sphere(picture, intrinsics, sighting.radius, sighting.window))
        except SphereNotFound as error:
            outlines.append(None)
            failures[i] = str(error)
    try:
        calibration, pose = _solve(cell.camera, cell.sightings, outlines, failures, method)
    except NotConverged:
        calibration, pose = _solved_by_choice(cell, pictures, outlines, failures, method)
    if calibration.verdict == "failed":
        calibration, pose = _solved_by_choice(cell, pictures, outlines, failures, method)
    again = _looked_for_again(calibration, pose, cell.sightings, pictures, intrinsics)
    if again:
        for i, outline in again.items():
            outlines[i] = outline
            failures.pop(i, None)
        calibration, _ = _solve(cell.camera, cell.sightings, outlines, failures, method)
    return cell.with_camera(calibration.camera), calibration


def _solved_by_choice(
    cell: Cell,
    pictures: dict[str, Picture],
    outlines: list[SphereOutline | None],
    failures: dict[int, str],
    method: Method,
) -> tuple[Calibration, Pose]:
    """Solve with those of all candidates that fit together, where the best of each did not.

    What is chosen takes the place of what was found, unless too little fits.
    """
    from ..ball.find import find_spheres
    from .candidate_choice import choose_candidates

    candidates: list[tuple[SphereOutline, ...]] = []
    for sighting in cell.sightings:
        try:
            picture = pictures[sighting.picture]
            candidates.append(
                find_spheres(picture, cell.camera.intrinsics, sighting.radius, sighting.window)
            )
        except SphereNotFound:
            candidates.append(())
    places = np.array([sighting.center_world for sighting in cell.sightings])
    chosen = choose_candidates(places, candidates)
    if sum(outline is not None for outline in chosen) >= 3:
        outlines[:] = chosen
        for i, outline in enumerate(chosen):
            if outline is None:
                failures.setdefault(i, "what was found does not fit the others")
            else:
                failures.pop(i, None)
    return _solve(cell.camera, cell.sightings, outlines, failures, method)


def _read(cell: Cell, picture: str) -> Picture:
    return read_picture(cell.path_of(picture), cell.camera.intrinsics)


def _looked_for_again(
    calibration: Calibration,
    pose: Pose,
    sightings: Sequence[SphereSighting],
    pictures: dict[str, Picture],
    intrinsics: Intrinsics,
) -> dict[int, SphereOutline]:
    """Outlines of rejected sightings, found where the pose puts them."""
    from ..ball.find import measure_sphere

    found: dict[int, SphereOutline] = {}
    if calibration.verdict == "failed":
        return found
    for i, (report, sighting) in enumerate(zip(calibration.sightings, sightings, strict=True)):
        if report.status != "rejected":
            continue
        try:
            rough = pose.apply(sighting.center_world)
            picture = pictures[sighting.picture]
            found[i] = measure_sphere(picture, intrinsics, sighting.radius, rough)
        except MonocellError:
            # the first refusal stands, and says more
            continue
    return found


def _solve(
    camera: Camera,
    sightings: Sequence[SphereSighting],
    outlines: Sequence[SphereOutline | None],
    failures: dict[int, str],
    method: Method,
) -> tuple[Calibration, Pose]:
    if method not in METHODS:
        raise InvalidValue(f"method: {method!r} is none of {', '.join(METHODS)}")
    found = [i for i, outline in enumerate(outlines) if outline is not None]
    if len(found) < 3:
        _refuse_too_few_found(sightings, failures, len(found))
    check_positions([sightings[i].center_world for i in found])
    balls = [
        SeenBall.of(sighting.center_world, outline, camera.intrinsics)
        for sighting, outline in zip(sightings, outlines, strict=True)
        if outline is not None
    ]
    consistent = fit_consistent(balls)
    geometry = check_positions(
        [ball.centre_world for ball, use in zip(balls, consistent.used, strict=True) if use]
    )
    reports = sighting_reports(sightings, outlines, failures, found, consistent)
    joint = camera.placed(consistent.fit.camera_from_base, consistent.fit.covariance)
    used_indices = tuple(i for i, use in zip(found, consistent.used, strict=True) if use)
    calibration = _calibration(joint, method, reports, geometry, consistent, used_indices)
    if method != "joint":
        used = [ball for ball, use in zip(balls, consistent.used, strict=True) if use]
        candidates = baseline_poses(method, used)
        baseline = camera.placed(candidates[0].camera_from_world)
        calibration = replace(calibration, camera=baseline, candidates=candidates)
    return calibration, joint.pose


def _refuse_too_few_found(
    sightings: Sequence[SphereSighting], failures: dict[int, str], found: int
) -> None:
    first = min(failures)
    raise SphereNotFound(
        f"the ball was found in {found} of {len(sightings)} sightings, three are needed; "
        f"{sightings[first].picture}: {failures[first]}"
    )


def _calibration(
    camera: Camera,
    method: str,
    reports: tuple[SightingReport, ...],
    geometry: PositionGeometry,
    consistent: ConsistentFit,
    used_indices: tuple[int, ...],
) -> Calibration:
    fit = consistent.fit
    left = np.concatenate(fit.residuals_pixels)
    if not np.isfinite(left).all():
        raise NotConverged(
            "the joint fit left the pictures; check intrinsics, radius and positions"
        )
    verdict, warnings = verdict_of(camera, fit, geometry, [(r.status, r.reason) for r in reports])
    return Calibration(
        camera,
        method,
        verdict,
        (*geometry.warnings(), *warnings),
        reports,
        geometry,
        robust_rms(left),
        fit.edge_bias_pixels,
        fit.edge_bias_sigma_pixels,
        fit.misfit,
        fit,
        used_indices,
    )
