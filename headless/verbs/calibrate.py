# SPDX-License-Identifier: GPL-3.0-or-later
"""`monocell calibrate`: a cell with sightings in, the camera's pose with its errors out."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np

from ...core.calibration.calibrate import METHODS, REFINABLE, Calibration, calibrate_cell
from ...core.document.cell_file import read_cell, write_cell
from ...core.document.entries import camera_entry, pose_entry
from ..calibration_unknowns import unknowns_document, unknowns_told
from ..cli import DONE, NOT_TRUSTED
from ..told import millimetres, point_told, print_json, table, warn


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
    parser.add_argument("--json", action="store_true", help="print JSON")


def run(args: argparse.Namespace) -> int:
    """Calibrate, tell, write; a calibration that failed is told but not written."""
    cell, calibration = calibrate_cell(read_cell(args.cell), args.method, args.refine)
    failed = calibration.verdict == "failed"
    if args.out is not None and not failed:
        write_cell(cell, args.out)
    if args.json:
        print_json(document(calibration))
    else:
        tell(calibration)
    warn(calibration.warnings)
    if cell.mount is not None and cell.mount.world_from_flange is None:
        warn(["mount.world_from_flange of the cell's picture is missing: model needs it"])
    if args.out is not None and not failed and any(thing.picks for thing in cell.objects):
        warn(
            ["the objects were modelled with the camera as it was before: run monocell model again"]
        )
    return NOT_TRUSTED if failed else DONE


def document(calibration: Calibration) -> dict[str, Any]:
    """The whole report as JSON values."""
    camera = calibration.camera
    return {
        "verdict": calibration.verdict,
        "warnings": calibration.warnings,
        "method": calibration.method,
        "camera": camera_entry(camera),
        "center_world": camera.centre_world,
        "center_sigma": camera.centre_sigma(),
        "rotation_sigma_degrees": _degrees(camera.rotation_sigma()),
        "rms_pixels": calibration.rms_pixels,
        "edge_bias_pixels": calibration.edge_bias_pixels,
        "edge_bias_sigma_pixels": calibration.edge_bias_sigma_pixels,
        "misfit": calibration.misfit,
        **unknowns_document(calibration),
        "positions": {
            "count": calibration.geometry.count,
            "length": calibration.geometry.length,
            "off_line": calibration.geometry.off_line,
            "off_plane": calibration.geometry.off_plane,
        },
        "candidates": [
            {
                "camera_from_base": pose_entry(candidate.camera_from_base),
                "off_pixels": candidate.off_pixels,
            }
            for candidate in calibration.candidates
        ],
        "sightings": [
            {
                "picture": report.picture,
                "center": report.center_world,
                "status": report.status,
                "reason": report.reason,
                "rms_pixels": report.rms_pixels,
                "off_pixels": report.off_pixels,
                "off_millimetres": report.off_millimetres,
            }
            for report in calibration.sightings
        ],
    }


def tell(calibration: Calibration) -> None:
    """The report for a person."""
    camera = calibration.camera
    centre, rotation = camera.centre_sigma(), _degrees(camera.rotation_sigma())
    print(f"camera at {point_told(camera.centre_world)}")
    if centre is not None and rotation is not None:
        print(
            f"1 sigma   position {millimetres(float(np.linalg.norm(centre)))}, "
            f"rotation {np.linalg.norm(rotation):.4f} deg"
        )
    else:
        print(f"1 sigma   unknown: the baseline {calibration.method} states none")
        for candidate in calibration.candidates:
            centre = candidate.camera_from_base.inverse().translation
            print(f"candidate {point_told(centre)}, balls {candidate.off_pixels:.2f} px off")
        print("what follows is of the joint fit that the baseline is held against")
    print(
        f"outlines  {calibration.rms_pixels:.2f} px rms, edge bias "
        f"{calibration.edge_bias_pixels:+.3f} ± {calibration.edge_bias_sigma_pixels:.3f} px"
    )
    for line in unknowns_told(calibration):
        print(line)
    rows = [
        (
            report.picture,
            report.status,
            _number(report.rms_pixels),
            _number(report.off_pixels),
            _number(report.off_millimetres),
            report.reason,
        )
        for report in calibration.sightings
    ]
    print(table(("sighting", "status", "rms px", "off px", "off mm", "why"), rows))
    print(f"verdict   {calibration.verdict}")


def _degrees(radians: Any) -> Any:
    return None if radians is None else np.degrees(radians)


def _number(value: float) -> str:
    return "-" if np.isnan(value) else f"{value:.2f}"
