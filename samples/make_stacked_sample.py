# SPDX-License-Identifier: GPL-3.0-or-later
"""Sample 03, to be modelled by hand: `python samples/make_stacked_sample.py [--samples 20]`.

Renders the true cell of `stacked_cell.py` with Cycles and writes 03_stack/: nine JPEGs, the
document of a site that has modelled nothing yet, and the truth.
"""

from __future__ import annotations

import argparse
import tempfile
from dataclasses import asdict, replace
from pathlib import Path

import cv2
import stacked_cell as plan
from monocell.core.appearance import Appearance
from monocell.core.camera import Camera
from monocell.core.cell import Cell
from monocell.core.document.cell_file import write_cell
from monocell.core.primitives import Primitive
from monocell.core.sighting import SphereSighting
from monocell.headless.demo.plan_of_cell import BALL_COLOR, BALL_IN_FLANGE, BALL_RADIUS, STEM_RADIUS
from monocell.headless.robot.arm import Arm, HeldBall
from monocell.headless.told import progress
from monocell.scene.stage import Stage
from monocell.scene.work_cell import Ball, WorkCell
from printed_faces import printed

HERE = Path(__file__).parent / "03_stack"
QUALITY, SAMPLES = 92, 20
PICTURE = "cell.jpg"


def main() -> None:
    """Write sample 03."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--samples", type=int, default=SAMPLES, help="light paths per pixel")
    parser.add_argument("--out", type=Path, default=HERE)
    parser.add_argument("--cell-only", action="store_true", help="the cell's own picture alone")
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    ball = HeldBall(BALL_RADIUS, BALL_IN_FLANGE, STEM_RADIUS)
    with Arm(ball=ball) as arm, tempfile.TemporaryDirectory() as prints:
        _photograph_cell(arm, Path(prints), args.out, args.samples)
        if args.cell_only:
            return
        sightings = _photograph_balls(arm, args.out, args.samples)
    truth = Cell(plan.true_camera(), PICTURE, sightings, (plan.TABLE,), _plain(), folder=args.out)
    write_cell(truth, args.out / "truth.cell.json")
    given = replace(truth, camera=Camera(truth.camera.intrinsics), objects=())
    write_cell(given, args.out / "stack.cell.json")


def _plain() -> tuple[Primitive, ...]:
    """The things with their mean colours; what is printed on them stays here."""
    inks = asdict(plan.Ink())
    return tuple(
        replace(thing, appearance=Appearance(inks[thing.name])) for thing in plan.true_objects()
    )


def _photograph_cell(arm: Arm, prints: Path, out: Path, samples: int) -> None:
    inks = asdict(plan.Ink())
    things = tuple(printed(thing, inks[thing.name], prints) for thing in plan.true_objects())
    parts = arm.parts(arm.rest)
    progress(f"rendering {PICTURE}")
    with Stage(WorkCell(plan.true_camera(), things, parts=parts, lab=plan.lab())) as stage:
        _photograph(stage, out / PICTURE, samples)


def _photograph_balls(arm: Arm, out: Path, samples: int) -> tuple[SphereSighting, ...]:
    """One picture for each place that the arm holds the ball at."""
    sightings = []
    with Stage(WorkCell(plan.true_camera(), lab=plan.lab())) as stage:
        for i, place in enumerate(plan.BALL_POSITIONS):
            joints = arm.joints_reaching(place, point_flange=BALL_IN_FLANGE)
            centre, flange = arm.ball_center(joints), arm.world_from_flange(joints)
            stage.move(arm.parts(joints), Ball(centre, BALL_RADIUS, BALL_COLOR, flange))
            name = f"pose_{i:02d}.jpg"
            progress(f"rendering {name} ({i + 1} of {len(plan.BALL_POSITIONS)})")
            _photograph(stage, out / name, samples)
            sightings.append(SphereSighting(name, centre, BALL_RADIUS))
    return tuple(sightings)


def _photograph(stage: Stage, path: Path, samples: int) -> None:
    """A JPEG, as a site would send it."""
    with tempfile.TemporaryDirectory() as folder:
        rendered = Path(folder) / "rendered.png"
        stage.render(rendered, samples=samples)
        cv2.imwrite(str(path), cv2.imread(str(rendered)), [cv2.IMWRITE_JPEG_QUALITY, QUALITY])


if __name__ == "__main__":
    main()
