# SPDX-License-Identifier: GPL-3.0-or-later
"""Calibration from sightings: a cell with pictures in, the camera's pose and a report out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from ..ball.outline import SphereOutline
from ..camera import Camera
from ..cell import Cell
from ..errors import MonocellError, NotConverged
from ..mount import Mount
from ..picture.shelf import PictureShelf
from ..sighting import Sighting, SphereSighting
from .looking import Failures, Outlines, look_again, look_for_all, look_for_each
from .result import METHODS, Calibration, Method
from .solution import Problem, Solution
from .twins import has_twins
from .unknowns import REFINABLE, Refinable

__all__ = [
    "METHODS",
    "REFINABLE",
    "Calibration",
    "Method",
    "Refinable",
    "calibrate_cell",
    "calibrate_outlines",
]


def calibrate_cell(
    cell: Cell,
    method: Method = "joint",
    refine: Sequence[Refinable] = (),
    watch: Callable[[str], None] | None = None,
) -> tuple[Cell, Calibration]:
    """Find the balls in the cell's pictures and the camera's pose from them and from its points.

    A ball that is not found where it was looked for, or that does not fit the others, is looked for
    again where the others put it. Sightings that are not in use are left out; the calibration's
    `sightings` are the others, in order. With `refine` the cell gets its focal lengths or radius
    too. `watch` is told each picture's name as it is looked at; what it raises ends the work.

    Raises TooFewSightings and DegeneratePositions for positions that can't hold a pose,
    PictureError, SphereNotFound when fewer balls are found than make a pose, NotConverged when too
    few fit together, AmbiguousPose when several poses fit, NotObservable for what can't be refined.
    """
    used = cell.in_use()
    problem = Problem.of_cell(used, method, tuple(refine))
    shelf = PictureShelf(used, watch)
    shelf.check_there([s.picture for s in used.sightings if isinstance(s, SphereSighting)])
    calibration = _calibrated(used, problem, shelf)
    calibration = replace(calibration, warnings=(*calibration.warnings, *shelf.told))
    return _with_result(cell, calibration), calibration


def calibrate_outlines(
    camera: Camera,
    sightings: Sequence[Sighting],
    outlines: Sequence[SphereOutline | None],
    method: Method = "joint",
    refine: Sequence[Refinable] = (),
    mount: Mount | None = None,
) -> Calibration:
    """The pose from outlines already measured, None where a ball was not found and for points.

    Raises as `calibrate_cell` does.
    """
    problem = Problem.of_cell(
        Cell(camera, sightings=tuple(sightings), mount=mount), method, tuple(refine)
    )
    missing = [
        i
        for i, (sighting, outline) in enumerate(zip(sightings, outlines, strict=True))
        if outline is None and isinstance(sighting, SphereSighting)
    ]
    return problem.solved(list(outlines), dict.fromkeys(missing, "not found")).calibration


def _calibrated(cell: Cell, problem: Problem, shelf: PictureShelf) -> Calibration:
    """What was found and chosen as the lens and radius are stated, and then refined."""
    solution, outlines, failures = _as_stated(cell, problem.unrefined(), shelf)
    if problem.refine:
        solution = problem.solved(outlines, failures)
    return solution.calibration


def _as_stated(
    cell: Cell, problem: Problem, shelf: PictureShelf
) -> tuple[Solution, Outlines, Failures]:
    outlines, failures = look_for_each(cell, shelf)
    solution = None
    if not has_twins(cell.sightings, outlines, problem.duplicates):
        try:
            solution = problem.solved(outlines, failures)
        except NotConverged:
            solution = None
    if solution is None or solution.calibration.verdict == "failed":
        solution, outlines, failures = _by_choice(cell, problem, shelf, outlines, failures)
    wanted = solution.expected_again(problem.duplicates)
    if wanted and (again := look_again(cell, shelf, wanted)):
        mended = [again.get(i, outline) for i, outline in enumerate(outlines)]
        if not has_twins(cell.sightings, mended, problem.duplicates):
            failures = {i: why for i, why in failures.items() if i not in again}
            outlines = mended
            solution = problem.solved(outlines, failures)
    return _measured_closely(cell, problem, shelf, solution, outlines, failures)


def _measured_closely(
    cell: Cell,
    problem: Problem,
    shelf: PictureShelf,
    solution: Solution,
    outlines: Outlines,
    failures: Failures,
) -> tuple[Solution, Outlines, Failures]:
    """The pose from outlines measured where all sightings together have them.

    What hides a part of one ball pulls its outline less when its place is known. The pose stays as
    it was where the closer look is not believed as much.
    """
    before = solution, outlines, failures
    closer = look_again(cell, shelf, solution.expected_everywhere(problem.duplicates), closely=True)
    outlines = [closer.get(i, outline) for i, outline in enumerate(outlines)]
    failures = {i: why for i, why in failures.items() if i not in closer}
    if not closer or has_twins(cell.sightings, outlines, problem.duplicates):
        return before
    try:
        closely = problem.solved(outlines, failures)
    except MonocellError:
        return before
    worse = closely.calibration.count_used < solution.calibration.count_used
    if worse or closely.calibration.verdict == "failed":
        return before
    return closely, outlines, failures


def _by_choice(
    cell: Cell, problem: Problem, shelf: PictureShelf, outlines: Outlines, failures: Failures
) -> tuple[Solution, Outlines, Failures]:
    """Solve with those of all candidates that fit together, where the best of each did not.

    What is chosen takes the place of what was found, unless too little fits.
    """
    chosen, reasons = look_for_all(cell, shelf, problem.places)
    if problem.enough(chosen):
        outlines = chosen
        failures = {i: failures.get(i, why) for i, why in reasons.items()}
    return problem.solved(outlines, failures), outlines, failures


def _with_result(cell: Cell, calibration: Calibration) -> Cell:
    """The cell with what the calibration found: pose or mount, and what was refined."""
    factors = {refined.name: refined.factor for refined in calibration.refined}
    if "radius" in factors:
        sightings = tuple(
            replace(s, radius=s.radius * factors["radius"]) if isinstance(s, SphereSighting) else s
            for s in cell.sightings
        )
        cell = replace(cell, sightings=sightings)
    if calibration.mount is None:
        return cell.with_camera(calibration.camera)
    return cell.with_camera(calibration.camera).with_mount(calibration.mount)
