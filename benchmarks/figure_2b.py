# SPDX-License-Identifier: GPL-3.0-or-later
"""The paper's figure 2b again: 80 balls, each measured alone from its picture, as table and plot.

    python benchmarks/figure_2b.py [--out docs/pictures/figure_2b.png] [--cache FOLDER]

A 40 mm ball, 2-3 m away, rendered with Cycles at 80 positions; its centre is found in the frame of
the true camera, from the whole picture. Axes as in the paper: x across, y along the line of sight
(depth), z up. Errors in mm, and in percent of the ball's distance. Then what the joint calibration
of the same 80 pictures is worth: where it puts the 80 balls, and the camera.
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

import numpy as np
from error_plot import Strip, draw_strips
from monocell.core.ball.find import find_sphere
from monocell.core.calibration.calibrate import calibrate_outlines
from monocell.core.camera import Camera
from monocell.core.errors import MonocellError
from monocell.core.picture.pictures import read_picture
from monocell.headless.pictures import write_picture
from monocell.headless.told import progress, table
from photographs import Development, photograph_rig
from rendered_accuracy import CLEAN, NOISY
from rendered_rigs import CACHE, RenderedRig, rendered_rig
from rig_plans import RADIUS, random_plan
from rig_scores import pose_errors

SEED = 3
CLASSES = {"clean": CLEAN, "noise 4, blur 0.8, JPEG 80": NOISY}
AXES = ("x across", "y depth", "z up")
PAPER_MEAN, PAPER_SPREAD = (-2.256, -11.9943, -1.219), (13.7065, 50.6828, 11.636)
# the paper's axes from the camera's: y is its depth, z points up
PAPER_FROM_CAMERA = np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]])


def main() -> None:
    """Print the tables, draw the plot of the clean pictures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, help="a PNG")
    parser.add_argument("--cache", type=Path, default=CACHE)
    args = parser.parse_args()
    rig = rendered_rig(random_plan("paper", SEED), bare=True, cache=args.cache)
    rows = [("the paper", "about 80", *_figures(PAPER_MEAN, PAPER_SPREAD))]
    percents: dict[str, np.ndarray] = {}
    millimetres: dict[str, np.ndarray] = {}
    joint = []
    for name, how in CLASSES.items():
        outlines = _outlines(rig, how)
        off, off_joint, told = _errors(rig, outlines)
        rows.append((f"one ball alone, {name}", str(len(off)), *_millimetres(off)))
        rows.append((f"by the joint pose, {name}", "80", *_millimetres(off_joint)))
        percents[name], millimetres[name] = _percent(rig, outlines, off), 1e3 * off
        joint.append((name, *told))
    header = ("error in mm: mean ± standard deviation", "balls", *AXES)
    print(table(header, rows), end="\n\n")
    print(table(("percent of the distance", "", *AXES), _percent_rows(percents)), end="\n\n")
    print(table(("joint calibration", "balls", "verdict", "camera mm", "deg"), joint))
    if args.out:
        strips = [_strip(i, percents["clean"], millimetres["clean"]) for i in range(3)]
        write_picture(args.out, draw_strips(strips, "ball, from near to far", "% of the distance"))


def _outlines(rig: RenderedRig, how: Development) -> list:
    """Each ball's, None where none was found."""
    found = []
    with tempfile.TemporaryDirectory(prefix="monocell-bench-") as folder:
        cell = photograph_rig(rig, how, Path(folder))
        for sighting in cell.sightings:
            picture = read_picture(cell.path_of(sighting.picture), cell.camera.intrinsics)
            try:
                found.append(find_sphere(picture, cell.camera.intrinsics, RADIUS))
            except MonocellError as error:
                progress(f"{sighting.picture}: {error}")
                found.append(None)
    return found


def _errors(rig: RenderedRig, outlines: list) -> tuple[np.ndarray, np.ndarray, tuple[str, ...]]:
    """Of the balls measured alone (N, 3), of all by the joint pose (80, 3), and of that pose."""
    from monocell.core.sighting import SphereSighting

    truth = rig.plan.camera
    true_centres = truth.pose.apply(rig.plan.positions)
    seen = [i for i, outline in enumerate(outlines) if outline is not None]
    alone = np.array([outlines[i].centre_camera for i in seen]) - true_centres[seen]
    sightings = [SphereSighting(f"{i}", p, RADIUS) for i, p in enumerate(rig.plan.positions)]
    solved = calibrate_outlines(Camera(truth.intrinsics), sightings, outlines)
    predicted = solved.camera.pose.apply(rig.plan.positions) - true_centres
    place, turn = pose_errors(truth, solved.camera.pose)
    told = (str(solved.count_used), solved.verdict, f"{1e3 * place:.3f}")
    axes = PAPER_FROM_CAMERA.T
    return alone @ axes, predicted @ axes, (*told, f"{np.degrees(turn):.4f}")


def _percent(rig: RenderedRig, outlines: list, off: np.ndarray) -> np.ndarray:
    """Errors (N, 3) in percent of each ball's distance, from the nearest ball to the farthest."""
    seen = [i for i, outline in enumerate(outlines) if outline is not None]
    distance = np.linalg.norm(rig.plan.camera.pose.apply(rig.plan.positions[seen]), axis=1)
    return (100 * off / distance[:, None])[np.argsort(distance)]


def _strip(axis: int, percent: np.ndarray, off_millimetres: np.ndarray) -> Strip:
    here = off_millimetres[:, axis]
    notes = (
        f"here: {here.mean():+.2f} mm, s.d. {here.std():.2f} mm",
        f"paper: {PAPER_MEAN[axis]:+.2f} mm, s.d. {PAPER_SPREAD[axis]:.2f} mm",
    )
    return Strip(AXES[axis], percent[:, axis], notes)


def _percent_rows(percents: dict[str, np.ndarray]) -> list[tuple[str, ...]]:
    return [
        (
            name,
            str(len(p)),
            *(f"{m:+.4f} ± {s:.4f}" for m, s in zip(p.mean(0), p.std(0), strict=True)),
        )
        for name, p in percents.items()
    ]


def _millimetres(off: np.ndarray) -> tuple[str, ...]:
    return _figures(1e3 * off.mean(axis=0), 1e3 * off.std(axis=0))


def _figures(mean, spread) -> tuple[str, ...]:
    return tuple(f"{m:+.3f} ± {s:.3f}" for m, s in zip(mean, spread, strict=True))


if __name__ == "__main__":
    main()
