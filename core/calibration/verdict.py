# SPDX-License-Identifier: GPL-3.0-or-later
"""How far to believe a calibration: its numbers in, good, weak or failed out, with the reasons."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np

from ..intrinsics import Intrinsics
from .joint_pose import JointFit
from .position_geometry import PositionGeometry
from .suspicion import suspicions

Verdict = Literal["good", "weak", "failed"]

# sightings that disagree by this factor beyond their noise share an error that is not noise
WEAK_MISFIT, FAILED_MISFIT = 3.0, 15.0
# and only when it shows: a sharp picture may see a tenth of a millimetre of the robot's own error
FAILED_OFF_PIXELS = 2.0
WEAK_BIAS_PIXELS = 0.25
# no cell is larger, and points alone tell no scale
FARTHEST = 100.0
WEAK_ROTATION_DEGREES, WEAK_POSITION_SHARE = 0.2, 0.01


def verdict_of(
    lens: Intrinsics,
    fit: JointFit,
    geometry: PositionGeometry,
    sightings: Sequence[tuple[str, str, bool]],
    radius: float | None,
) -> tuple[Verdict, tuple[str, ...]]:
    """The verdict, and what to tell the user.

    `sightings` are status, reason, and whether the ball was found elsewhere; `radius` is that of
    the balls, None where there are only points.
    """
    rejected = [reason for status, reason, _ in sightings if status == "rejected"]
    doubtful = [reason for status, reason, _ in sightings if status == "doubtful"]
    elsewhere = sum(contradicts for _, _, contradicts in sightings)
    kept = len(sightings) - len(rejected)
    doubts = _doubts(lens, fit, radius)
    # each sighting tells a direction well: two numbers
    unchecked = 2 * kept <= 6 + 3 * len(fit.targets)
    if unchecked:
        doubts.append(_nothing_to_check_with(kept))
    # any three positions have a mirror image that fits as well: against two that object, they lose
    lonely = (unchecked and len(rejected) >= 2) or elsewhere >= kept
    if lonely:
        doubts.append(f"only {kept} of {len(sightings)} sightings agree, too few against the rest")
    warnings = (
        *_counted("rejected", rejected, len(sightings)),
        *_counted("doubtful", doubtful, len(sightings)),
        *doubts,
    )
    off = float(np.sqrt(np.mean(np.concatenate(fit.residuals_pixels) ** 2)))
    if (fit.disagreement > FAILED_MISFIT and off > FAILED_OFF_PIXELS) or kept < 3 or lonely:
        return "failed", warnings
    few = 2 * len(rejected) > kept or 2 * len(doubtful) > kept
    return ("weak" if doubts or few or geometry.warnings() else "good"), warnings


def _counted(status: str, reasons: Sequence[str], count: int) -> tuple[str, ...]:
    return (f"{len(reasons)} of {count} sightings {status}: {reasons[0]}",) if reasons else ()


def _nothing_to_check_with(kept: int) -> str:
    if kept == 3:
        return "three sightings leave nothing to check them with; add a fourth"
    return f"{kept} sightings leave nothing to check them with; add one more"


def _doubts(lens: Intrinsics, fit: JointFit, radius: float | None) -> list[str]:
    suspected = suspicions(fit, radius, lens)
    doubts = list(suspected)
    if fit.disagreement > WEAK_MISFIT:
        suspect = "the pixels" if radius is None else "the ball's radius"
        doubts.append(
            f"the sightings disagree {fit.disagreement:.1f} times more than their own noise "
            f"explains, as if each place were off by {1e3 * fit.place_sigma:.2g} mm: check "
            f"{suspect}, the intrinsics and the robot's positions"
        )
    if abs(fit.edge_bias_pixels) > WEAK_BIAS_PIXELS and not suspected:
        doubts.append(
            f"all outlines are {fit.edge_bias_pixels:+.2f} px off the radius given: "
            "is the radius right?"
        )
    degrees = float(np.degrees(np.sqrt(np.diag(fit.covariance)[:3].max())))
    metres = float(np.sqrt(np.linalg.eigvalsh(fit.covariance[3:, 3:])[-1]))
    distance = float(np.median(np.linalg.norm(fit.camera_from_base.apply(fit.places_base), axis=1)))
    if distance > FARTHEST:
        doubts.append(
            f"the camera would be {distance:.3g} m from what it sees: are the positions in metres?"
        )
    if degrees > WEAK_ROTATION_DEGREES or metres > WEAK_POSITION_SHARE * distance:
        doubts.append(
            f"the pose is known to {1e3 * metres:.1f} mm and {degrees:.2f} deg only; add sightings "
            "that are farther apart"
        )
    return doubts
