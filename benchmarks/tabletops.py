# SPDX-License-Identifier: GPL-3.0-or-later
"""Modelling error on random table tops rendered with Cycles, from an honest hand's picks.

    python benchmarks/tabletops.py [--cells 60] [--first 0] [--worst 5] [--overlays FOLDER]

Each way of picking is solved twice: with the true camera, which states no error, and with a camera
off by an error drawn from the covariance it states, as good as a calibrated rig's. `joint` solves
all things of a table and the camera's error together. `aligned` begins with the fewest picks (all
that is seen where those are hidden) and goes on with the edges of the rendered picture. Sizes count
one by one as a share of themselves; the place is the centre's; `in 95 %` is how often place and
sizes lie in the ellipsoid of 95 % that is stated. Of `hidden` things the hand sees too little;
`refused` are those whose picks leave something open, such as the height of a box whose foot is
hidden all round.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from monocell.core.align.result import Aligned
from monocell.core.camera import Camera
from monocell.core.cell import Cell
from monocell.core.errors import MonocellError
from monocell.core.modelling.solve import Modelled, model_cell
from monocell.core.picture.overlay import draw_overlay
from monocell.core.picture.pictures import Picture
from monocell.core.pose import point_jacobian
from monocell.core.primitives import Primitive
from monocell.core.sketch import Sketch
from monocell.headless.pictures import write_picture
from monocell.headless.told import table
from rendered_rigs import CACHE
from rendered_tabletops import TABLE, rendered_tabletop
from tabletop_picks import PICK_SIGMA_PIXELS, sketches
from tabletop_plans import HIGH, LOW, TabletopPlan, random_tabletop
from tabletop_scores import HEADER, ThingScore, figures, refused, score

CAMERAS = ("true", "calibrated")
# a calibration knows the middle of a ball's picture to so many pixels, at so many places
BALL_SIGMA_PIXELS, BALLS = 0.07, 6
HIDDEN = "hidden"

# a modelled cell and its picture to the cell aligned, with what is doubtful of each object
Align = Callable[[Cell, Picture], tuple[Cell, Aligned]]
Scored = Callable[[TabletopPlan, Camera], list[ThingScore]]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cells", type=int, default=60)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--only", default="", help="only ways whose name contains this")
    parser.add_argument("--worst", type=int, default=0, help="also print so many of the worst")
    parser.add_argument("--overlays", type=Path, help="a folder for pictures with what was solved")
    parser.add_argument("--cache", type=Path, default=CACHE)
    args = parser.parse_args()
    plans = [random_tabletop(seed) for seed in range(args.first, args.first + args.cells)]
    rows = [
        _row(f"{way}, {kind} camera", plans, kind, scored, args.worst)
        for way, scored in ways(args.cache).items()
        for kind in CAMERAS
        if args.only in way
    ]
    print(table(("picks", "hidden", *HEADER), rows))
    if args.overlays:
        for plan in plans:
            _overlay(plan, args.cache, args.overlays)


def ways(cache: Path) -> dict[str, Scored | None]:
    """How things are picked and solved; None for what this checkout can't do."""
    align = edge_alignment()
    return {
        "fewest": lambda plan, camera: alone(plan, camera, sketches(plan, "fewest")),
        "all": lambda plan, camera: alone(plan, camera, sketches(plan, "all")),
        "all joint": together,
        "aligned": None
        if align is None
        else lambda plan, camera: aligned(plan, camera, cache, align),
    }


def edge_alignment() -> Align | None:
    """The alignment on the picture's edges, None where there is none."""
    try:
        from monocell.core.align.align_cell import align_cell
    except ImportError:
        return None
    return align_cell


def alone(plan: TabletopPlan, camera: Camera, picked: Sequence[Sketch | None]) -> list[ThingScore]:
    """Each thing solved by itself."""
    return [
        _score(plan, truth, _solved(camera, sketch))
        for truth, sketch in zip(plan.things, picked, strict=True)
    ]


