# SPDX-License-Identifier: GPL-3.0-or-later
"""The report of a calibration for a person: its numbers in, lines of at most 100 characters out."""

from __future__ import annotations

import textwrap
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..core.arrays import Array
from ..core.calibration.accuracy import Accuracy
from ..core.calibration.advise import Advice
from ..core.calibration.calibrate import Calibration
from ..core.calibration.ellipsoid import Ellipsoid, PoseError
from ..core.calibration.leave_one_out import LeftOut
from ..core.calibration.sighting_report import SightingReport
from .calibration_unknowns import unknowns_told
from .told import point_told, table

WIDTH, INDENT, LONGEST_NAME = 100, 11, 30
# more sightings than this are not all listed for a person
MOST_LISTED = 12


@dataclass(frozen=True, eq=False)
class Report:
    """All that is told of a calibration; `surface_name` is the surface asked for."""

    calibration: Calibration
    accuracy: Accuracy
    surface_name: str
    advice: Advice | None = None

    @property
    def warnings(self) -> tuple[str, ...]:
        return (*self.calibration.warnings, *self.accuracy.warnings)


def tell(report: Report) -> None:
    """Print it."""
    for name, lines in _sections(report):
        for i, line in enumerate(lines):
            print(f"{(name if i == 0 else '').ljust(INDENT)}{line}")
    print()
    _tell_sightings(report)
    if report.advice is not None:
        print()
        _tell_advice(report.advice)
    print()
    print(f"verdict   {report.calibration.verdict}")


def _sections(report: Report) -> list[tuple[str, list[str]]]:
    calibration, error = report.calibration, report.accuracy.error
    sections = [("camera", [f"at {point_told(calibration.camera.centre_world)}"])]
    if error is None:
        sections.append(("1 sigma", _baseline(calibration)))
    else:
        sections += [("position", _position(error)), ("rotation", _rotation(error))]
        sections.append(("surface", _surface_told(report)))
    sections.append(("positions", _geometry(report)))
    bias = f"{calibration.edge_bias_pixels:+.3f} ± {calibration.edge_bias_sigma_pixels:.3f} px"
    sections.append(("outlines", [f"{calibration.rms_pixels:.2f} px rms, edge bias {bias}"]))
    for line in unknowns_told(calibration):
        name, said = line.split(maxsplit=1)
        sections.append((name, textwrap.wrap(said, WIDTH - INDENT)))
    return sections


def _baseline(calibration: Calibration) -> list[str]:
    lines = [f"unknown: the baseline {calibration.method} states none"]
    for candidate in calibration.candidates:
        centre = candidate.camera_from_base.inverse().translation
        lines.append(f"candidate {point_told(centre)}, balls {candidate.off_pixels:.2f} px off")
    return [*lines, "what follows is of the joint fit that the baseline is held against"]


def _position(error: PoseError) -> list[str]:
    axes = ", ".join(_mm(s) for s in error.position_sigma)
    reach = " x ".join(_mm(s) for s in error.position.semi_axes)
    return [
        f"± {_mm(error.position_total)} mm, 1 sigma ({axes} along x, y, z)",
        f"95 % within ± {reach} mm, most along {_direction(error.position)}",
    ]


def _rotation(error: PoseError) -> list[str]:
    axes = ", ".join(f"{np.degrees(s):.3f}" for s in error.rotation_sigma)
    reach = " x ".join(f"{np.degrees(s):.3f}" for s in error.rotation.semi_axes)
    return [
        f"± {np.degrees(error.rotation_total):.3f} deg, 1 sigma ({axes} about the camera's x, y, "
        "z)",
        f"95 % within ± {reach} deg, most about {_direction(error.rotation)}",
    ]


def _direction(shape: Ellipsoid) -> str:
    return "(" + ", ".join(f"{v:.2f}" for v in shape.directions[0]) + ")"


