# SPDX-License-Identifier: GPL-3.0-or-later
"""A motion worth planning: obstacles in; two free ends whose straight connection hits one out."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from ...core.arrays import Array
from ...core.errors import InvalidValue, NoPath, Unreachable
from ...core.primitives import Primitive
from .margins import uncertainty_margins
from .planning import OWN_SAFETY_METRES, SAFETY_METRES, straight_motion
from .scene import RobotScene
from .walk import Walk

DOWN = (0.0, 0.0, -1.0)
# how far past the side of an object an end lies (rad about the base), and how high on it (part of
# its height): the first that serve are taken
PAST_SIDE, HEIGHTS = (0.35, 0.5, 0.7, 0.95), (0.5, 0.8, 1.1)
# a graze would vanish with the error of the model
DEEP_METRES = 0.010
STARTS = 4


@dataclass(frozen=True, eq=False)
class BlockedMotion:
    """Free joint angles `start` and `goal` (n,), and the straight motion between, which hits."""

    start: Array
    goal: Array
    straight: Walk


def blocked_motion(
    scene: RobotScene,
    names: Sequence[str] | None = None,
    *,
    margins: Mapping[str, float] | None = None,
    safety: float = SAFETY_METRES,
) -> BlockedMotion:
    """The first of `blocked_motions`. Raises NoPath when there is none."""
    for motion in blocked_motions(scene, names, margins=margins, safety=safety):
        return motion
    listed = ", ".join(scene.names if names is None else names)
    raise NoPath(
        f"no straight motion hits any of {listed} by {DEEP_METRES * 1e3:.0f} mm between two ends "
        f"that keep {safety * 1e3:.0f} mm: they may be out of the arm's reach or leave no room"
    )


def blocked_motions(
    scene: RobotScene,
    names: Sequence[str] | None = None,
    *,
    margins: Mapping[str, float] | None = None,
    safety: float = SAFETY_METRES,
) -> Iterator[BlockedMotion]:
    """Motions of the held ball (or the flange) past the objects `names`, all of them without.

    The hand points down on either side of an object, as far from the base as the object is, and
    both ends keep `safety` plus the object's margin (3 sigma unless given). The straight motion in
    joint space between them goes deepest, 10 mm at least, into one of `names`. Sought object by
    object on a fixed grid, so the same scene gives the same motions; it may give none.

    Raises InvalidValue for a name that is no object of the scene.
    """
    wanted = [_named(scene, name) for name in (scene.object_names if names is None else names)]
    known = uncertainty_margins(scene.objects) if margins is None else margins
    needs = [safety + known.get(name, 0.0) for name in scene.names]
    for thing, past, height in product(wanted, PAST_SIDE, HEIGHTS):
        ends = _ends(scene, thing, past, height, needs)
        if ends is None:
            continue
        straight = straight_motion(scene, *ends)
        worst = straight.worst
        hit = worst is not None and worst.gap.thing in [other.name for other in wanted]
        if worst is not None and hit and worst.gap.distance <= -DEEP_METRES:
            yield BlockedMotion(*ends, straight)


def _ends(
    scene: RobotScene, thing: Primitive, past: float, height: float, needs: Sequence[float]
) -> tuple[Array, Array] | None:
    """Free joint angles on either side of an object, None when one side has none."""
    arm, ball = scene.arm, scene.arm.ball
    point = np.zeros(3) if ball is None else ball.center_flange

    def free(joints: Array) -> bool:
        return not scene.blocked(joints, needs, OWN_SAFETY_METRES)

    places = _places(scene, thing, past, height)
    try:
        start = arm.joints_reaching(
            places[0], point_flange=point, pointing=DOWN, starts=STARTS, accept=free
        )
        # drawn to where it comes from, so that the straight motion is no wild swing
        goal = arm.joints_reaching(
            places[1], point_flange=point, pointing=DOWN, rest=start, starts=STARTS, accept=free
        )
    except Unreachable:
        return None
    return start, goal


def _places(scene: RobotScene, thing: Primitive, past: float, height: float) -> tuple[Array, Array]:
    """Two world points (3,) at the object's distance from the base, `past` its two sides."""
    base = scene.arm.world_from_base.translation
    away = thing.world_from_object.translation - base
    distance = float(np.hypot(away[0], away[1]))
    azimuth = float(np.arctan2(away[1], away[0]))
    half_angle = np.arcsin(min(1.0, float(np.linalg.norm(thing.half_extent[:2])) / distance))
    low = float((thing.world_from_object.rotation @ thing.half_extent)[2])
    z = thing.world_from_object.translation[2] + abs(low) * (2 * height - 1)
    turns = (azimuth - half_angle - past, azimuth + half_angle + past)
    first, second = (
        np.array([*(base[:2] + distance * np.array([np.cos(a), np.sin(a)])), z]) for a in turns
    )
    return first, second


def _named(scene: RobotScene, name: str) -> Primitive:
    for thing in scene.objects:
        if thing.name == name:
            return thing
    raise InvalidValue(
        f"no object of the scene is called {name!r}; there is {', '.join(scene.object_names)}"
    )