def together(plan: TabletopPlan, camera: Camera) -> list[ThingScore]:
    """All things that can be solved by themselves, as one problem with the camera's error."""
    results = [_solved(camera, sketch) for sketch in sketches(plan, "all")]
    kept = [sketch for sketch, result in zip(sketches(plan, "all"), results, strict=True)
            if isinstance(result, Modelled)]  # fmt: skip
    _, modelled = model_cell(_picked(camera, kept), PICK_SIGMA_PIXELS, joint=True)
    joint = {one.object.name: one for one in modelled}
    return [
        _score(plan, truth, joint.get(truth.name, result))
        for truth, result in zip(plan.things, results, strict=True)
    ]


def aligned(plan: TabletopPlan, camera: Camera, cache: Path, align: Align) -> list[ThingScore]:
    """What the fewest picks give, moved onto the edges of the picture, all things at once."""
    both = zip(sketches(plan, "fewest"), sketches(plan, "all"), strict=True)
    results = [_solved(camera, few or every) for few, every in both]
    things = tuple(one.object for one in results if isinstance(one, Modelled))
    picture = rendered_tabletop(plan, cache).picture()
    _, found = align(Cell(camera, references=(TABLE,), objects=things), picture)
    moved = found.objects
    return [
        _score(plan, truth, result)
        if truth.name not in moved
        else score(
            plan.name,
            truth,
            moved[truth.name].thing,
            (*moved[truth.name].reasons, *moved[truth.name].warnings),
        )
        for truth, result in zip(plan.things, results, strict=True)
    ]


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


def _row(
    name: str, plans: Sequence[TabletopPlan], kind: str, scored: Scored | None, worst: int
) -> tuple[str, ...]:
    if scored is None:
        return (name, *["-"] * (len(HEADER) + 1))
    scores = [
        s
        for plan in plans
        for s in scored(plan, plan.camera if kind == "true" else calibrated(plan))
    ]
    told = [s for s in scores if s.refusal != HIDDEN]
    _tell_worst(name, told, worst)
    return (name, str(len(scores) - len(told)), *figures(told))


def _solved(camera: Camera, sketch: Sketch | None) -> Modelled | str:
    """The thing, or why there is none."""
    if sketch is None:
        return HIDDEN
    try:
        return model_cell(_picked(camera, [sketch]), PICK_SIGMA_PIXELS)[1][0]
    except MonocellError as error:
        return str(error)


def _score(plan: TabletopPlan, truth: Primitive, result: Modelled | str) -> ThingScore:
    if isinstance(result, str):
        return refused(plan.name, truth.name, result)
    return score(plan.name, truth, result.object, result.warnings)


def _picked(camera: Camera, picked: Sequence[Sketch]) -> Cell:
    return Cell(camera, references=(TABLE,), sketches=tuple(picked))


def _tell_worst(way: str, scores: Sequence[ThingScore], count: int) -> None:
    for one in [s for s in scores if s.refusal][:count]:
        print(f"  {way}: {one.cell} {one.refusal}")
    solved = [s for s in scores if not s.refusal]
    for one in sorted(solved, key=lambda s: -s.size_errors.max())[:count]:
        sizes = ", ".join(f"{100 * e:.1f}" for e in one.size_errors)
        doubt = one.warnings[0] if one.warnings else "no warning"
        print(f"  {way}: {one.cell} {one.name}: {sizes} %, {1e3 * one.place:.1f} mm; {doubt}")


def _overlay(plan: TabletopPlan, cache: Path, folder: Path) -> None:
    """What all picks give, over the picture, with the calibrated camera."""
    camera = calibrated(plan)
    results = [_solved(camera, sketch) for sketch in sketches(plan, "all")]
    things = [one.object for one in results if isinstance(one, Modelled)]
    folder.mkdir(parents=True, exist_ok=True)
    picture = rendered_tabletop(plan, cache).picture()
    write_picture(folder / f"{plan.name}.png", draw_overlay(picture, camera, things))


if __name__ == "__main__":
    main()
