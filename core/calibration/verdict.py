# SPDX-License-Identifier: GPL-3.0-or-later
"""How far to believe a calibration: its numbers in, good, weak or failed out, with the reasons."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np

from ..camera import Camera
from .joint_pose import JointFit
from .position_geometry import PositionGeometry

Verdict = Literal["good", "weak", "failed"]

# sightings that disagree by this factor beyond their noise share an error that is not noise
WEAK_MISFIT, FAILED_MISFIT = 3.0, 15.0
# and only when it shows: a sharp picture may see a tenth of a millimetre of the robot's own error
FAILED_OFF_PIXELS = 2.0
WEAK_BIAS_PIXELS = 0.25
FOCAL_SIGMAS, FOCAL_SHARE = 3.0, 0.003
WEAK_ROTATION_DEGREES, WEAK_POSITION_SHARE = 0.2, 0.01


def verdict_of(
    camera: Camera,
    fit: JointFit,
    geometry: PositionGeometry,
    sightings: Sequence[tuple[str, str]],
) -> tuple[Verdict, tuple[str, ...]]:
    """The verdict, and what to tell the user; `sightings` are pairs of status and reason."""
    rejected = [reason for status, reason in sightings if status == "rejected"]
    doubtful = [reason for status, reason in sightings if status == "doubtful"]
    kept = len(sightings) - len(rejected)
    doubts = _doubts(camera, fit)
    if kept < 4:
        doubts.append("three sightings leave nothing to check them with; add a fourth")
    # any three positions have a mirror image that fits as well: against two that object, they lose
    lonely = kept < 4 and len(rejected) >= 2
    if lonely:
        doubts.append(f"only {kept} of {len(sightings)} sightings agree, too few against the rest")
    warnings = (
        *_counted("rejected", rejected, len(sightings)),
        *_counted("doubtful", doubtful, len(sightings)),
        *doubts,
    )
    off = float(np.sqrt(np.mean(np.concatenate(fit.residuals_pixels) ** 2)))
    if (fit.misfit > FAILED_MISFIT and off > FAILED_OFF_PIXELS) or kept < 3 or lonely:
        return "failed", warnings
    few = 2 * len(rejected) > kept or 2 * len(doubtful) > kept
    return ("weak" if doubts or few or geometry.warnings() else "good"), warnings


def _counted(status: str, reasons: Sequence[str], count: int) -> tuple[str, ...]:
    return (f"{len(reasons)} of {count} sightings {status}: {reasons[0]}",) if reasons else ()


def _doubts(camera: Camera, fit: JointFit) -> list[str]:
    doubts = []
    if fit.misfit > WEAK_MISFIT:
        doubts.append(
            f"the sightings disagree {fit.misfit:.1f} times more than their outlines' noise "
            "explains: check the ball's radius, the intrinsics and the robot's positions"
        )
    if abs(fit.edge_bias_pixels) > WEAK_BIAS_PIXELS:
        doubts.append(
            f"all outlines are {fit.edge_bias_pixels:+.2f} px off the radius given: "
            "is the radius right?"
        )
    answer = fit.asked.about("focal")
    off, sigma = (answer.value, answer.sigma) if answer else (float("nan"), 1.0)
    if abs(off) > max(FOCAL_SIGMAS * sigma, FOCAL_SHARE):
        doubts.append(
            f"a focal length {100 * off:+.1f} ± {100 * sigma:.1f} % longer would fit better: is "
            "the camera file that of this lens and zoom?"
        )
    rotation, position = camera.rotation_sigma(), camera.centre_sigma()
    if rotation is None or position is None:
        return doubts
    degrees, metres = float(np.degrees(rotation.max())), float(position.max())
    distance = float(np.linalg.norm(camera.pose.translation))
    if degrees > WEAK_ROTATION_DEGREES or metres > WEAK_POSITION_SHARE * distance:
        doubts.append(
            f"the pose is known to {1e3 * metres:.1f} mm and {degrees:.2f} deg only; add sightings "
            "that are farther apart"
        )
    return doubts
