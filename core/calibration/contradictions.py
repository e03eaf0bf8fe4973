# SPDX-License-Identifier: GPL-3.0-or-later
"""Sightings that fit no pose: what was found and where it should be in, what to check out."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from ..arrays import Array, Mask
from ..errors import DegeneratePositions
from .seen import Beliefs, Seen
from .start_poses import start_pose_of

# balls this many times farther apart than their positions betray a mistaken unit
MISTAKEN_UNIT_LOW, MISTAKEN_UNIT_HIGH = 0.03, 30.0
# and by this share, another radius: half of it, where the diameter was given
MISTAKEN_RADIUS = 0.15
# of so many sightings at most every pair is exchanged on trial
MOST_EXCHANGED, LOOKED_AT = 12, 60


def what_to_check(seen: Sequence[Seen]) -> str:
    """What a person should look at first when nothing fits."""
    balls = [one for one in seen if one.is_ball and one.place.offset is not None]
    usual = "check that every picture is the one of its position, then positions and intrinsics"
    if len(balls) < 3:
        return usual
    pair = exchanged_pair(balls)
    if pair is not None:
        return f"with sightings {pair[0]} and {pair[1]} exchanged all fit: were they mixed up?"
    return wrong_size(balls) or usual


def wrong_size(balls: Sequence[Seen]) -> str | None:
    """A mistaken unit or radius shows in how far the balls found are apart, against the places."""
    found, given, radius = _apart(balls)
    if found < radius:
        return "the ball is in the same place in all pictures: are they the right ones?"
    if given <= 0 or not MISTAKEN_UNIT_LOW < found / given < MISTAKEN_UNIT_HIGH:
        return (
            f"with a radius of {radius:g} m the balls found are {found:.3g} m apart, the positions "
            f"given {given:.3g} m: is one of them in millimetres?"
        )
    if abs(np.log(found / given)) > MISTAKEN_RADIUS:
        return (
            f"the balls found are {found / given:.2f} times as far apart as the positions given: "
            f"is the radius about {1e3 * radius * given / found:.3g} mm and not "
            f"{1e3 * radius:.3g}, or the diameter given for it?"
        )
    return None


def mistaken_unit(seen: Sequence[Seen]) -> str | None:
    """`wrong_size`, but only of what is beyond doubt."""
    balls = [one for one in seen if one.is_ball and one.place.offset is not None]
    if len(balls) < 3:
        return None
    found, given, radius = _apart(balls)
    mistaken = given > 0 and not MISTAKEN_UNIT_LOW < found / given < MISTAKEN_UNIT_HIGH
    return wrong_size(balls) if mistaken and found > radius else None


def exchanged_pair(balls: Sequence[Seen]) -> tuple[int, int] | None:
    """The two sightings whose exchange makes all fit, where there is one such pair."""
    if not 4 <= len(balls) <= MOST_EXCHANGED:
        return None
    beliefs = Beliefs.of(balls)
    places = np.array([one.place.in_base() for one in balls])
    centres = np.array([one.hint.centre_camera for one in balls])
    fits = []
    for i, j in combinations(range(len(balls)), 2):
        order = np.arange(len(balls))
        order[[i, j]] = j, i
        try:
            pose = start_pose_of(places[order], centres)
        except DegeneratePositions:
            return None
        if (beliefs.disagreement(pose.apply(places[order])) < 1).all():
            fits.append((i, j))
    return fits[0] if len(fits) == 1 else None


def mixed_up(seen: Sequence[Seen], used: Mask, predicted_camera: Array) -> dict[int, int]:
    """Of the sightings left out: whose expected place (S, 3) each of them was found at."""
    left_out = np.flatnonzero(~used)
    beliefs = Beliefs.of([seen[i] for i in left_out])
    found: dict[int, int] = {}
    for k in range(len(seen)):
        here = np.broadcast_to(predicted_camera[k], (len(left_out), 3))
        for i in left_out[beliefs.disagreement(here) < 1]:
            if i != k:
                found[int(i)] = k
    return found


def _apart(balls: Sequence[Seen]) -> tuple[float, float, float]:
    """How far apart balls are in the middle, found and given, and the radius they were found by."""
    chosen = balls[:: max(1, len(balls) // LOOKED_AT)]
    found = np.array([one.hint.centre_camera for one in chosen])
    given = np.array([one.place.in_base() for one in chosen])
    radii = [one.outline.radius for one in chosen if one.outline is not None]
    return _middle_distance(found), _middle_distance(given), float(np.median(radii))


def _middle_distance(places: Array) -> float:
    apart = np.linalg.norm(places[:, None] - places, axis=2)
    return float(np.median(apart[np.triu_indices(len(places), 1)]))
