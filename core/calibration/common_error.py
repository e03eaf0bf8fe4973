# SPDX-License-Identifier: GPL-3.0-or-later
"""What moves a whole outline unseen, allowed for: one ball's equations in, what it says out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..ball.sphere import Tangency

# shading and sampling shift and swell a whole outline without showing in its residuals: by this
# many square pixels over the ball's radius, within bounds; found on synthetic balls of 9 to 100 px
COMMON_ERROR, LEAST_COMMON, MOST_COMMON = 0.35, 0.006, 0.05


@dataclass(frozen=True, eq=False)
class Say:
    """What one ball says of P unknowns: information (P, P), gradient (P,), and its own pull.

    The pull is the chi-squared of where this ball alone would rather be, three degrees of freedom.
    """

    information: Array
    gradient: Array
    pull: float


def say_of(held: Tangency, rows: Array, left: Array, root: Array, allowed: Array) -> Say:
    """Marginalise a small random move of the ball's centre, of covariance `allowed` (3, 3).

    `rows` (N, P) are derivatives of the residuals `left` (N,), and `root` (N,) the square roots of
    their weights.
    """
    whitened, residuals = rows * root[:, None], left * root
    by_centre = held.by_centre * root[:, None]
    of_centre, towards = by_centre.T @ by_centre, by_centre.T @ residuals
    mixed = by_centre.T @ whitened
    swallowed = np.linalg.inv(of_centre + np.linalg.inv(allowed))
    rather = np.linalg.lstsq(of_centre, towards, rcond=None)[0]
    spread = np.linalg.pinv(of_centre) + allowed
    return Say(
        whitened.T @ whitened - mixed.T @ swallowed @ mixed,
        whitened.T @ residuals - mixed.T @ swallowed @ towards,
        float(rather @ np.linalg.solve(spread, rather)),
    )


def common_covariance(held: Tangency, centre: Array, radius: float) -> Array:
    """Of the ball's centre (3, 3), metres: across the line of sight, and in depth by its size."""
    distance = float(np.linalg.norm(centre))
    axis = centre / distance
    across = np.linalg.norm(held.by_centre - np.outer(held.by_centre @ axis, axis), axis=1)
    pixels_per_metre = float(np.median(across))
    radius_pixels = pixels_per_metre * radius
    sigma = float(np.clip(COMMON_ERROR / radius_pixels, LEAST_COMMON, MOST_COMMON))
    aside, deep = sigma / pixels_per_metre, sigma / radius_pixels * distance
    along = np.outer(axis, axis)
    covariance: Array = aside**2 * (np.eye(3) - along) + deep**2 * along
    return covariance
