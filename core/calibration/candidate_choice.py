# SPDX-License-Identifier: GPL-3.0-or-later
"""Which of several round things is the ball: candidates of each sighting in, one of each out.

A robot's joints are round too, and several balls may show in one picture. Whatever stands out most
in each picture alone need not be the ball that a sighting means; what fits the places in all
sightings at once is.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..ball.outline import SphereOutline
from ..errors import DegeneratePositions
from .agreement import fewest, samples
from .seen import Beliefs, Seen
from .start_poses import Hint, Start, start_poses
from .twins import same_outline

MOST_HYPOTHESES, MOST_COSTLY, MOST_SAMPLES = 400, 60, 60
# balls found are as far apart as their places, but for this share of their distances
DEPTH_SHARE = 0.04


def choose_candidates(
    candidates: Sequence[Sequence[Seen]], pictures: Sequence[str]
) -> list[Seen | None]:
    """For the candidates of S sightings, in the pictures named, those that fit one pose together.

    None stands where nothing fits, or nothing was found. A few candidates make a pose; the pose
    that the most sightings agree with, closest, wins. No outline is given to two sightings.
    """
    everything = [one for listed in candidates for one in listed]
    owners = np.repeat(np.arange(len(candidates)), [len(listed) for listed in candidates])
    marks = _marks(everything, [pictures[i] for i in owners])
    beliefs = Beliefs.of(everything)
    best: tuple[float, dict[int, int]] | None = None
    for chosen in _hypotheses(candidates, owners, marks):
        for start in _starts([everything[c] for c in chosen]):
            centres = start.centres([one.place for one in everything])
            cost, given = _assigned(beliefs.disagreement(centres), owners, marks, len(candidates))
            if best is None or cost < best[0]:
                best = (cost, given)
    given = {} if best is None else best[1]
    return [everything[given[i]] if i in given else None for i in range(len(candidates))]


def _marks(everything: Sequence[Seen], pictures: Sequence[str]) -> NDArray[np.intp]:
    """A number for each thing seen; candidates that show the same thing have the same one."""
    marks = np.arange(len(everything))
    by_picture: dict[str, list[int]] = {}
    for c, (one, picture) in enumerate(zip(everything, pictures, strict=True)):
        known = by_picture.setdefault(picture, [])
        twin = next((k for k in known if _same_thing(one, everything[k])), None)
        if twin is None:
            known.append(c)
        else:
            marks[c] = marks[twin]
    return marks


def _same_thing(one: Seen, other: Seen) -> bool:
    if one.outline is None or other.outline is None:
        return one is other
    return same_outline(one.outline, other.outline)


def _hypotheses(
    candidates: Sequence[Sequence[Seen]], owners: NDArray[np.intp], marks: NDArray[np.intp]
) -> Iterator[tuple[int, ...]]:
    """Groups of candidates that make a pose, of sightings and things all different."""
    seen = [i for i, listed in enumerate(candidates) if listed]
    firsts = [candidates[i][0] for i in seen]
    if not firsts:
        return
    places = [one.place for one in firsts]
    size = fewest(places, [one.is_ball for one in firsts])
    cheap = all(one.is_ball and one.place.offset is not None for one in firsts)
    if len(seen) < size:
        return
    rng, left = np.random.default_rng(0), MOST_HYPOTHESES if cheap else MOST_COSTLY
    share = max(1, left // 12)
    everything = [one for listed in candidates for one in listed]
    for sample in samples(len(seen), size, MOST_SAMPLES):
        listed = [np.flatnonzero(owners == seen[k]).tolist() for k in sample]
        combos = [c for c in product(*listed) if len(set(marks[list(c)])) == size]
        if cheap:
            combos = [c for c in combos if _as_far_apart([everything[k] for k in c])]
        if len(combos) > share:
            combos = [combos[k] for k in rng.choice(len(combos), share, replace=False)]
        yield from combos[:left]
        left -= len(combos)
        if left <= 0:
            return


def _as_far_apart(three: Sequence[Seen]) -> bool:
    """Whether balls are about as far apart as their places, which most wrong triples are not."""
    found = np.array([one.hint.centre_camera for one in three])
    given = np.array([one.place.in_base() for one in three])
    for i, j in ((0, 1), (0, 2), (1, 2)):
        off = np.linalg.norm(found[i] - found[j]) - np.linalg.norm(given[i] - given[j])
        reach = np.linalg.norm(found[i]) + np.linalg.norm(found[j])
        if abs(off) > DEPTH_SHARE * reach:
            return False
    return True


def _starts(chosen: Sequence[Seen]) -> list[Start]:
    hints: list[Hint] = [one.hint for one in chosen]
    try:
        return start_poses(hints)[:2]
    except DegeneratePositions:
        return []


def _assigned(
    costs: Array, owners: NDArray[np.intp], marks: NDArray[np.intp], count: int
) -> tuple[float, dict[int, int]]:
    """The closest candidate of each sighting, no thing twice; a sighting without one costs 1."""
    given: dict[int, int] = {}
    taken: set[int] = set()
    total = float(count)
    close = np.flatnonzero(costs < 1)
    for c in close[np.argsort(costs[close])]:
        if int(owners[c]) not in given and int(marks[c]) not in taken:
            given[int(owners[c])] = int(c)
            taken.add(int(marks[c]))
            total += float(costs[c]) - 1.0
    return total, given


def outlines_of(chosen: Sequence[Seen | None]) -> list[SphereOutline | None]:
    """The outlines of what was chosen."""
    return [None if one is None else one.outline for one in chosen]
