# SPDX-License-Identifier: GPL-3.0-or-later
"""How far a calibration is from the truth and from what it states: a rendered rig in, a score out.

The truth enters here alone: the estimator gets the files and the cell that a user would give.
"""

from __future__ import annotations

import math
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path
from statistics import NormalDist

import numpy as np
from monocell.core.calibration.calibrate import Calibration, calibrate_cell, calibrate_outlines
from monocell.core.calibration.frames import pose_from_points
from monocell.core.camera import Camera
from monocell.core.comparison import pose_error
from monocell.core.errors import MonocellError
from monocell.core.pose import Pose
from monocell.core.sighting import SphereSighting
from photographs import Development, photograph_rig
from rendered_rigs import RenderedRig
from rig_plans import RADIUS

BASELINES = ("pnp", "p3p", "frames", "rigid")
VERDICTS = ("good", "weak", "failed", "refused")


@dataclass(frozen=True)
class Score:
    """Errors of one rig: metres, radians, and Mahalanobis' distance; NaN where it was refused.

    `baselines` are (place, turn) by name. `reason` is the refusal, or the first warning.
    """

    rig: str
    pictures: str
    verdict: str
    reason: str
    place: float = math.nan
    turn: float = math.nan
    mahalanobis: float = math.nan
    used: int = 0
    seconds: float = 0.0
    baselines: dict[str, tuple[float, float]] = field(default_factory=dict)

    @property
    def probability(self) -> float:
        """How often a right covariance would have an error at most this unlikely."""
        return 1.0 - _tail(self.mahalanobis)

    @property
    def sigmas(self) -> float:
        """As unlikely as so many sigmas of one number are."""
        return NormalDist().inv_cdf(1 - max(_tail(self.mahalanobis), 1e-15) / 2)


def score_rig(rig: RenderedRig, how: Development, *, baselines: bool = False) -> Score:
    """Photograph, calibrate as a user would, and hold the answer against the truth."""
    told = f"{rig.plan.ball}, {how.told()}"
    with tempfile.TemporaryDirectory(prefix="monocell-bench-") as folder:
        cell = photograph_rig(rig, how, Path(folder))
        began = time.perf_counter()
        try:
            calibration = calibrate_cell(cell)[1]
        except MonocellError as error:
            return Score(rig.plan.name, told, "refused", str(error))
        seconds = time.perf_counter() - began
    error = pose_error(rig.plan.camera, calibration.camera)
    return Score(
        rig.plan.name,
        told,
        calibration.verdict,
        next(iter(calibration.warnings), ""),
        float(np.linalg.norm(error.centre)),
        float(np.linalg.norm(error.rotation)),
        math.nan if error.mahalanobis is None else error.mahalanobis,
        calibration.count_used,
        seconds,
        _baselines(rig, calibration) if baselines else {},
    )


def pose_errors(truth: Camera, estimate: Pose) -> tuple[float, float]:
    """Of the camera's place in metres and its turn in radians."""
    error = pose_error(truth, Camera(truth.intrinsics, estimate))
    return float(np.linalg.norm(error.centre)), float(np.linalg.norm(error.rotation))


def _baselines(rig: RenderedRig, calibration: Calibration) -> dict[str, tuple[float, float]]:
    """What else could be made of the same outlines, those that the joint fit rejected left out."""
    kept = [r for r in calibration.sightings if r.status != "rejected" and r.outline is not None]
    camera = Camera(calibration.camera.intrinsics)
    sightings = [SphereSighting(r.picture, r.center_world, RADIUS) for r in kept]
    errors = {}
    for method in BASELINES:
        try:
            if method == "rigid":
                world = np.array([r.center_world for r in kept])
                pose = pose_from_points(world, [r.outline.centre_camera for r in kept])
            else:
                outlines = [r.outline for r in kept]
                pose = calibrate_outlines(camera, sightings, outlines, method).camera.pose
        except MonocellError:
            pose = None
        errors[method] = (math.nan,) * 2 if pose is None else pose_errors(rig.plan.camera, pose)
    return errors


def _tail(mahalanobis: float) -> float:
    """The chance that chi-squared of six degrees of freedom exceeds the square."""
    half = 0.5 * mahalanobis**2
    return math.exp(-half) * (1 + half + half * half / 2)
