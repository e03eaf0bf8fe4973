# SPDX-License-Identifier: GPL-3.0-or-later
"""The robot's part of the work: an environment and an arm in, what collides and a free path out."""

from __future__ import annotations

from argparse import ArgumentTypeError
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..core.arrays import Array
from .told import pairs

if TYPE_CHECKING:
    from .robot.demo_motion import BlockedMotion
    from .robot.planning import Plan
    from .robot.scene import RobotScene


LARGEST_SEED = 2**31 - 1


def solve_motion(
    scene: RobotScene, start: Array | None, goal: Array | None, seed: int
) -> tuple[BlockedMotion, Plan]:
    """The straight motion between two ends and a path that is free.

    Without ends, the first motion past an object that is blocked and has a free way round. Raises
    NoPath when there is none, InCollision when an end is too near something.
    """
    from ..core.errors import NoPath
    from .robot.demo_motion import BlockedMotion, blocked_motions
    from .robot.planning import plan_path, straight_motion

    if start is not None and goal is not None:
        motion = BlockedMotion(start, goal, straight_motion(scene, start, goal))
        return motion, plan_path(scene, start, goal, seed=seed)
    refusal: NoPath | None = None
    for motion in blocked_motions(scene):
        try:
            return motion, plan_path(scene, motion.start, motion.goal, seed=seed)
        except NoPath as error:
            refusal = error
    raise refusal or NoPath(
        "no straight motion of the arm past the objects is blocked, so there is nothing to plan "
        "around; give --start and --goal"
    )


def told(motion: BlockedMotion, plan: Plan) -> str:
    """What the straight motion hits, and how far the path keeps away."""
    worst = motion.straight.worst
    straight = "free" if worst is None else str(worst.gap)
    nearest = plan.walk.nearest
    rows = [
        ("straight motion", straight),
        ("path", f"{len(plan.waypoints)} waypoints, {plan.length:.2f} rad, {plan.seconds:.2f} s"),
        ("minimum clearance", "nothing near" if nearest is None else str(nearest.gap)),
        ("checked again", f"{plan.walk.poses} poses, free: {'yes' if plan.walk.free else 'NO'}"),
    ]
    return pairs(rows)


def document(motion: BlockedMotion, plan: Plan) -> dict[str, Any]:
    """The same as JSON values."""
    worst, nearest = motion.straight.worst, plan.walk.nearest
    return {
        "start": motion.start,
        "goal": motion.goal,
        "straight_motion": {
            "free": worst is None,
            "worst": None if worst is None else str(worst.gap),
        },
        "path": {
            "waypoints": plan.waypoints,
            "length": plan.length,
            "free": plan.walk.free,
            "minimum_clearance": None if nearest is None else nearest.gap.distance,
            "nearest": None if nearest is None else str(nearest.gap),
            "needs": dict(plan.needs),
        },
        "warnings": plan.warnings,
    }


def draw(scene: RobotScene, motion: BlockedMotion, plan: Plan, path: Path) -> None:
    """The PyBullet scene with the blocked motion and the free path."""
    from .robot.picture import draw_scene

    straight = np.linspace(motion.start, motion.goal, 30)
    draw_scene(scene, path, joints=motion.start, path=plan.poses(), blocked=straight)


def seed_from(text: str) -> int:
    """A seed as given on the command line, for argparse: NumPy and OMPL take 32 bits, unsigned."""
    if not text.isdecimal() or int(text) > LARGEST_SEED:
        raise ArgumentTypeError(f"must be a whole number from 0 to {LARGEST_SEED}, got {text!r}")
    return int(text)


def joints_from(values: Sequence[float] | None) -> Array | None:
    """Joint angles as given on the command line, or none."""
    return None if values is None else np.array(values, dtype=float)
