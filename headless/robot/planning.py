# SPDX-License-Identifier: GPL-3.0-or-later
"""Paths round the obstacles: two sets of joint angles in, a path that was judged apart out."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from ...core.arrays import Array
from ...core.errors import InCollision, InvalidValue, NoPath
from .margins import uncertainty_margins
from .rrt import rrt_connect
from .scene import Gap, RobotScene
from .walk import Walk, walk

SAFETY_METRES = 0.010
# the arm's own shape is known; what is to be kept is only the slack of its joints
OWN_SAFETY_METRES = 0.005
# each attempt looks closer and keeps farther away: edge resolution (rad), extra margin (m)
ATTEMPTS = ((0.02, 0.0), (0.01, 0.002), (0.005, 0.004), (0.005, 0.008))
MOST_TESTS = 40_000
# a search that ends empty is tried once more from another seed; looking closer would not help it
MOST_MISSES = 2


@dataclass(frozen=True, eq=False)
class Plan:
    """A path of straight joint-space pieces through `waypoints` (K, n), and its judgement.

    `needs` are the metres kept from each thing by name: safety plus the object's uncertainty.
    `attempts` counts the searches; 0 when the straight motion was free already.
    """

    waypoints: Array
    walk: Walk
    needs: Mapping[str, float]
    attempts: int
    seconds: float
    warnings: tuple[str, ...] = field(default=())

    @property
    def length(self) -> float:
        """The path's length in joint space, radians."""
        return float(np.linalg.norm(np.diff(self.waypoints, axis=0), axis=1).sum())

    def poses(self, step: float = 0.05) -> Array:
        """The path as joint angles (N, n), evenly, no joint moving by more than `step` radians."""
        pieces = [self.waypoints[:1]]
        for a, b in pairwise(self.waypoints):
            count = max(1, int(np.ceil(np.abs(b - a).max() / step)))
            pieces.append(a + (b - a) * (np.arange(1, count + 1) / count)[:, None])
        return np.vstack(pieces)


def straight_motion(
    scene: RobotScene,
    start: ArrayLike,
    goal: ArrayLike,
    *,
    margins: Mapping[str, float] | None = None,
    safety: float = 0.0,
) -> Walk:
    """What the arm meets when all joints move evenly from `start` to `goal`, both (n,).

    With `safety` and `margins` zero, the default for `safety`, trouble means touching. `margins`
    are as for `plan_path`, but none without them.
    """
    ends = np.array([scene.arm.checked(start), scene.arm.checked(goal)])
    needs = _needs(scene, {} if margins is None else margins, safety)
    return walk(scene, ends, needs, 0.0)


def plan_path(
    scene: RobotScene,
    start: ArrayLike,
    goal: ArrayLike,
    *,
    margins: Mapping[str, float] | None = None,
    safety: float = SAFETY_METRES,
    seed: int = 1,
) -> Plan:
    """A path from `start` to `goal`, both (n,), that keeps `safety` + its margin from each thing.

    `margins` (metres by name) are 3 sigma of the objects' surfaces unless given. The path is found
    by RRT-Connect (Kuffner and LaValle 2000), shortened, and then walked anew in steps of 5 mrad by
    code of its own; where that judgement fails the search starts again, finer and farther away. The
    same arguments give the same path.

    Raises InCollision when an end is too near something, NoPath when no path passed.
    """
    began = time.perf_counter()
    ends = np.array([scene.arm.checked(start), scene.arm.checked(goal)])
    known = uncertainty_margins(scene.objects) if margins is None else margins
    needs = _needs(scene, known, safety)
    spare = min(
        _spare(scene, q, needs, end) for q, end in zip(ends, ("start", "goal"), strict=True)
    )
    waypoints, judged, attempts = _search(scene, ends, needs, spare, seed)
    return Plan(
        waypoints,
        judged,
        dict(zip(scene.names, needs, strict=True)),
        attempts,
        time.perf_counter() - began,
        _warnings(scene, margins, judged),
    )


