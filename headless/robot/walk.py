# SPDX-License-Identifier: GPL-3.0-or-later
"""A motion walked in small steps: joint angles in, the nearest gaps and the first trouble out.

This is the judge of the planner's paths, so it shares none of the planner's code: it asks for
distances link by link, where the planner asks whether anything is near.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ...core.arrays import Array
from .scene import EVERYWHERE, Gap, RobotScene
from .sweep import sweep_radii

STEP_RADIANS = 0.005
# between two checked poses no point of the arm is farther than this from where one of them has it
BETWEEN_METRES = 0.004


@dataclass(frozen=True, eq=False)
class Moment:
    """A gap on the way: at `joints` (n,), `fraction` (0 to 1) along the path, `needed` metres."""

    gap: Gap
    joints: Array
    fraction: float
    needed: float


@dataclass(frozen=True, eq=False)
class Walk:
    """What was found on the way; distances in metres.

    `troubles` names, in the order met, the things (or own links) that were nearer than needed.
    `nearest` is the smallest gap to a thing, None in an empty scene. `nearest_own` is the smallest
    gap between two links of the arm. `first_trouble` is the first gap smaller than needed, `worst`
    the one that falls short by most; None when the motion is free. `between` is how far any point
    of the arm can be, between checked poses, from where one of them has it.
    """

    nearest: Moment | None
    nearest_own: Moment | None
    first_trouble: Moment | None
    worst: Moment | None
    troubles: tuple[str, ...]
    between: float
    poses: int

    @property
    def free(self) -> bool:
        """Whether every gap was as large as needed at every pose."""
        return self.first_trouble is None

    @property
    def assured_clearance(self) -> float:
        """No thing is nearer than this anywhere on the way, between the checked poses too."""
        return EVERYWHERE if self.nearest is None else self.nearest.gap.distance - self.between


def walk(
    scene: RobotScene,
    waypoints: Array,
    needs: Sequence[float],
    own_need: float,
    step: float = STEP_RADIANS,
) -> Walk:
    """Walk straight in joint space from waypoint to waypoint (K, n), no joint by more than `step`.

    `needs` are the distances to keep from each thing of the scene, `own_need` between own links.
    """
    poses, fractions, between = _steps(waypoints, step, sweep_radii(scene))
    nearest: list[Moment] = []
    own: list[Moment] = []
    troubles: list[Moment] = []
    for joints, fraction in zip(poses, fractions, strict=True):
        scene.place(joints)
        for moment in _moments(scene, joints, float(fraction), needs, nearest):
            nearest = [min([*nearest, moment], key=_distance)]
            troubles += [moment] if moment.gap.distance < moment.needed else []
        gap = scene.own_gap(own[0].gap.distance if own else EVERYWHERE)
        if gap is not None:
            own = [Moment(gap, joints, float(fraction), own_need)]
            troubles += own if gap.distance < own_need else []
    return Walk(
        nearest[0] if nearest else None,
        own[0] if own else None,
        troubles[0] if troubles else None,
        min(troubles, key=lambda m: m.gap.distance - m.needed, default=None),
        tuple(dict.fromkeys(moment.gap.thing for moment in troubles)),
        between,
        len(poses),
    )


def _moments(
    scene: RobotScene,
    joints: Array,
    fraction: float,
    needs: Sequence[float],
    nearest: list[Moment],
) -> list[Moment]:
    """The gaps here that are a trouble or may be the smallest so far."""
    so_far = nearest[0].gap.distance if nearest else EVERYWHERE
    gaps = [(scene.gap(i, max(so_far, need)), need) for i, need in enumerate(needs)]
    return [Moment(gap, joints, fraction, need) for gap, need in gaps if gap is not None]


def _distance(moment: Moment) -> float:
    return moment.gap.distance


def _steps(waypoints: Array, step: float, radii: Array) -> tuple[Array, Array, float]:
    """Poses (N, n), their fractions of the path's length (N,), and half the largest sweep."""
    poses, between = [waypoints[:1]], 0.0
    for a, b in pairwise(waypoints):
        swept = float(radii @ np.abs(b - a))
        count = max(1, int(np.ceil(max(np.abs(b - a).max() / step, swept / (2 * BETWEEN_METRES)))))
        poses.append(a + (b - a) * (np.arange(1, count + 1) / count)[:, None])
        between = max(between, swept / count / 2)
    every = np.vstack(poses)
    lengths = np.concatenate([[0.0], np.linalg.norm(np.diff(every, axis=0), axis=1).cumsum()])
    return every, lengths / max(lengths[-1], 1e-12), between
