# SPDX-License-Identifier: GPL-3.0-or-later
"""One rendered rig looked at: each sighting enlarged, with the true outline and what was found.

    python benchmarks/inspect_rig.py varied 12 OUT.png
    python benchmarks/inspect_rig.py plain 3 OUT.png --picture "noise 4"

Without `--picture` (a part of the name of a class in `rendered_accuracy.py`) the rig is
photographed as `honesty.py` does. Left half of each tile: the picture alone. Right half: the true
outline thin in white, the measured points green (used) or red (outvoted).
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

import cv2
import numpy as np
from monocell.core.ball.sphere import outline_pixels
from monocell.core.calibration.calibrate import Calibration, calibrate_cell
from monocell.core.cell import Cell
from monocell.core.comparison import pose_error
from monocell.core.errors import MonocellError
from monocell.core.picture.pictures import read_picture
from monocell.headless.pictures import write_picture
from photographs import photograph_rig, random_development
from rendered_accuracy import CLASSES
from rendered_rigs import CACHE, RenderedRig, rendered_rig
from rig_plans import FAMILIES, RADIUS, random_plan

TILE, ACROSS = 360, 2
WHITE, GREEN, RED = (255, 255, 255), (80, 220, 80), (60, 60, 255)


def main() -> None:
    """Draw the sheet, print what became of each sighting."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("family", choices=FAMILIES)
    parser.add_argument("seed", type=int)
    parser.add_argument("out", type=Path)
    parser.add_argument("--picture", help="a class of rendered_accuracy.py")
    parser.add_argument("--cache", type=Path, default=CACHE)
    args = parser.parse_args()
    how, bare = random_development(args.seed), False
    if args.picture:
        how, bare = next(v[:2] for name, v in CLASSES.items() if args.picture in name)
    rig = rendered_rig(random_plan(args.family, args.seed), bare=bare, cache=args.cache)
    print(f"{rig.plan.name}: {rig.plan.ball} ball, {how.told()}")
    with tempfile.TemporaryDirectory(prefix="monocell-bench-") as folder:
        cell = photograph_rig(rig, how, Path(folder))
        calibration = _calibrated(cell, rig, rig.plan.hidden * (not bare))
        tiles = [_tile(rig, cell, calibration, i) for i in range(len(cell.sightings))]
    tiles += [np.zeros_like(tiles[0])] * (-len(tiles) % ACROSS)
    rows = [np.hstack(tiles[i : i + ACROSS]) for i in range(0, len(tiles), ACROSS)]
    write_picture(args.out, np.vstack(rows))


def _calibrated(cell: Cell, rig: RenderedRig, hidden: np.ndarray) -> Calibration | None:
    try:
        calibration = calibrate_cell(cell)[1]
    except MonocellError as error:
        print(f"refused: {error}")
        return None
    error = pose_error(rig.plan.camera, calibration.camera)
    print(
        f"{calibration.verdict}: {1e3 * np.linalg.norm(error.centre):.2f} mm, "
        f"{np.degrees(np.linalg.norm(error.rotation)):.4f} deg, Mahalanobis {error.mahalanobis:.2f}"
    )
    for warning in calibration.warnings:
        print(f"  {warning}")
    for i, (report, part) in enumerate(zip(calibration.sightings, hidden, strict=True)):
        print(
            f"  {i}: {report.status}, {100 * part:.0f} % hidden, rms {report.rms_pixels:.2f} px, "
            f"off {report.off_pixels:.2f} px {report.reason}"
        )
    return calibration


def _tile(rig: RenderedRig, cell: Cell, calibration: Calibration | None, i: int) -> np.ndarray:
    intrinsics = cell.camera.intrinsics
    picture = read_picture(cell.path_of(cell.sightings[i].picture), intrinsics)
    truth = rig.plan.camera.pose.apply(rig.plan.positions[i])
    outline = outline_pixels(intrinsics, truth, RADIUS)
    middle = outline.mean(axis=0)
    half = 1.9 * np.linalg.norm(outline - middle, axis=1).max()
    scale = TILE / (2 * half)
    # the centre of pixel (0, 0) is shown in the middle of its enlarged square
    warp = np.array(
        [[scale, 0, -scale * (middle[0] - half)], [0, scale, -scale * (middle[1] - half)]]
    )
    plain = cv2.warpAffine(picture, warp, (TILE, TILE), flags=cv2.INTER_NEAREST)
    drawn = plain.copy()
    _polyline(drawn, outline @ warp[:, :2].T + warp[:, 2], WHITE)
    report = None if calibration is None else calibration.sightings[i]
    if report is not None and report.outline is not None:
        points = report.outline.pixels @ warp[:, :2].T + warp[:, 2]
        for point, used in zip(points, report.outline.used, strict=True):
            at = tuple(np.rint(point * 16).astype(int).tolist())
            cv2.circle(drawn, at, 20, GREEN if used else RED, -1, cv2.LINE_AA, 4)
    said = "refused" if report is None else report.status
    cv2.putText(drawn, f"{i} {said}", (8, 20), cv2.FONT_HERSHEY_SIMPLEX, 0.5, WHITE, 1, cv2.LINE_AA)
    return np.hstack([plain, drawn])


def _polyline(picture: np.ndarray, points: np.ndarray, color: tuple[int, int, int]) -> None:
    at = np.rint(points * 16).astype(np.int32)
    cv2.polylines(picture, [at], True, color, 1, cv2.LINE_AA, 4)


if __name__ == "__main__":
    main()
