# SPDX-License-Identifier: GPL-3.0-or-later
"""What is known of a reference's error in, a warning with the numbers, or a refusal, out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..arrays import Array
from ..errors import DegenerateReference
from .fits import PointFit
from .placed import Placed

# 1 sigma of a tilt in degrees that deserves a word, and beyond which nothing is known
DOUBTFUL_TILT, HOPELESS_TILT = 2.0, 20.0


def noise_scale(whitened: Array, spare: int) -> float:
    """How many times the stated noise the residuals show, 1 unless they clearly exceed it.

    Clearly: beyond two standard deviations of chi squared.
    """
    if spare < 1:
        return 1.0
    reduced = float(whitened @ whitened) / spare
    return float(np.sqrt(reduced)) if reduced > 1.0 + 2.0 * np.sqrt(2.0 / spare) else 1.0


def tilt_degrees(placed: Placed) -> float:
    """1 sigma of the direction where it is known worst, 0 when no error is stated."""
    covariance = placed.error.covariance()
    if covariance is None:
        return 0.0
    return float(np.degrees(np.sqrt(max(float(np.linalg.eigvalsh(covariance[:3, :3])[-1]), 0.0))))


def offset_metres(placed: Placed) -> float:
    """1 sigma of the place across the plane or line where it is known worst."""
    covariance = placed.error.covariance()
    if covariance is None:
        return 0.0
    return float(np.sqrt(max(float(np.linalg.eigvalsh(covariance[3:, 3:])[-1]), 0.0)))


def doubt_of_tilt(
    name: str, placed: Placed, fit: PointFit, warnings: tuple[str, ...] = ()
) -> Placed:
    """The same with a warning where the points hardly tell the direction.

    Raises DegenerateReference where they tell nothing.
    """
    tilt = tilt_degrees(placed)
    extent = f"{1e3 * fit.length:.4g} mm"
    if placed.kind == "plane":
        extent = f"{extent} x {1e3 * fit.width:.3g} mm"
    if tilt > HOPELESS_TILT:
        raise DegenerateReference(
            f"{name}: its points span {extent}, which leaves its direction open by {tilt:.0f} "
            "degrees; spread them farther"
        )
    if tilt > DOUBTFUL_TILT:
        told = f"{name}: its points span {extent}, so its direction is known to {tilt:.1f} degrees"
        warnings = (*warnings, told)
    return replace(placed, warnings=(*placed.warnings, *warnings))
