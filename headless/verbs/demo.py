# SPDX-License-Identifier: GPL-3.0-or-later
"""`monocell demo`: the whole job on a synthetic cell, from rendered pictures to a free path."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from ...core.atomic import made_folder
from ...core.cell import Cell
from ...core.comparison import Comparison, compare_cells
from ..blender import require_blender
from ..cli import DONE, NOT_TRUSTED
from ..robot_job import seed_from
from ..told import progress, warn

if TYPE_CHECKING:
    from ..demo.steps import Estimate
    from ..robot.planning import Plan


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's own arguments."""
    parser.add_argument("out", type=Path, help="folder for all files, made if it is not there")
    parser.add_argument(
        "--seed", type=seed_from, default=1, help="of the picks' error and the planner"
    )


def run(args: argparse.Namespace) -> int:
    """Render, calibrate, model, export, plan, tell."""
    require_blender()
    from ..demo import steps

    truth = steps.make_pictures(made_folder(args.out))
    document = steps.hand_over(truth, args.seed)
    estimate = steps.estimate(document)
    cell, calibration = estimate.cell, estimate.calibration
    pictures = steps.draw_overlays(cell, calibration, args.out)
    environment, motion_told, plan, robot_picture = _use(cell, args)
    comparison = compare_cells(truth, cell)
    _tell(estimate, comparison, motion_told)
    warn([*estimate.warnings, *plan.warnings])
    photographs = [args.out / s.picture for s in truth.sightings] + [args.out / steps.PICTURE]
    drawn = [*pictures, _side_view(cell, args), robot_picture]
    _name_files([*photographs, args.out / steps.TRUTH, document, environment, *drawn])
    return DONE if calibration.verdict != "failed" and plan.walk.free else NOT_TRUSTED


def _use(cell: Cell, args: argparse.Namespace) -> tuple[Path, str, Plan, Path]:
    """Export the environment, load it as a planner would, find a way round."""
    from ...scene.gltf import export_gltf
    from .. import robot_job
    from ..demo.plan_of_cell import BALL_IN_FLANGE, BALL_RADIUS, STEM_RADIUS, table_box
    from ..robot.arm import Arm, HeldBall
    from ..robot.glb import read_environment
    from ..robot.scene import RobotScene

    progress("exporting glTF")
    path = args.out / "environment.glb"
    export_gltf(cell, path)
    progress("planning in PyBullet")
    environment = read_environment(path)
    picture = args.out / "robot.png"
    with (
        Arm(ball=HeldBall(BALL_RADIUS, BALL_IN_FLANGE, STEM_RADIUS)) as arm,
        RobotScene(arm, environment.objects, table=table_box()) as scene,
    ):
        motion, plan = robot_job.solve_motion(scene, None, None, args.seed)
        robot_job.draw(scene, motion, plan, picture)
    return path, robot_job.told(motion, plan), plan, picture


def _side_view(cell: Cell, args: argparse.Namespace) -> Path:
    from ..demo.photographs import other_side, photograph_cell
    from ..robot.arm import Arm

    path: Path = args.out / "other_side.png"
    with Arm() as arm:
        photograph_cell(other_side(cell.camera), cell.objects, arm.parts(arm.rest), path)
    return path


def _tell(estimate: Estimate, comparison: Comparison, motion_told: str) -> None:
    from ..demo.steps import PICK_SIGMA_PIXELS
    from .compare import told

    calibration, aligned = estimate.calibration, estimate.aligned.objects
    print(
        f"calibrated from {calibration.count_used} of {len(calibration.sightings)} ball sightings: "
        f"{calibration.verdict}, outlines {calibration.rms_pixels:.2f} px rms"
    )
    print(
        "objects modelled from simulated picks: the truth projected, plus a seeded error of "
        f"{PICK_SIGMA_PIXELS:g} px sigma as a hand would make; then aligned on the picture's edges "
        f"({sum(one.believed for one in aligned.values())} of {len(aligned)} believed)"
    )
    print()
    print("estimate against truth, beside the 1 sigma that the estimate states")
    print(told(comparison))
    print()
    print(motion_told)


def _name_files(files: list[Path]) -> None:
    print()
    print("files")
    for path in files:
        print(f"  {path}")
