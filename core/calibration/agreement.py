# SPDX-License-Identifier: GPL-3.0-or-later
"""Which sightings agree with each other: what was found in, the largest group and its pose out."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations
from math import comb

import numpy as np

from ..arrays import Mask
from ..errors import DegeneratePositions, NotConverged
from .contradictions import what_to_check
from .observation import Place
from .seen import Beliefs, Seen
from .start_poses import Start, start_poses
from .unknowns import offset_targets

MOST_SAMPLES, MOST_COSTLY_SAMPLES = 60, 30
MOST_LISTED = 5000


def fewest(places: Sequence[Place], are_balls: Sequence[bool]) -> int:
    """How many sightings make a pose: three at known places, with unknown offsets as many as tell
    one number more than is unknown."""
    targets = len(offset_targets(places))
    told = 3 if all(are_balls) else 2
    return 3 if targets == 0 else -(-(7 + 3 * targets) // told)


def fewest_of(seen: Sequence[Seen]) -> int:
    """`fewest`, for what was found."""
    return fewest([one.place for one in seen], [one.is_ball for one in seen])


def largest_agreement(seen: Sequence[Seen]) -> tuple[Mask, Start]:
    """Those (S,) that agree with the pose through a few which the most agree with, and that pose.

    Raises NotConverged when no pose has as many as make one.
    """
    places, beliefs, size = [one.place for one in seen], Beliefs.of(seen), fewest_of(seen)
    cheap = all(one.is_ball and one.place.offset is not None for one in seen)
    best: tuple[int, float, Mask, Start] | None = None
    for sample in samples(len(seen), size, MOST_SAMPLES if cheap else MOST_COSTLY_SAMPLES):
        for start in starts_of(seen, sample):
            costs = beliefs.disagreement(start.centres(places))
            agrees: Mask = costs < 1
            off = float(np.minimum(costs, 1).sum())
            if best is None or (agrees.sum(), -off) > (best[0], -best[1]):
                best = (int(agrees.sum()), off, agrees, start)
    if best is None or best[0] < size:
        raise NotConverged(
            f"no {size} of the {len(seen)} sightings found fit one pose; {what_to_check(seen)}"
        )
    again = starts_of(seen, np.flatnonzero(best[2]).tolist())
    return best[2], again[0] if again else best[3]


def samples(count: int, size: int, most: int) -> Iterator[tuple[int, ...]]:
    """All groups of `size` of `count`, or `most` of them drawn without listing a million."""
    rng = np.random.default_rng(0)
    if comb(count, size) > MOST_LISTED:
        for _ in range(most):
            yield tuple(rng.choice(count, size, replace=False).tolist())
        return
    groups = list(combinations(range(count), size))
    drawn = rng.permutation(len(groups))[:most] if len(groups) > most else range(len(groups))
    yield from (groups[i] for i in drawn)


def starts_of(seen: Sequence[Seen], chosen: Sequence[int]) -> list[Start]:
    """Rough poses of some of the sightings; none where these leave the pose open."""
    try:
        return start_poses([seen[i].hint for i in chosen])[:4]
    except DegeneratePositions:
        return []
