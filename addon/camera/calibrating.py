# SPDX-License-Identifier: GPL-3.0-or-later
"""Finding and calibrating without Blender: a cell in, a cell and the report to keep out.

Both run in a thread of their own, and tell `watch` each picture they look at.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ...core.calibration.calibrate import Calibration, calibrate_cell
from ...core.calibration.looking import look_for_each
from ...core.cell import Cell
from ...core.errors import InvalidValue
from ...core.picture.shelf import PictureShelf
from ...core.sighting import PointSighting, SphereSighting
from .report import NOT_LOOKED, AdvisedPlace, Report, SeenSighting, ball_of, seen_of

Watch = Callable[[str], None]
# a calibration looks at every picture twice: anywhere, then closely where the pose has the ball
LOOKS = 2


def calibrated(cell: Cell, watch: Watch | None = None) -> tuple[Cell, Report]:
    """The cell with its camera's pose, and the report; the cell as given where that failed.

    Raises what `calibrate_cell` raises.
    """
    solved, calibration = calibrate_cell(cell, watch=watch)
    failed = calibration.verdict == "failed"
    warnings, surface, advice = calibration.warnings, ("", None), ()
    if not failed:
        more, surface, advice = _accuracy(solved, calibration)
        warnings = (*warnings, *more)
    report = Report(
        calibration.verdict,
        tuple(warnings),
        float(calibration.rms_pixels),
        float(calibration.edge_bias_pixels),
        _every(cell, [seen_of(one) for one in calibration.sightings]),
        surface[0],
        advice,
        surface_millimetres=surface[1],
    )
    # a pose that can't be trusted is reported, with every outline, but nothing is built on it
    return (cell if failed else solved), report


def found(cell: Cell, watch: Watch | None = None) -> Report:
    """Where the balls are that stand out, without asking whether they fit together."""
    used = cell.in_use()
    shelf = PictureShelf(used, watch)
    shelf.check_there([s.picture for s in used.sightings if isinstance(s, SphereSighting)])
    outlines, failures = look_for_each(used, shelf)
    rows = [
        SeenSighting("found", "; ".join(outline.warnings), None, ball_of(outline))
        if outline is not None
        else SeenSighting(*NOT_LOOKED)
        if isinstance(sighting, PointSighting)
        else SeenSighting("rejected", failures[i], None, None)
        for i, (sighting, outline) in enumerate(zip(used.sightings, outlines, strict=True))
    ]
    return Report("", shelf.told, None, None, _every(cell, rows))


def _every(cell: Cell, rows: list[SeenSighting]) -> tuple[SeenSighting, ...]:
    """The rows of those in use, and between them those that are not."""
    rest = iter(rows)
    return tuple(next(rest) if s.use else SeenSighting(*NOT_LOOKED) for s in cell.sightings)


def _accuracy(
    cell: Cell, calibration: Calibration
) -> tuple[tuple[str, ...], tuple[str, float | None], tuple[AdvisedPlace, ...]]:
    """Further warnings, how well a point worked at is known, and where to hold the ball next."""
    from ...core.calibration.accuracy import accuracy_of, advised
    from ...core.calibration.advise import positions_in_box, reachable_box
    from ...core.calibration.work_surface import surface_of

    accuracy = accuracy_of(cell, calibration, surface_of(cell))
    surface = accuracy.surface
    if surface is None:
        return accuracy.warnings, ("", None), ()
    said = (surface.plane.name, 1e3 * surface.at_work)
    try:
        box = positions_in_box(reachable_box(calibration.fit.places_base))
        steps = advised(calibration, surface.area, box).steps
    except InvalidValue:
        # balls on a carried or unknown place have no positions to choose from
        return accuracy.warnings, said, ()
    return accuracy.warnings, said, tuple(_place(step) for step in steps)


def _place(step: Any) -> AdvisedPlace:
    x, y, z = (float(value) for value in step.position_world)
    u, v = (float(value) for value in step.pixel)
    return AdvisedPlace((x, y, z), (u, v), float(step.radius_pixels), 1e3 * float(step.sigma))
