# SPDX-License-Identifier: GPL-3.0-or-later
"""An honest hand: a solid, an eye and what stands around in, the points that it would pick out.

Only what is really seen is picked. A hand turns points of the world into pixels, each a little off.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from monocell.core.ball.sphere import outline_rays
from monocell.core.camera import Camera
from monocell.core.primitives import Box, Cylinder, Primitive, Sphere
from sight import seen

# places along a curve at which it is looked whether it is seen
PLACES = 121
RIM_PICKS, SIDE_PICKS, OUTLINE_PICKS = 10, 5, 10
# an arc's very ends, where it turns into the silhouette, are no place to pick
ARC_SHARE, SIDE_SHARE = 0.97, 0.45
# base corners in order round the base
ROUND = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])

Pixels = list[list[float] | None]
Hand = Callable[[np.ndarray], Pixels]


def hand_of(camera: Camera, rng: np.random.Generator, sigma_pixels: float) -> Hand:
    """A hand that puts a point (N, 3) where the camera shows it, with a normal error."""

    def hand(points: np.ndarray) -> Pixels:
        pixels = camera.project(points) + rng.normal(0, sigma_pixels, (len(points), 2))
        return pixels.tolist()

    return hand


def box_corners(box: Box, side: float) -> np.ndarray:
    """The four corners of the base (-1) or top (1) in the order of `ROUND`, (4, 3)."""
    local = np.column_stack([ROUND, np.full(4, side)]) * box.half_extent
    return box.world_from_object.apply(local)


def corners_seen(box: Box, side: float, eye: np.ndarray, others: Sequence[Primitive]) -> np.ndarray:
    """Which of these neither the box itself nor another thing hides, (4,)."""
    local = box.world_from_object.inverse().apply(eye)
    signs = np.column_stack([ROUND, np.full(4, side)])
    faces_eye = (signs * local > box.half_extent).any(axis=1)
    return faces_eye & seen(eye, box_corners(box, side), others)


def rim_seen(
    can: Cylinder, side: float, eye: np.ndarray, others: Sequence[Primitive]
) -> np.ndarray:
    """Points (N, 3) of the base (-1) or top rim (1) that are seen, from one end of it to the other.

    Of a rim that is seen whole, from the point nearest to the eye all the way round.
    """
    local, facing, limb = _as_seen(can, eye)
    whole = side * local[2] > can.height / 2
    reach = np.pi * (1 - 1 / PLACES) if whole else ARC_SHARE * limb
    angles = facing + reach * np.linspace(-1, 1, PLACES) + (np.pi if whole else 0.0)
    x, y = can.radius * np.cos(angles), can.radius * np.sin(angles)
    rim = can.world_from_object.apply(
        np.stack([x, y, np.full_like(x, side * can.height / 2)], axis=1)
    )
    return rim[seen(eye, rim, others)]


def sides_seen(can: Cylinder, eye: np.ndarray, others: Sequence[Primitive]) -> list[np.ndarray]:
    """Points (N, 3) that are seen of each of the two silhouette lines."""
    _, facing, limb = _as_seen(can, eye)
    lines = []
    for angle in (facing - limb, facing + limb):
        x, y = can.radius * np.cos(angle), can.radius * np.sin(angle)
        levels = np.linspace(-SIDE_SHARE, SIDE_SHARE, PLACES) * can.height
        local = np.column_stack([np.full(PLACES, x), np.full(PLACES, y), levels])
        line = can.world_from_object.apply(local)
        lines.append(line[seen(eye, line, others)])
    return lines


def can_picks(
    can: Cylinder, eye: np.ndarray, others: Sequence[Primitive], hand: Hand
) -> dict[str, Pixels]:
    """Ten points of what is seen of each rim, five of each silhouette line."""
    sides = [spread(line, SIDE_PICKS) for line in sides_seen(can, eye, others)]
    points = {
        "rim": spread(rim_seen(can, -1.0, eye, others), RIM_PICKS),
        "top": spread(rim_seen(can, 1.0, eye, others), RIM_PICKS),
        "sides": np.concatenate(sides),
    }
    return {role: hand(where) for role, where in points.items() if len(where)}


def box_picks(
    box: Box, eye: np.ndarray, others: Sequence[Primitive], hand: Hand
) -> dict[str, Pixels]:
    """Every corner that is seen, null for the others."""
    picks = {}
    for role, side in (("base", -1.0), ("top", 1.0)):
        kept = corners_seen(box, side, eye, others)
        pixels = hand(box_corners(box, side))
        picks[role] = [p if keep else None for p, keep in zip(pixels, kept, strict=True)]
    return {role: pixels for role, pixels in picks.items() if any(pixels)}


def ball_picks(
    ball: Sphere, camera: Camera, others: Sequence[Primitive], hand: Hand
) -> dict[str, Pixels]:
    """Ten points of what is seen of its outline."""
    to_ball = camera.pose.apply(ball.world_from_object.translation)
    angles = np.arange(PLACES) * (2 * np.pi / PLACES)
    rays = outline_rays(to_ball, ball.radius, angles)
    touched = camera.pose.inverse().apply(rays * np.sqrt(to_ball @ to_ball - ball.radius**2))
    kept = touched[seen(camera.centre_world, touched, others)]
    return {"outline": hand(spread(kept, OUTLINE_PICKS))}


def spread(points: np.ndarray, count: int) -> np.ndarray:
    """At most so many of the points, evenly from the first to the last."""
    if len(points) <= count:
        return points
    return points[np.rint(np.linspace(0, len(points) - 1, count)).astype(int)]


def _as_seen(can: Cylinder, eye: np.ndarray) -> tuple[np.ndarray, float, float]:
    """The eye in the can's frame, its direction, and how far round from there its side is seen."""
    local = can.world_from_object.inverse().apply(eye)
    facing = float(np.arctan2(local[1], local[0]))
    return local, facing, float(np.arccos(can.radius / np.hypot(*local[:2])))
