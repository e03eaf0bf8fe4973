# SPDX-License-Identifier: GPL-3.0-or-later
"""What became of each sighting: outlines and the fit in, a status with its reason out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from ..arrays import Array
from ..ball.outline import SphereOutline
from ..sighting import Sighting
from .contradictions import mixed_up
from .pose_search import ConsistentFit
from .seen import Seen

# of a ball that was found, but where no common pose has it
NOT_FITTING = "what was found does not fit the others"
Status = Literal["used", "doubtful", "rejected"]
# the mean square of normal errors over the median square: a robust rms
SQUARE_OVER_MEDIAN = 2.198
DOUBTFUL_MISFIT, DOUBTFUL_OFF_PIXELS = 3.5, 0.3


@dataclass(frozen=True, eq=False)
class SightingReport:
    """What became of one sighting.

    `center_world`: where the target was, as given or as solved for. `rms_pixels`: what its outline
    is left with after the joint fit; `off_pixels` and `off_millimetres`: how far, across the line
    of sight, the ball found alone is from where the pose puts it. All three are NaN for a ball that
    was not found. `reason` says why it is doubted or rejected.
    """

    picture: str
    center_world: Array
    status: Status
    reason: str
    rms_pixels: float
    off_pixels: float
    off_millimetres: float
    outline: SphereOutline | None

    @property
    def contradicts(self) -> bool:
        """Whether its ball was found, and somewhere else than the pose has it."""
        return self.status == "rejected" and (
            self.outline is not None or self.reason == NOT_FITTING
        )


def sighting_reports(
    sightings: Sequence[Sighting],
    outlines: Sequence[SphereOutline | None],
    failures: dict[int, str],
    found: Sequence[int],
    seen: Sequence[Seen],
    consistent: ConsistentFit,
    *,
    mounted: bool,
) -> tuple[SightingReport, ...]:
    """One report a sighting; `found` are the indices of those found, in the order of the fit."""
    rank = {index: k for k, index in enumerate(found)}
    centres = consistent.start.centres([one.place for one in seen])
    mixed = mixed_up(seen, consistent.used, centres)
    exchanged = {found[i]: sightings[found[k]].picture for i, k in mixed.items()}
    reports = []
    for i, sighting in enumerate(sightings):
        place = _place_world(sighting, consistent, mounted)
        if i not in rank:
            reports.append(_missing(sighting.picture, place, failures.get(i, "not found")))
            continue
        k = rank[i]
        off = float(consistent.off_pixels[k])
        across = off / seen[k].pixels_per_radian * float(np.linalg.norm(centres[k]))
        report = SightingReport(
            sighting.picture,
            place,
            "used",
            "",
            _rms(consistent, k, seen[k].is_ball),
            off,
            1e3 * across,
            outlines[i],
        )
        reports.append(_judged(report, consistent, k, exchanged.get(i)))
    return tuple(reports)


def _rms(consistent: ConsistentFit, k: int, is_ball: bool) -> float:
    if not consistent.used[k]:
        return float("nan")
    left = consistent.fit.residuals_pixels[int(consistent.used[:k].sum())]
    return robust_rms(left) if is_ball else float(np.sqrt(np.mean(left**2)))


def _place_world(sighting: Sighting, consistent: ConsistentFit, mounted: bool) -> Array:
    """Where the target was in the world, (3,): as given, or with the offset as solved for."""
    if sighting.center_world is not None:
        return sighting.center_world
    fit = consistent.fit
    if sighting.target not in fit.targets or sighting.world_from_flange is None:
        return np.full(3, np.nan)
    offset: Array = fit.offsets[fit.targets.index(sighting.target)]
    # what a mounted camera looks at is carried by the world itself
    return offset if mounted else sighting.world_from_flange.apply(offset)


def _missing(picture: str, place: Array, reason: str) -> SightingReport:
    nan = float("nan")
    return SightingReport(picture, place, "rejected", reason, nan, nan, nan, None)


def _judged(
    report: SightingReport, consistent: ConsistentFit, k: int, exchanged: str | None
) -> SightingReport:
    what = "point" if report.outline is None else "ball"
    if not consistent.used[k]:
        reason = (
            f"the {what} found is {report.off_pixels:.1f} px ({report.off_millimetres:.0f} mm) "
            "from where the others put it"
        )
        if exchanged is not None:
            reason += f", and where {exchanged} should have it: were the pictures exchanged?"
        return replace(report, status="rejected", reason=reason)
    doubts = list(report.outline.warnings) if report.outline is not None else []
    common = max(1.0, float(np.nanmedian(consistent.misfits)))
    if consistent.misfits[k] > DOUBTFUL_MISFIT * common and report.off_pixels > DOUBTFUL_OFF_PIXELS:
        doubts.append(f"alone it would have the {what} {report.off_pixels:.2f} px elsewhere")
    return replace(report, status="doubtful" if doubts else "used", reason="; ".join(doubts))


def robust_rms(residuals: Array) -> float:
    """The rms of the normal core of residuals, from the median of their squares."""
    return float(np.sqrt(np.median(residuals**2) * SQUARE_OVER_MEDIAN))
