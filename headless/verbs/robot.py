# SPDX-License-Identifier: GPL-3.0-or-later
"""`monocell robot`: an exported environment in, a collision check and a free path out."""

from __future__ import annotations

import argparse
from pathlib import Path

from ...core.errors import InvalidValue
from ..cli import DONE, NOT_TRUSTED
from ..robot_job import document, draw, joints_from, seed_from, solve_motion, told
from ..told import print_json, warn


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's own arguments."""
    parser.add_argument("environment", type=Path, help="a .glb that monocell export wrote")
    parser.add_argument("--urdf", type=Path, help="the arm (default: KUKA LBR iiwa from PyBullet)")
    parser.add_argument("--flange", help="the URDF link that is the flange (default: the last)")
    parser.add_argument("--start", type=float, nargs="+", metavar="Q", help="joint angles, radians")
    parser.add_argument("--goal", type=float, nargs="+", metavar="Q", help="joint angles, radians")
    parser.add_argument("--seed", type=seed_from, default=1, help="of the planner (default 1)")
    parser.add_argument("--picture", type=Path, help="write a PNG of the scene with the path")
    parser.add_argument("--json", action="store_true", help="print JSON")


def run(args: argparse.Namespace) -> int:
    """Load, check the straight motion, plan, tell, draw."""
    if (args.start is None) != (args.goal is None):
        raise InvalidValue("give --start and --goal together, or neither")
    if args.picture is not None and args.picture.suffix.lower() != ".png":
        raise InvalidValue(f"{args.picture}: the picture is a PNG; name it .png")
    from ..robot.arm import Arm
    from ..robot.floors import floor_of
    from ..robot.glb import read_environment
    from ..robot.scene import RobotScene

    environment = read_environment(args.environment)
    warn(environment.warnings)
    with (
        Arm(args.urdf, flange=args.flange) as arm,
        RobotScene(
            arm,
            environment.objects,
            meshes=environment.meshes,
            table=floor_of(environment.extras),
            composites=environment.composites,
        ) as scene,
    ):
        warn(scene.warnings)
        ends = joints_from(args.start), joints_from(args.goal)
        motion, plan = solve_motion(scene, *ends, args.seed)
        if args.picture is not None:
            draw(scene, motion, plan, args.picture)
    if args.json:
        print_json(document(motion, plan))
    else:
        print(told(motion, plan))
    warn(plan.warnings)
    return DONE if plan.walk.free else NOT_TRUSTED
