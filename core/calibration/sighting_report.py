# SPDX-License-Identifier: GPL-3.0-or-later
"""What became of each sighting: outlines and the fit in, a status with its reason out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from ..arrays import Array
from ..ball.outline import SphereOutline
from ..sighting import SphereSighting
from .pose_search import ConsistentFit

Status = Literal["used", "doubtful", "rejected"]
# the mean square of normal errors over the median square: a robust rms
SQUARE_OVER_MEDIAN = 2.198
DOUBTFUL_MISFIT, DOUBTFUL_OFF_PIXELS = 3.5, 0.3


@dataclass(frozen=True, eq=False)
class SightingReport:
    """What became of one sighting.

    `rms_pixels`: what its outline is left with after the joint fit; `off_pixels` and
    `off_millimetres`: how far, across the line of sight, the ball found alone is from where the
    pose puts it. All three are NaN for a ball that was not found. `reason` says why it is doubted
    or rejected.
    """

    picture: str
    center_world: Array
    status: Status
    reason: str
    rms_pixels: float
    off_pixels: float
    off_millimetres: float
    outline: SphereOutline | None


def sighting_reports(
    sightings: Sequence[SphereSighting],
    outlines: Sequence[SphereOutline | None],
    failures: dict[int, str],
    found: Sequence[int],
    consistent: ConsistentFit,
) -> tuple[SightingReport, ...]:
    """One report a sighting; `found` are the indices of those with an outline, in fit order."""
    rank = {index: k for k, index in enumerate(found)}
    used_rank = np.cumsum(consistent.used) - 1
    reports = []
    for i, sighting in enumerate(sightings):
        outline = outlines[i]
        if outline is None or i not in rank:
            reports.append(_missing(sighting, failures.get(i, "not found")))
            continue
        k = rank[i]
        off = float(consistent.off_pixels[k])
        across = off / max(_pixels_per_metre(outline), 1e-9)
        left = consistent.fit.residuals_pixels[used_rank[k]] if consistent.used[k] else None
        rms = float("nan") if left is None else robust_rms(left)
        report = SightingReport(
            sighting.picture, sighting.center_world, "used", "", rms, off, 1e3 * across, outline
        )
        reports.append(_judged(report, consistent, k))
    return tuple(reports)


def _pixels_per_metre(outline: SphereOutline) -> float:
    """From the outline's own size: its pixel radius over the ball's radius."""
    pixels = outline.pixels - outline.pixels.mean(axis=0)
    return float(np.median(np.linalg.norm(pixels, axis=1)) / outline.radius)


def _missing(sighting: SphereSighting, reason: str) -> SightingReport:
    nan = float("nan")
    return SightingReport(
        sighting.picture, sighting.center_world, "rejected", reason, nan, nan, nan, None
    )


def _judged(report: SightingReport, consistent: ConsistentFit, k: int) -> SightingReport:
    if not consistent.used[k]:
        reason = (
            f"the ball found is {report.off_pixels:.1f} px ({report.off_millimetres:.0f} mm) from "
            "where the others put it"
        )
        return replace(report, status="rejected", reason=reason)
    doubts = list(report.outline.warnings) if report.outline is not None else []
    common = max(1.0, float(np.nanmedian(consistent.misfits)))
    if consistent.misfits[k] > DOUBTFUL_MISFIT * common and report.off_pixels > DOUBTFUL_OFF_PIXELS:
        doubts.append(f"its outline would have the ball {report.off_pixels:.2f} px elsewhere")
    return replace(report, status="doubtful" if doubts else "used", reason="; ".join(doubts))


def robust_rms(residuals: Array) -> float:
    """The rms of the normal core of residuals, from the median of their squares."""
    return float(np.sqrt(np.median(residuals**2) * SQUARE_OVER_MEDIAN))
