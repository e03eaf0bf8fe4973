# SPDX-License-Identifier: GPL-3.0-or-later
"""How far off a rough solid may be: every direction moves its outline about as far."""

from __future__ import annotations

import numpy as np

from ..arrays import Array
from ..camera import Camera
from ..modelling.solid import Solid
from .hypotheses import hull_points
from .refine import tangent

# share of a size by which it may be wrong, and a turn in radians, 1 sigma
SIZE_SHARE, TURN = 0.12, 0.25
# an outline may move by this share of the reach, and of its extent
REACH_SHARE, EXTENT_SHARE = 0.75, 0.06
STEP = 1e-5
# what an object's source says of its error counts so many times, and is no less than this
TRUSTED, LEAST_PIXELS = 2.5, 1.0


def prior_root(
    solid: Solid, basis: Array, camera: Camera, reach_pixels: float, stated: Array | None
) -> Array | None:
    """A root (F, F) of the covariance over a basis (6 + P, F); None where the solid isn't imaged.

    `basis @ root` are motions of one sigma each. `stated` (6 + P, 6 + P) is what the solid's own
    source, its picks, says of its error: it is believed, but for a few sigmas.
    """
    count = basis.shape[1]
    hulls = hull_points(solid, np.vstack([np.zeros((1, len(basis))), STEP * basis.T]), camera)
    if count == 0 or not np.isfinite(hulls).all():
        return None
    by = ((hulls[1:] - hulls[0]) / STEP).reshape(count, -1)
    extent = float(np.linalg.norm(np.ptp(hulls[0], axis=0)))
    sigma = float(np.hypot(REACH_SHARE * reach_pixels, EXTENT_SHARE * extent))
    seen = by @ by.T / (by.shape[1] / 2)
    information = seen / sigma**2
    sizes = basis[6:] / (SIZE_SHARE * np.maximum(np.abs(solid.parameters), 1e-3))[:, None]
    information += sizes.T @ sizes + basis[:3].T @ basis[:3] / TURN**2
    if stated is not None:
        back = np.linalg.pinv(basis)
        known = back @ stated @ back.T
        # inv(TRUSTED^2 known + LEAST_PIXELS^2 inv(seen)), where no outline may show a bore
        believed = seen @ np.linalg.inv(TRUSTED**2 * known @ seen + LEAST_PIXELS**2 * np.eye(count))
        information += (believed + believed.T) / 2
    root: Array = np.linalg.inv(np.linalg.cholesky(information)).T
    return root


def strayed_sigmas(start: Solid, end: Solid, basis: Array, stated: Array) -> float:
    """How far a fit has gone from its start, in sigmas of what the source states, per direction.

    `basis` (6 + P, F) holds the directions that are free, `stated` is as of `prior_root`.
    """
    back = np.linalg.pinv(basis)
    away = back @ tangent(start, end)
    known = back @ stated @ back.T
    return float(np.sqrt(away @ np.linalg.lstsq(known, away, rcond=None)[0] / len(away)))
