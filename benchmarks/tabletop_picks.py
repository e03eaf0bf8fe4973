# SPDX-License-Identifier: GPL-3.0-or-later
"""What an honest hand picks of a table top: a plan and a way of picking in, sketches out.

- `fewest`: three base corners of a box and one above them; of a can three points of its base rim,
  where a quarter of it is seen or more, and one of its top rim
- `all`: every corner of a box that is seen; of a can ten points of what is seen of each rim and
  five of each silhouette line

A thing of which not even the fewest are seen gives no sketch.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from honest_hand import (
    Hand,
    Pixels,
    box_corners,
    box_picks,
    can_picks,
    corners_seen,
    hand_of,
    rim_seen,
    spread,
)
from monocell.core.primitives import Box, Cylinder, Primitive
from monocell.core.sketch import Sketch
from tabletop_plans import TabletopPlan

PICK_SIGMA_PIXELS = 1.0
WAYS = ("fewest", "all")
# nobody takes three points of a shorter arc for a circle
LEAST_TURN = np.pi / 2


def sketches(
    plan: TabletopPlan, way: str, *, sigma_pixels: float = PICK_SIGMA_PIXELS, trial: int = 0
) -> list[Sketch | None]:
    """What the hand picks of each thing of the plan; None for a thing too little of which is seen.

    The picks are of the picture as the true camera takes it, whatever is believed of that camera.
    """
    rng = np.random.default_rng([103, plan.seed, WAYS.index(way), trial])
    hand = hand_of(plan.camera, rng, sigma_pixels)
    return [_sketch(plan, i, way, hand) for i in range(len(plan.things))]


def _sketch(plan: TabletopPlan, i: int, way: str, hand: Hand) -> Sketch | None:
    thing = plan.things[i]
    others = plan.things[:i] + plan.things[i + 1 :]
    eye = plan.camera.centre_world
    if isinstance(thing, Box):
        few, every = _few_of_box, box_picks
    else:
        few, every = _few_of_can, can_picks
    picks = (few if way == "fewest" else every)(thing, eye, others, hand)
    return None if picks is None else Sketch(thing.name, thing.kind, "table", picks)


def _few_of_box(
    box: Box, eye: np.ndarray, others: Sequence[Primitive], hand: Hand
) -> dict[str, Pixels] | None:
    """The three base corners that are seen, and the corner above the middle one or another."""
    base_seen, top_seen = (corners_seen(box, side, eye, others) for side in (-1.0, 1.0))
    if base_seen.sum() < 3:
        return None
    # the corner that is not seen comes last: the hand begins beside it
    order = np.roll(np.arange(4), -int(np.argmin(base_seen)) - 1)
    above = next((k for k in (1, 0, 2, 3) if top_seen[order[k]]), None)
    if above is None:
        return None
    top = box_corners(box, 1.0)[order[[above]]]
    return {"base": hand(box_corners(box, -1.0)[order[:3]]), "top": [*[None] * above, *hand(top)]}


def _few_of_can(
    can: Cylinder, eye: np.ndarray, others: Sequence[Primitive], hand: Hand
) -> dict[str, Pixels] | None:
    """Three points of the base rim, as far apart as they are seen, and the nearest of the top."""
    rim, top = (rim_seen(can, side, eye, others) for side in (-1.0, 1.0))
    if not len(top) or _turn(can, rim) < LEAST_TURN:
        return None
    nearest = int(np.argmin(np.linalg.norm(top - eye, axis=1)))
    return {"rim": hand(spread(rim, 3)), "top": hand(top[[nearest]])}


def _turn(can: Cylinder, rim: np.ndarray) -> float:
    """The angle from the first to the last of points (N, 3) in order round a rim."""
    if len(rim) < 3:
        return 0.0
    x, y, _ = can.world_from_object.inverse().apply(rim).T
    return float(np.ptp(np.unwrap(np.arctan2(y, x))))
