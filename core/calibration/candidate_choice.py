# SPDX-License-Identifier: GPL-3.0-or-later
"""Which of several round things is the ball: candidates of each picture in, one of each out.

A robot's joints are round too. Whatever stands out most in each picture alone need not be the ball;
what fits the ball's known places in all pictures at once is.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations, product

import numpy as np

from ..arrays import Array
from ..ball.outline import SphereOutline
from ..errors import DegeneratePositions
from ..pose import Pose
from .pose_search import start_pose_of

MOST_HYPOTHESES = 300
# misfits beyond these count as no agreement: across the line of sight in ball radii, depth in share
ACROSS, DEPTH = 0.35, 0.2


def choose_candidates(
    positions_world: Array, candidates: Sequence[Sequence[SphereOutline]]
) -> list[SphereOutline | None]:
    """For S positions (S, 3) and the outlines found in each picture, the ones that fit together.

    None stands where nothing fits, or nothing was found. Three candidates make a pose; the pose
    that the most pictures agree with, closest, wins.
    """
    best: tuple[float, list[SphereOutline | None]] | None = None
    for triple in _hypotheses(candidates):
        try:
            pose = start_pose_of(
                positions_world[[i for i, _ in triple]],
                np.array([outline.centre_camera for _, outline in triple]),
            )
        except DegeneratePositions:
            continue
        cost, chosen = _chosen(positions_world, candidates, pose)
        if best is None or cost < best[0]:
            best = (cost, chosen)
    return [None] * len(candidates) if best is None else best[1]


def _hypotheses(
    candidates: Sequence[Sequence[SphereOutline]],
) -> list[tuple[tuple[int, SphereOutline], ...]]:
    """Triples of candidates of three pictures, at most so many, drawn from all."""
    seen = [i for i, outlines in enumerate(candidates) if outlines]
    rng = np.random.default_rng(0)
    triples = list(combinations(seen, 3))
    share = max(1, MOST_HYPOTHESES // max(1, len(triples)))
    drawn: list[tuple[tuple[int, SphereOutline], ...]] = []
    for triple in triples:
        combos = list(product(*([(i, o) for o in candidates[i]] for i in triple)))
        if len(combos) > share:
            combos = [combos[k] for k in sorted(rng.choice(len(combos), share, replace=False))]
        drawn += combos
    if len(drawn) > MOST_HYPOTHESES:
        drawn = [drawn[k] for k in sorted(rng.choice(len(drawn), MOST_HYPOTHESES, replace=False))]
    return drawn


def _chosen(
    positions_world: Array, candidates: Sequence[Sequence[SphereOutline]], pose: Pose
) -> tuple[float, list[SphereOutline | None]]:
    total, chosen = 0.0, []
    for predicted, outlines in zip(pose.apply(positions_world), candidates, strict=True):
        costs = [_cost(predicted, outline) for outline in outlines]
        nearest = int(np.argmin(costs)) if costs else -1
        agrees = bool(costs) and costs[nearest] < 1.0
        total += costs[nearest] if agrees else 1.0
        chosen.append(outlines[nearest] if agrees else None)
    return total, chosen


def _cost(predicted: Array, outline: SphereOutline) -> float:
    """How far a candidate is from where a pose puts the ball; 1 and more is elsewhere."""
    found = outline.centre_camera
    distance, expected = float(np.linalg.norm(found)), float(np.linalg.norm(predicted))
    angle = float(np.arctan2(np.linalg.norm(np.cross(predicted, found)), predicted @ found))
    across = angle * distance / outline.radius / ACROSS
    along = (expected / distance - 1) / DEPTH
    return across * across + along * along
