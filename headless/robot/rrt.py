# SPDX-License-Identifier: GPL-3.0-or-later
"""OMPL's RRT-Connect: limits, a test of joint angles, two ends in; shortened waypoints out.

Everything that ends the search counts tests, not seconds, and each call seeds OMPL anew, so that
the same call gives the same path on any machine, in a process that planned before, too.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ...core.arrays import Array
from ...core.errors import MissingPackage

SHORTCUTS = 60


def rrt_connect(
    lower: Array,
    upper: Array,
    valid: Callable[[Array], bool],
    start: Array,
    goal: Array,
    *,
    resolution: float,
    seed: int,
    most_tests: int,
) -> Array | None:
    """Waypoints (K, n) from `start` to `goal`, None when `most_tests` tests did not find any.

    Edges are tested every `resolution` radians of joint-space length. Raises MissingPackage.
    """
    base, geometric = _quiet_ompl(seed)
    tests = 0

    def tested(state: Any) -> bool:
        nonlocal tests
        tests += 1
        return valid(np.array(state[0 : len(lower)]))

    space = base.RealVectorStateSpace(len(lower))
    bounds = base.RealVectorBounds(len(lower))
    for i in range(len(lower)):
        bounds.setLow(i, float(lower[i]))
        bounds.setHigh(i, float(upper[i]))
    space.setBounds(bounds)
    setup = geometric.SimpleSetup(space)
    information = setup.getSpaceInformation()
    setup.setStateValidityChecker(tested)
    information.setStateValidityCheckingResolution(resolution / space.getMaximumExtent())
    setup.setStartAndGoalStates(*(_state(space, q, lower, upper) for q in (start, goal)))
    setup.setPlanner(geometric.RRTConnect(information))
    setup.solve(base.PlannerTerminationCondition(lambda: tests >= most_tests))
    # a path that only comes near the goal counts as solved for OMPL, not for a robot
    if not setup.haveExactSolutionPath():
        return None
    path = setup.getSolutionPath()
    _shorten(geometric.PathSimplifier(information), path)
    return np.array([state[0 : len(lower)] for state in path.getStates()])


def _shorten(simplifier: Any, path: Any) -> None:
    for _ in range(3):
        simplifier.reduceVertices(path, SHORTCUTS, SHORTCUTS)
        simplifier.partialShortcutPath(path, SHORTCUTS, SHORTCUTS)
    simplifier.reduceVertices(path, SHORTCUTS, SHORTCUTS)


def _state(space: Any, joints: Array, lower: Array, upper: Array) -> Any:
    state = space.allocState()
    state[0 : len(joints)] = np.clip(joints, lower, upper).tolist()
    return state


def _quiet_ompl(seed: int) -> tuple[Any, Any]:
    try:
        from ompl import base, geometric, util
    except ImportError:
        raise MissingPackage(
            "ompl is not installed; install it with: pip install 'monocell[robot]'"
        ) from None
    # OMPL warns at every seeding but the first, though generators made from now on obey it
    util.setLogLevel(util.LOG_NONE)
    util.RNG.setSeed(seed)
    return base, geometric
