# SPDX-License-Identifier: GPL-3.0-or-later
"""Inverse kinematics: where the flange shall be goes in, joint angles within the limits come out.

Levenberg-Marquardt on the geometric jacobian from several starts: first drawn gently to the rest
angles, which settles what the goal leaves free, then to the goal alone, which makes it exact.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ...core.arrays import Array, frozen
from ...core.errors import InvalidValue, Unreachable
from ...core.least_squares import levenberg_marquardt
from ...core.pose import Pose
from ...core.rotation import hat

if TYPE_CHECKING:
    from .arm import Arm

# what one unit of residual means while the joints are still drawn to rest
METRES, AXIS_LENGTHS, REST_RADIANS = 1e-3, 5e-3, 1.0
# what counts as reached
POSITION_TOLERANCE, AXIS_TOLERANCE = 1e-5, 1e-4


@dataclass(frozen=True, eq=False)
class Goal:
    """A point (3,) of the flange to be at `position` (3,), and flange axes to have directions.

    `axes_flange` (k, 3) shall become `directions_world` (k, 3); with k = 0 the turn is left free.
    """

    position: Array
    point_flange: Array
    axes_flange: Array
    directions_world: Array

    @staticmethod
    def of(target: Pose | ArrayLike, point_flange: ArrayLike, pointing: ArrayLike | None) -> Goal:
        """A whole `world_from_flange`, or a position with, if given, where the flange's z points.

        Raises InvalidValue when a pose comes with a direction as well.
        """
        point = frozen(point_flange, (3,), "point_flange")
        if isinstance(target, Pose):
            if pointing is not None:
                raise InvalidValue("pointing: the pose says already where the flange points")
            return Goal(target.apply(point), point, np.eye(3), target.rotation.T)
        position = frozen(target, (3,), "target position")
        if pointing is None:
            return Goal(position, point, np.empty((0, 3)), np.empty((0, 3)))
        z = frozen(pointing, (3,), "pointing")
        if np.linalg.norm(z) < 1e-9:
            raise InvalidValue("pointing: has no length, so it gives no direction")
        return Goal(position, point, np.array([[0.0, 0, 1]]), (z / np.linalg.norm(z))[None])

    def errors(self, arm: Arm, joints: Array) -> tuple[Array, Array]:
        """How far off in metres (3,), and the difference of each axis (k, 3)."""
        flange = arm.world_from_flange(joints)
        axes = flange.rotate(self.axes_flange) - self.directions_world
        return flange.apply(self.point_flange) - self.position, axes

    def reached(self, arm: Arm, joints: Array) -> bool:
        """Whether the joints are at the goal to 0.01 mm and 0.1 mrad."""
        metres, axes = self.errors(arm, joints)
        turned = float(np.abs(axes).max()) if axes.size else 0.0
        return float(np.linalg.norm(metres)) < POSITION_TOLERANCE and turned < AXIS_TOLERANCE


def reach(
    arm: Arm,
    goal: Goal,
    rest: ArrayLike,
    seed: int,
    starts: int,
    accept: Callable[[Array], bool] | None,
) -> Array:
    """The first joint angles (n,) found that reach the goal and that `accept` lets pass.

    Starts at `rest`, then at random angles that `seed` determines. The goal is met to 0.01 mm and
    0.1 mrad. Raises Unreachable with the smallest miss, or with how many answers were refused.
    """
    drawn_to = arm.checked(rest)
    refused, nearest = 0, (np.inf, np.inf)
    for start in _starts(arm, drawn_to, seed, starts):
        # once an answer was refused, others must differ: each keeps to where it starts
        joints = _descended(arm, goal, start, start if refused else drawn_to)
        if goal.reached(arm, joints):
            if accept is None or accept(joints):
                return joints
            refused += 1
        nearest = min(nearest, _miss(arm, goal, joints))
    x, y, z = goal.position
    there = f"no joint angles bring the arm to ({x:.3f}, {y:.3f}, {z:.3f}) m"
    if refused:
        raise Unreachable(
            f"{there} without touching: {refused} of {starts} starts reached it and all of them "
            "collide; choose a place with more room"
        )
    raise Unreachable(
        f"{there} within the joint limits: the nearest of {starts} starts misses by "
        f"{nearest[0] * 1e3:.1f} mm and {np.degrees(nearest[1]):.1f} degrees; "
        "choose a place nearer the base or free the direction"
    )


def _starts(arm: Arm, rest: Array, seed: int, starts: int) -> Iterator[Array]:
    yield rest
    random = np.random.default_rng(seed)
    for _ in range(starts - 1):
        yield random.uniform(arm.lower, arm.upper)


def _descended(arm: Arm, goal: Goal, start: Array, rest: Array) -> Array:
    def move(joints: Array, step: Array) -> Array:
        return np.clip(joints + step, arm.lower, arm.upper)

    def to_goal(joints: Array) -> tuple[Array, Array]:
        metres, axes = goal.errors(arm, joints)
        flange = arm.world_from_link(arm.flange)
        moves, turns = arm.jacobian(joints, flange.apply(goal.point_flange))
        tips = flange.rotate(goal.axes_flange)
        residuals = np.concatenate([metres / METRES, axes.ravel() / AXIS_LENGTHS])
        by_turning = [-hat(tip) @ turns / AXIS_LENGTHS for tip in tips]
        return residuals, np.concatenate([moves / METRES, *by_turning])

    def drawn(joints: Array) -> tuple[Array, Array]:
        residuals, jacobian = to_goal(joints)
        pull = np.eye(len(joints)) / REST_RADIANS
        return np.concatenate([residuals, pull @ (joints - rest)]), np.vstack([jacobian, pull])

    near = levenberg_marquardt(start, drawn, move, steps=60, tolerance=1e-4).value
    return levenberg_marquardt(near, to_goal, move, steps=30).value


def _miss(arm: Arm, goal: Goal, joints: Array) -> tuple[float, float]:
    metres, axes = goal.errors(arm, joints)
    # chord to angle
    worst = float(np.linalg.norm(axes, axis=1).max()) if len(axes) else 0.0
    return float(np.linalg.norm(metres)), 2 * float(np.arcsin(min(1.0, worst / 2)))
