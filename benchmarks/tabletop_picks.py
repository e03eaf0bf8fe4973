# SPDX-License-Identifier: GPL-3.0-or-later
"""An honest hand at a table top: what it really sees of each thing, picked with a normal error.

- `fewest`: three base corners of a box and one above them; of a can three points of its base rim
  and one of its top rim
- `all`: every corner of a box that is seen; of a can ten points of what is seen of each rim and
  five of each silhouette line

A thing of which not even the fewest are seen gives no sketch.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from monocell.core.primitives import Box, Cylinder, Primitive
from monocell.core.sketch import Sketch
from sight import seen
from tabletop_plans import TabletopPlan

PICK_SIGMA_PIXELS = 1.0
WAYS = ("fewest", "all")
# places along a curve at which it is looked whether it is seen
PLACES = 121
RIM_PICKS, SIDE_PICKS = 10, 5
# base corners in order round the base
ROUND = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])

Pixels = list[list[float] | None]
# points (N, 3) of the world, and whether a corner's own faces look away (N,), to pixels or None
Hand = Callable[[np.ndarray], Pixels]


def sketches(
    plan: TabletopPlan, way: str, *, sigma_pixels: float = PICK_SIGMA_PIXELS, trial: int = 0
) -> list[Sketch | None]:
    """What the hand picks of each thing of the plan; None for a thing too little of which is seen.

    The picks are of the picture as the true camera takes it, whatever is believed of that camera.
    """
    rng = np.random.default_rng([103, plan.seed, WAYS.index(way), trial])

    def hand(points: np.ndarray) -> Pixels:
        pixels = plan.camera.project(points) + rng.normal(0, sigma_pixels, (len(points), 2))
        return pixels.tolist()

    return [_sketch(plan, i, way, hand) for i in range(len(plan.things))]


def _sketch(plan: TabletopPlan, i: int, way: str, hand: Hand) -> Sketch | None:
    thing = plan.things[i]
    others = plan.things[:i] + plan.things[i + 1 :]
    eye = plan.camera.centre_world
    pick = _box_picks if isinstance(thing, Box) else _can_picks
    picks = pick(thing, eye, others, way, hand)
    return None if picks is None else Sketch(thing.name, thing.kind, "table", picks)


def _box_picks(
    box: Box, eye: np.ndarray, others: tuple[Primitive, ...], way: str, hand: Hand
) -> dict[str, Pixels] | None:
    base, top = (_corners(box, side) for side in (-1.0, 1.0))
    base_seen, top_seen = (
        _faces_eye(box, eye, side) & seen(eye, points, others)
        for side, points in ((-1.0, base), (1.0, top))
    )
    # the corner that is not seen comes last: the hand begins beside it
    first = int(np.argmin(base_seen)) + 1
    order = np.roll(np.arange(4), -first)
    base, top, base_seen, top_seen = base[order], top[order], base_seen[order], top_seen[order]
    if base_seen.sum() < 3:
        return None if way == "fewest" else _some_corners(base, top, base_seen, top_seen, hand)
    if way == "fewest":
        # the upright edge nearest to the eye is the longest in the picture
        above = next((k for k in (1, 0, 2, 3) if top_seen[k]), None)
        if above is None:
            return None
        return {"base": hand(base[:3]), "top": [*[None] * above, *hand(top[above : above + 1])]}
    return {"base": hand(base[base_seen]), "top": _gaps(hand(top), top_seen)}


def _some_corners(
    base: np.ndarray, top: np.ndarray, base_seen: np.ndarray, top_seen: np.ndarray, hand: Hand
) -> dict[str, Pixels] | None:
    """Corners of a box of whose base two or fewer are seen."""
    return {"base": _gaps(hand(base), base_seen), "top": _gaps(hand(top), top_seen)}


def _gaps(pixels: Pixels, kept: np.ndarray) -> Pixels:
    return [pixel if keep else None for pixel, keep in zip(pixels, kept, strict=True)]


def _corners(box: Box, side: float) -> np.ndarray:
    local = np.column_stack([ROUND, np.full(4, side)]) * box.half_extent
    return box.world_from_object.apply(local)


def _faces_eye(box: Box, eye: np.ndarray, side: float) -> np.ndarray:
    """Of which corners of the base (-1) or top (1) the box itself hides nothing, (4,)."""
    local = box.world_from_object.inverse().apply(eye)
    signs = np.column_stack([ROUND, np.full(4, side)])
    return (signs * local > box.half_extent).any(axis=1)


def _can_picks(
    can: Cylinder, eye: np.ndarray, others: tuple[Primitive, ...], way: str, hand: Hand
) -> dict[str, Pixels] | None:
    local = can.world_from_object.inverse().apply(eye)
    facing, limb = np.arctan2(local[1], local[0]), np.arccos(can.radius / np.hypot(*local[:2]))
    rim = _arc(can, -1.0, facing + 0.97 * limb * np.linspace(-1, 1, PLACES))
    rim = rim[seen(eye, rim, others)]
    above = local[2] > can.height / 2
    top = _arc(can, 1.0, facing + (np.pi if above else 0.97 * limb) * np.linspace(-1, 1, PLACES))
    top_seen = seen(eye, top, others)
    if way == "fewest":
        front = np.abs(np.arange(PLACES) - PLACES // 2) + PLACES * ~top_seen
        if len(rim) < 3 or not top_seen.any():
            return None
        return {"rim": hand(_spread(rim, 3)), "top": hand(top[[np.argmin(front)]])}
    # both ends of a whole circle are one point
    top = top[:-1][top_seen[:-1]] if above else top[top_seen]
    sides = [_side(can, facing + sign * limb) for sign in (-1, 1)]
    kept = [_spread(line[seen(eye, line, others)], SIDE_PICKS) for line in sides]
    picks = {"rim": _spread(rim, RIM_PICKS), "top": _spread(top, RIM_PICKS)}
    picks["sides"] = np.concatenate(kept)
    return {role: hand(points) for role, points in picks.items() if len(points)}


def _arc(can: Cylinder, side: float, angles: np.ndarray) -> np.ndarray:
    x, y = can.radius * np.cos(angles), can.radius * np.sin(angles)
    return can.world_from_object.apply(
        np.stack([x, y, np.full_like(x, side * can.height / 2)], axis=1)
    )


def _side(can: Cylinder, angle: float) -> np.ndarray:
    x, y = can.radius * np.cos(angle), can.radius * np.sin(angle)
    levels = np.linspace(-0.45, 0.45, PLACES) * can.height
    return can.world_from_object.apply(
        np.column_stack([np.full(PLACES, x), np.full(PLACES, y), levels])
    )


def _spread(points: np.ndarray, count: int) -> np.ndarray:
    """At most so many of the points, evenly from the first to the last."""
    if len(points) <= count:
        return points
    return points[np.rint(np.linspace(0, len(points) - 1, count)).astype(int)]
