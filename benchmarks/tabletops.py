# SPDX-License-Identifier: GPL-3.0-or-later
"""Modelling error on random table tops rendered with Cycles, from an honest hand's picks.

    python benchmarks/tabletops.py [--cells 60] [--first 0] [--worst 5] [--overlays FOLDER]

Each way of picking is solved twice: with the true camera, which states no error, and with a camera
off by an error drawn from the covariance it states, as good as a calibrated rig's. Sizes count one
by one as a share of themselves; the place is the centre's; `in 95 %` is how often place and sizes
lie in the ellipsoid of 95 % that is stated. Things of which the hand sees too little are `hidden`.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from monocell.core.camera import Camera
from monocell.core.cell import Cell
from monocell.core.errors import MonocellError
from monocell.core.modelling.solve import model_cell
from monocell.core.picture.overlay import draw_overlay
from monocell.core.pose import point_jacobian
from monocell.core.sketch import Sketch
from monocell.headless.pictures import write_picture
from monocell.headless.told import table
from rendered_rigs import CACHE
from rendered_tabletops import TABLE, rendered_tabletop
from tabletop_picks import PICK_SIGMA_PIXELS, WAYS, sketches
from tabletop_plans import HIGH, LOW, TabletopPlan, random_tabletop
from tabletop_scores import HEADER, ThingScore, figures, refused, score

CAMERAS = ("true", "calibrated")
# a calibration knows the middle of a ball's picture to so many pixels, at so many places
BALL_SIGMA_PIXELS, BALLS = 0.07, 6


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cells", type=int, default=60)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--worst", type=int, default=0, help="also print so many of the worst")
    parser.add_argument("--overlays", type=Path, help="a folder for pictures with what was solved")
    parser.add_argument("--cache", type=Path, default=CACHE)
    args = parser.parse_args()
    plans = [random_tabletop(seed) for seed in range(args.first, args.first + args.cells)]
    rows = []
    for way in WAYS:
        for camera in CAMERAS:
            scores = [s for plan in plans for s in scored(plan, way, camera)]
            hidden = [s for s in scores if s.refusal == HIDDEN]
            told = [s for s in scores if s.refusal != HIDDEN]
            rows.append((f"{way}, {camera} camera", str(len(hidden)), *figures(told)))
            _tell_worst(told, args.worst)
    print(table(("picks", "hidden", *HEADER), rows))
    if args.overlays:
        for plan in plans:
            _overlay(plan, args.cache, args.overlays)


HIDDEN = "hidden"


def scored(plan: TabletopPlan, way: str, kind: str) -> list[ThingScore]:
    """The hand's picks solved, each thing by itself."""
    camera = plan.camera if kind == "true" else calibrated(plan)
    results = []
    for truth, sketch in zip(plan.things, sketches(plan, way), strict=True):
        if sketch is None:
            results.append(refused(plan.name, truth.name, HIDDEN))
            continue
        try:
            cell, modelled = model_cell(_picked(camera, [sketch]), PICK_SIGMA_PIXELS)
        except MonocellError as error:
            results.append(refused(plan.name, truth.name, str(error)))
            continue
        results.append(score(plan.name, truth, cell.objects[0], modelled[0].warnings))
    return results


def calibrated(plan: TabletopPlan) -> Camera:
    """The camera as a calibration would give it: a little off, as its covariance says.

    The covariance is that of a pose from balls all over the work space.
    """
    rng = np.random.default_rng([107, plan.seed])
    low, high = [*(LOW - 0.1), 0.05], [*(HIGH + 0.1), 0.6]
    points = plan.camera.pose.apply(rng.uniform(low, high, (BALLS, 3)))
    _, by_point = plan.camera.intrinsics.project_with_jacobian(points)
    by_twist = (by_point @ point_jacobian(points)).reshape(-1, 6)
    covariance = BALL_SIGMA_PIXELS**2 * np.linalg.inv(by_twist.T @ by_twist)
    twist = rng.multivariate_normal(np.zeros(6), covariance)
    return plan.camera.placed(plan.camera.pose.perturbed(twist), covariance)


def _picked(camera: Camera, picked: Sequence[Sketch]) -> Cell:
    return Cell(camera, references=(TABLE,), sketches=tuple(picked))


def _tell_worst(scores: Sequence[ThingScore], count: int) -> None:
    for one in [s for s in scores if s.refusal][:count]:
        print(f"  {one.cell} {one.refusal}")
    solved = [s for s in scores if not s.refusal]
    for one in sorted(solved, key=lambda s: -s.size_errors.max())[:count]:
        sizes = ", ".join(f"{100 * e:.1f}" for e in one.size_errors)
        print(f"  {one.cell} {one.name}: {sizes} %, {1e3 * one.place:.1f} mm; {one.warnings[:1]}")


def _overlay(plan: TabletopPlan, cache: Path, folder: Path) -> None:
    camera, things = calibrated(plan), []
    for sketch in sketches(plan, "all"):
        try:
            things += model_cell(_picked(camera, [sketch]))[0].objects if sketch else []
        except MonocellError:
            continue
    folder.mkdir(parents=True, exist_ok=True)
    picture = rendered_tabletop(plan, cache).picture()
    write_picture(folder / f"{plan.name}.png", draw_overlay(picture, camera, things))


if __name__ == "__main__":
    main()
