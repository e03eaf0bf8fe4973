# SPDX-License-Identifier: GPL-3.0-or-later
"""A fitted object in, whether its foot may as well be lower out.

Bands of a pattern run along the foot, and so does its shadow's edge. With the top held, the foot is
let down: where else do edges lie along it?
"""

from __future__ import annotations

import numpy as np

from ..arrays import Array
from ..camera import Camera
from .curve_samples import curve_samples
from .refine import EdgeFit
from .stations import Look, Pass, find_stations, unhidden

# how far the foot is looked for, in pixels, in which steps, and what is still the same foot
FARTHEST, STEP, SAME = 11.0, 0.25, 1.2
WIDE = Pass(FARTHEST + 3.0, FARTHEST, 8, 0.0, (), False)
NEAR_PIXELS = 0.7


def foot_rivals(fit: EdgeFit, camera: Camera, look: Look) -> float:
    """The votes for a foot farther out, as a share of those for the foot itself.

    Zero for what does not stand, or has no height.
    """
    samples = unhidden(curve_samples(fit.solid, camera), look.hidden)
    at_foot = np.array(["base" in name for name in samples.names] + [False])[samples.curve]
    foot = samples.chosen(at_foot & samples.outline)
    if not fit.stands or len(foot) < 3 or fit.solid.kind == "sphere":
        return 0.0
    stations = find_stations(foot, look, WIDE)
    moved = stations.by_object @ _lower(fit)
    most = float(np.abs(moved).max())
    if most <= 0:
        return 0.0
    shift = np.arange(-SAME, FARTHEST + STEP / 2, STEP)
    votes = stations.votes(shift[:, None] * (moved / most), NEAR_PIXELS)
    own = max(float(votes[np.abs(shift) <= SAME].max()), 1e-9)
    return float(votes[shift > SAME].max()) / own


def _lower(fit: EdgeFit) -> Array:
    """The motion (6 + P,) that lowers the foot by a metre and leaves the top where it is."""
    height = 0 if fit.solid.kind == "prism" else len(fit.solid.parameters) - 1
    motion = np.zeros(6 + len(fit.solid.parameters))
    motion[3:6] = -0.5 * fit.solid.rotation[:, 2]
    motion[6 + height] = 1.0
    return motion