def _surface_told(report: Report) -> list[str]:
    surface = report.accuracy.surface
    if surface is None:
        return [f"the picture shows nothing of {report.surface_name}; --surface names another"]
    name, area = surface.plane.name, surface.area
    lines = textwrap.wrap(
        f"a point on {name} is known to {_mm(surface.at_work)} mm {area.told}; "
        f"{_mm(surface.at_centre)} at the picture's centre (1 sigma)",
        WIDTH - INDENT,
    )
    chosen = [0, surface.grid.shape[0] // 2, surface.grid.shape[0] - 1]
    rows = [[_mm(surface.grid[i, j]) for j in chosen] for i in chosen]
    width = max(len(cell) for row in rows for cell in row)
    grid = ["   ".join(cell.rjust(width) for cell in row) for row in rows]
    return [*lines, "over the picture, mm:  " + grid[0], *(" " * 23 + row for row in grid[1:])]


def _geometry(report: Report) -> list[str]:
    geometry, span = report.calibration.geometry, report.accuracy.span
    return [
        f"{geometry.count} used, {1e3 * geometry.length:.0f} mm long, "
        f"{1e3 * geometry.off_line:.0f} mm off a line, {1e3 * geometry.off_plane:.0f} mm off a "
        "plane",
        f"over {100 * span.share:.0f} % of the picture ({100 * span.width_share:.0f} % of its "
        f"width, {100 * span.height_share:.0f} % of its height), {span.nearest:.2f} to "
        f"{span.farthest:.2f} m away",
    ]


def _tell_sightings(report: Report) -> None:
    sightings = report.calibration.sightings
    listed = _listed(sightings, report.accuracy.without)
    rows = [_row(sightings[i], report.accuracy.without[i]) for i in listed]
    header = ("sighting", "status", "rms px", "off px", "off mm", "moves mm", "turns deg", "sigmas")
    print(table(header, rows))
    if len(listed) < len(sightings):
        print(_unlisted(sightings, listed))
    print("moves, turns, sigmas: what leaving the sighting out does to the camera")
    for i in listed:
        if sightings[i].reason:
            said = f"{_short(sightings[i].picture)}: {sightings[i].reason}"
            print("\n".join(textwrap.wrap(said, WIDTH, subsequent_indent="    ")))


def _listed(sightings: Sequence[SightingReport], without: Sequence[LeftOut | None]) -> list[int]:
    """Those a person should look at first, at least half of them used, in the document's order."""
    odd = [i for i, one in enumerate(sightings) if one.status != "used"]
    used = [i for i, one in enumerate(sightings) if one.status == "used"]
    used.sort(key=lambda i: -_sigmas(without[i]))
    few = max(MOST_LISTED // 2, MOST_LISTED - len(used))
    return sorted([*odd[:few], *used[: MOST_LISTED - len(odd[:few])]])


def _unlisted(sightings: Sequence[SightingReport], listed: Sequence[int]) -> str:
    """How many more there are of each status."""
    rest = Counter(one.status for i, one in enumerate(sightings) if i not in set(listed))
    counted = ", ".join(f"{count} {status}" for status, count in rest.most_common())
    return f"and {rest.total()} more: {counted}; --json has all"


def _sigmas(change: LeftOut | None) -> float:
    return np.inf if change is None else change.sigmas


def _row(one: SightingReport, without: LeftOut | None) -> tuple[str, ...]:
    left_out = ("-", "-", "-")
    if without is not None:
        left_out = (_mm(without.moves), f"{np.degrees(without.turn):.3f}", f"{without.sigmas:.1f}")
    numbers = (one.rms_pixels, one.off_pixels, one.off_millimetres)
    return (_short(one.picture), one.status, *(_number(n) for n in numbers), *left_out)


def _tell_advice(advice: Advice) -> None:
    first, *later = advice.steps
    said = (
        f"next: hold the ball at {_place(first.position_world)}: a point on "
        f"{advice.area.plane.name} is then known to {_mm(first.sigma)} mm instead of "
        f"{_mm(advice.sigma)}"
    )
    print("\n".join(textwrap.wrap(said, WIDTH, subsequent_indent="      ")))
    for step in later:
        print(f"then: at {_place(step.position_world)}: {_mm(step.sigma)} mm")
    print(
        f"of {advice.tried} positions the camera sees {advice.usable} well; whether the arm "
        "reaches them is yours to say"
    )


def _place(position: Array) -> str:
    return "(" + ", ".join(f"{v:.3f}" for v in position) + ")"


def _short(name: str) -> str:
    return name if len(name) <= LONGEST_NAME else "..." + name[3 - LONGEST_NAME :]


def _mm(metres: float) -> str:
    """Metres in millimetres with three digits or so; `-` for what is not known."""
    value = 1e3 * metres
    if np.isnan(value):
        return "-"
    return f"{value:.2f}" if value < 9.995 else f"{value:.1f}" if value < 99.95 else f"{value:.0f}"


def _number(value: float) -> str:
    return "-" if np.isnan(value) else f"{value:.2f}"
