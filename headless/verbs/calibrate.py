# SPDX-License-Identifier: GPL-3.0-or-later
"""`monocell calibrate`: a cell with sightings in, the camera's pose with its errors out."""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from ...core.arrays import Array
from ...core.calibration.calibrate import METHODS, REFINABLE, Calibration, calibrate_cell
from ...core.calibration.work_surface import surface_of
from ...core.cell import Cell
from ...core.document.cell_file import read_cell, write_cell
from ...core.errors import InvalidValue
from ..calibration_document import document
from ..calibration_report import Report, tell
from ..cli import DONE, NOT_TRUSTED
from ..told import print_json, warn


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's own arguments."""
    parser.add_argument("cell", type=Path, help="cell document with sightings")
    parser.add_argument("--out", type=Path, help="write the cell with its camera's pose")
    parser.add_argument(
        "--method",
        choices=METHODS,
        default="joint",
        help="joint: all outlines at once (default); baselines on the balls' centres: frames (the "
        "paper's triads), p3p (its depths from distances, every candidate), pnp (SQPnP)",
    )
    parser.add_argument(
        "--refine",
        action="append",
        default=[],
        choices=REFINABLE,
        help="solve for the focal length or the ball's radius too (may be given twice); refused "
        "where the sightings can't tell it",
    )
    parser.add_argument(
        "--surface",
        metavar="NAME|z=...",
        help="the plane whose points' error is told: a reference or a height; the first plane of "
        "the cell without it, else z=0",
    )
    parser.add_argument(
        "--sigma-map", type=Path, metavar="OUT.png", help="draw that error over the picture"
    )
    _add_advice_arguments(parser)
    parser.add_argument("--json", action="store_true", help="print JSON, which has all numbers")


def _add_advice_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--advise", action="store_true", help="tell where to hold the ball next, and what it gains"
    )
    among = parser.add_mutually_exclusive_group()
    among.add_argument(
        "--advise-from",
        type=Path,
        metavar="FILE",
        help="choose from the positions of a .json or .csv file",
    )
    among.add_argument(
        "--advise-box",
        type=float,
        nargs=6,
        metavar=("X0", "Y0", "Z0", "X1", "Y1", "Z1"),
        help="choose from a box in the world; without it, from one round the positions used",
    )


def run(args: argparse.Namespace) -> int:
    """Calibrate, tell, write; a calibration that failed is told but not written."""
    given = read_cell(args.cell)
    _check(args, given)
    candidates = _candidates(args)
    cell, calibration = calibrate_cell(given, args.method, args.refine)
    failed = calibration.verdict == "failed"
    report = _report(args, cell, calibration, candidates)
    if not failed:
        _write(args, cell, report)
    if args.json:
        print_json(document(report))
    else:
        tell(report)
    warn(report.warnings)
    left_out = len(cell.sightings) - len(calibration.sightings)
    if left_out:
        warn([f"{left_out} of {len(cell.sightings)} sightings have use: false and were left out"])
    if failed and (args.sigma_map is not None or _advice_asked(args)):
        warn(["no map and no advice from a calibration that failed"])
    if cell.mount is not None and cell.mount.world_from_flange is None:
        warn(["mount.world_from_flange of the cell's picture is missing: model needs it"])
    if args.out is not None and not failed and any(thing.picks for thing in cell.objects):
        warn(
            ["the objects were modelled with the camera as it was before: run monocell model again"]
        )
    return NOT_TRUSTED if failed else DONE


def _check(args: argparse.Namespace, cell: Cell) -> None:
    """Refuse what can't be done before the work is."""
    from ..sigma_map import check_map_name

    surface_of(cell, args.surface)
    if args.sigma_map is not None:
        check_map_name(args.sigma_map, cell)
    if args.method != "joint" and (args.sigma_map is not None or _advice_asked(args)):
        raise InvalidValue(
            f"the baseline {args.method} states no error to map or to lower; use --method joint"
        )


def _advice_asked(args: argparse.Namespace) -> bool:
    return bool(args.advise or args.advise_from is not None or args.advise_box is not None)


def _candidates(args: argparse.Namespace) -> Array | None:
    """The positions (N, 3) to choose from; None for those round the ones used."""
    from ...core.calibration.advise import positions_in_box
    from ..advised_positions import read_positions

    if args.advise_from is not None:
        return read_positions(args.advise_from)
    if args.advise_box is not None:
        return positions_in_box(np.reshape(args.advise_box, (2, 3)))
    return None


def _report(
    args: argparse.Namespace, cell: Cell, calibration: Calibration, candidates: Array | None
) -> Report:
    from ...core.calibration.accuracy import accuracy_of, advised
    from ...core.calibration.advise import positions_in_box, reachable_box

    plane = surface_of(cell, args.surface)
    accuracy = accuracy_of(cell, calibration, plane)
    asked = args.sigma_map is not None or _advice_asked(args)
    if calibration.verdict == "failed" or not asked:
        return Report(calibration, accuracy, plane.name)
    if accuracy.surface is None:
        raise InvalidValue(
            f"the picture shows nothing of {plane.name}, so there is no error to map or to lower; "
            "name another --surface"
        )
    if not _advice_asked(args):
        return Report(calibration, accuracy, plane.name)
    if candidates is None:
        candidates = positions_in_box(reachable_box(calibration.fit.places_base))
    advice = advised(calibration, accuracy.surface.area, candidates)
    return Report(calibration, accuracy, plane.name, advice)


def _write(args: argparse.Namespace, cell: Cell, report: Report) -> None:
    from ..pictures import write_picture
    from ..sigma_map import drawn_map

    surface = report.accuracy.surface
    drawn = None
    if args.sigma_map is not None and surface is not None:
        drawn = drawn_map(cell, report.calibration, surface)
    if args.out is not None:
        write_cell(cell, args.out)
    if drawn is not None:
        write_picture(args.sigma_map, drawn)