def _search(
    scene: RobotScene, ends: Array, needs: Sequence[float], spare: float, seed: int
) -> tuple[Array, Walk, int]:
    straight = walk(scene, ends, needs, OWN_SAFETY_METRES)
    if straight.free:
        return ends, straight, 0
    judged: Walk | None = None
    missed = 0
    for attempt, (resolution, extra) in enumerate(ATTEMPTS):
        # the ends have to stay allowed, however far the path is to keep away
        more = min(extra, spare / 2) if judged is not None else 0.0
        waypoints = _found(scene, ends, [n + more for n in needs], resolution, seed + attempt)
        if waypoints is None:
            missed += 1
            if missed == MOST_MISSES:
                break
            continue
        judged = walk(scene, waypoints, needs, OWN_SAFETY_METRES)
        if judged.free:
            return waypoints, judged, attempt + 1
    raise NoPath(_why(judged, attempt + 1, max(needs, default=0.0)))


def _found(
    scene: RobotScene, ends: Array, needs: Sequence[float], resolution: float, seed: int
) -> Array | None:
    arm = scene.arm
    return rrt_connect(
        arm.lower,
        arm.upper,
        lambda joints: not scene.blocked(joints, needs, OWN_SAFETY_METRES),
        ends[0],
        ends[1],
        resolution=resolution,
        seed=seed,
        most_tests=MOST_TESTS,
    )


def _why(judged: Walk | None, searches: int, largest: float) -> str:
    tried = f"no path was found in {searches} searches of {MOST_TESTS} tests each at most"
    if judged is None or judged.worst is None:
        return (
            f"{tried}, keeping up to {largest * 1e3:.1f} mm; the goal may be walled in: "
            "choose another goal or a smaller safety distance"
        )
    worst = judged.worst
    return (
        f"{tried}: on the best one {worst.gap}, and {worst.needed * 1e3:.1f} mm are needed; "
        "choose another goal or a smaller safety distance"
    )


def _needs(scene: RobotScene, margins: Mapping[str, float], safety: float) -> list[float]:
    unknown = set(margins) - set(scene.names)
    if unknown:
        raise InvalidValue(
            f"margins: {', '.join(sorted(unknown))} is not in the scene; "
            f"there is {', '.join(scene.names) or 'nothing'}"
        )
    values = {"safety": safety, **margins}
    for name, value in values.items():
        if not 0 <= value < 1:
            raise InvalidValue(f"margins: {name}: {value:g} m is not from 0 to 1 m")
    return [safety + margins.get(name, 0.0) for name in scene.names]


def _spare(scene: RobotScene, joints: Array, needs: Sequence[float], end: str) -> float:
    """How much farther than needed everything is at one end. Raises InCollision."""
    scene.place(joints)
    spare = 1.0
    for i, need in enumerate(needs):
        gap = scene.gap(i, need + 1.0)
        if gap is not None:
            spare = min(spare, gap.distance - need)
            _refuse(gap, need, end)
    own = scene.own_gap(OWN_SAFETY_METRES)
    if own is not None:
        _refuse(own, OWN_SAFETY_METRES, end)
    return spare


def _refuse(gap: Gap, need: float, end: str) -> None:
    if gap.distance < need:
        raise InCollision(
            f"{end}: {gap}, and {need * 1e3:.1f} mm are needed (safety plus the object's "
            f"uncertainty); choose another {end}"
        )


def _warnings(
    scene: RobotScene, margins: Mapping[str, float] | None, judged: Walk
) -> tuple[str, ...]:
    found = []
    unsure = [thing.name for thing in scene.objects if thing.covariance is None]
    if margins is None and unsure:
        found.append(
            f"no uncertainty is known of {', '.join(unsure)}: "
            "they are kept at the safety distance alone"
        )
    found += [
        f"{mesh.name} has no exact shape: its convex hull is kept clear" for mesh in scene.meshes
    ]
    if judged.assured_clearance <= 0:
        found.append(
            f"between the checked poses the arm may come {judged.between * 1e3:.1f} mm nearer than "
            f"the {judged.assured_clearance * 1e3 + judged.between * 1e3:.1f} mm found"
        )
    return tuple(found)
