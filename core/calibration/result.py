# SPDX-License-Identifier: GPL-3.0-or-later
"""What a calibration comes to: the camera, how far to believe it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from ..camera import Camera
from ..mount import Mount
from .baselines import PoseCandidate
from .joint_pose import JointFit
from .position_geometry import PositionGeometry
from .sighting_report import SightingReport
from .unknowns import Refined
from .verdict import Verdict

METHODS = ("joint", "frames", "p3p", "pnp")
Method = Literal["joint", "frames", "p3p", "pnp"]


@dataclass(frozen=True, eq=False)
class Calibration:
    """A calibrated camera, and how far to believe it.

    `misfit` is the factor by which the sightings disagree beyond their own noise (1: not at all);
    the covariance already carries it. `verdict` is good, weak or failed, `warnings` say why.
    `refined` is what changed in lens or radius; `camera` has the lens refined. For a camera on the
    flange, `mount` has its place there, and `camera` stands where it stood for the cell's picture,
    or without one for the first sighting used. For a baseline, `candidates` are all its answers,
    the closest first, and `camera` stands at that; all else is of the joint fit that it is held
    against. `fit` is that fit, of the sightings `used_indices`, in its order.
    """

    camera: Camera
    method: str
    verdict: Verdict
    warnings: tuple[str, ...]
    sightings: tuple[SightingReport, ...]
    geometry: PositionGeometry
    rms_pixels: float
    edge_bias_pixels: float
    edge_bias_sigma_pixels: float
    misfit: float
    fit: JointFit
    used_indices: tuple[int, ...]
    candidates: tuple[PoseCandidate, ...] = ()
    refined: tuple[Refined, ...] = ()
    mount: Mount | None = None

    @property
    def count_used(self) -> int:
        return sum(report.status != "rejected" for report in self.sightings)
