# SPDX-License-Identifier: GPL-3.0-or-later
"""The sightings that fit one pose together: what was found in, the pose and the odd ones out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, Mask
from ..errors import DegeneratePositions, NotConverged
from .agreement import fewest_of, largest_agreement
from .contradictions import mistaken_unit, what_to_check
from .joint_pose import JointFit, fit_pose
from .seen import Beliefs, Seen
from .start_poses import Start, start_poses
from .unknowns import Refinable

# a sighting is odd when its own outline would rather have the ball this many sigmas elsewhere,
# beyond what the sightings have in common
ODD_MISFIT = 6.0
# and when it is at least this far off: a ball of a robot is never placed to a micron
ODD_PIXELS = 0.5
# below this factor all sightings agree; leaving some out has to bring the rest this much closer
ALL_WELL, PAYING_MISFIT = 3.0, 0.5
# leaving one out is tried for those that promise most
TRIED_WITHOUT = 8
# by so many directions more than are unknown the rest checks itself
LEFT_TO_CHECK = 4


@dataclass(frozen=True, eq=False)
class ConsistentFit:
    """The joint fit of the sightings `used` (S,), and by how many pixels each target is off it."""

    fit: JointFit
    used: Mask
    off_pixels: Array
    misfits: Array

    @property
    def start(self) -> Start:
        """The pose as a start for another fit."""
        return Start(self.fit.camera_from_base, self.fit.targets, self.fit.offsets)


def fit_consistent(seen: Sequence[Seen], refine: Sequence[Refinable] = ()) -> ConsistentFit:
    """The pose of all targets, or of those that agree where some do not.

    Raises DegeneratePositions when the targets that agree lie on a line, NotConverged when too few
    of them agree.
    """
    mistaken = mistaken_unit(seen)
    if mistaken is not None:
        raise NotConverged(f"no pose can fit; {mistaken}")
    everything = np.ones(len(seen), dtype=bool)
    try:
        together = _best_of_starts(seen, everything, refine)
    except DegeneratePositions:
        together = None
    if together is not None and together.fit.disagreement < ALL_WELL and not _odd(together).any():
        return together
    if len(seen) <= fewest_of(seen):
        if together is None:
            raise NotConverged(
                f"the {len(seen)} sightings found fit no pose together; {what_to_check(seen)}"
            )
        return together
    best = _without_the_odd(seen, refine)
    return best if together is None or _pays(seen, best, together) else together


def fitted(
    seen: Sequence[Seen], used: Mask, start: Start, refine: Sequence[Refinable] = ()
) -> ConsistentFit:
    """The joint fit of those `used` from a start, held against all. Raises DegeneratePositions."""
    chosen = [one for one, use in zip(seen, used, strict=True) if use]
    offsets = start.offsets_of([one.place for one in chosen])
    fit = fit_pose([s.observation for s in chosen], start.camera_from_base, offsets, refine)
    misfits = np.full(len(seen), np.nan)
    misfits[used] = fit.sighting_misfits
    centres = Start(fit.camera_from_base, fit.targets, fit.offsets).centres([s.place for s in seen])
    off = np.array([one.off_pixels(c) for one, c in zip(seen, centres, strict=True)])
    return ConsistentFit(fit, used, off, misfits)


def _pays(seen: Sequence[Seen], best: ConsistentFit, together: ConsistentFit) -> bool:
    """Whether leaving sightings out pays: an error that all share is not mended by using fewer.

    Nor is one that no eye would see, a robot's own. Where little is left to check the rest with, it
    has to be plain: the sightings left out are not even roughly where they should be.
    """
    left_out = np.flatnonzero(~best.used)
    if not len(left_out):
        return best.fit.chi_squared < together.fit.chi_squared
    plain = best.off_pixels[left_out] > ODD_PIXELS
    if 2 * best.used.sum() - 6 - 3 * len(best.fit.targets) < LEFT_TO_CHECK:
        centres = best.start.centres([seen[i].place for i in left_out])
        plain &= Beliefs.of([seen[i] for i in left_out]).disagreement(centres) > 1
    paid = best.fit.disagreement < PAYING_MISFIT * together.fit.disagreement
    return bool(plain.all()) and paid


def _best_of_starts(seen: Sequence[Seen], used: Mask, refine: Sequence[Refinable]) -> ConsistentFit:
    chosen = [one.hint for one, use in zip(seen, used, strict=True) if use]
    starts = start_poses(chosen)
    # what is far worse as a start does not become the best; two that are near may change places
    near = [s for s in starts[:3] if s.cost <= 100 * starts[0].cost + 1e-9]
    fits = [fitted(seen, used, start, refine) for start in near]
    return min(fits, key=lambda one: one.fit.chi_squared)


def _odd(fit: ConsistentFit) -> Mask:
    common = max(1.0, float(np.nanmedian(fit.misfits)))
    odd: Mask = (fit.misfits > ODD_MISFIT * common) & (fit.off_pixels > ODD_PIXELS)
    return odd


def _without_the_odd(seen: Sequence[Seen], refine: Sequence[Refinable]) -> ConsistentFit:
    used, start = largest_agreement(seen)
    fit = fitted(seen, used, start, refine)
    for _ in range(len(seen)):
        odd = _odd(fit) & fit.used
        left = [one for one, use in zip(seen, fit.used, strict=True) if use]
        least = fewest_of(left)
        if len(left) <= least or (fit.fit.disagreement < ALL_WELL and not odd.any()):
            break
        if odd.any() and (fit.used & ~odd).sum() >= least:
            fit = fitted(seen, fit.used & ~odd, fit.start, refine)
            continue
        better = _best_without_one(seen, fit, refine)
        if better is None:
            break
        fit = better
    return fit


def _best_without_one(
    seen: Sequence[Seen], fit: ConsistentFit, refine: Sequence[Refinable]
) -> ConsistentFit | None:
    """The fit without the sighting that bends it most, None where no single one does.

    One wrong place can bend the pose until all balls look equally wrong, and none is odd.
    """
    tried = []
    indices = np.flatnonzero(fit.used)
    for k in np.argsort(_left_without(fit.fit))[:TRIED_WITHOUT]:
        fewer = fit.used & (np.arange(len(seen)) != indices[k])
        try:
            tried.append(_best_of_starts(seen, fewer, refine))
        except DegeneratePositions:
            continue
    best = min(tried, key=lambda one: one.fit.disagreement, default=None)
    pays = best is not None and best.fit.disagreement < PAYING_MISFIT * fit.fit.disagreement
    return best if pays else None


def _left_without(fit: JointFit) -> Array:
    """About what chi-squared (S,) would be left without each sighting, by one step."""
    total = sum((say.information for say in fit.says), fit.prior_information)
    left = []
    for say in fit.says:
        step = np.linalg.lstsq(total - say.information, say.gradient, rcond=1e-14)[0]
        left.append(-say.pull - float(say.gradient @ step))
    return np.array(left)
