# SPDX-License-Identifier: GPL-3.0-or-later
"""What moves a whole outline unseen, allowed for: one ball's equations in, what it says out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..ball.sphere import Tangency
from .place_noise import own_pulls

# shading and sampling shift and swell a whole outline without showing in its residuals: by this
# many square pixels over the ball's radius, within bounds; found on synthetic balls of 9 to 100 px
COMMON_ERROR, LEAST_COMMON, MOST_COMMON = 0.35, 0.006, 0.05


@dataclass(frozen=True, eq=False)
class Say:
    """What one sighting says of P unknowns: information (P, P), gradient (P,), and its own pull.

    The pull is the chi-squared of where this sighting alone would rather have its target: three
    degrees of freedom for a ball, two for a point.
    """

    information: Array
    gradient: Array
    pull: float


def marginalised(grams: Array, allowed: Array) -> tuple[Array, Array]:
    """Products of whitened columns (S, M, M) after the centre's move, and the pulls (S,).

    The columns are the centre (3), whatever else moves the residuals, and the residuals last; the
    move has the covariance `allowed` (S, 3, 3), zero for none.
    """
    left = np.linalg.solve(np.eye(3) + grams[:, :3, :3] @ allowed, grams[:, :3, :])
    reduced = grams - grams[:, :, :3] @ allowed @ left
    # what is left of the centre itself is too little for a difference, where much is allowed
    reduced[:, :3, :] = left
    reduced[:, :, :3] = np.swapaxes(left, 1, 2)
    reduced[:, :3, :3] = 0.5 * (left[:, :, :3] + np.swapaxes(left[:, :, :3], 1, 2))
    return reduced, own_pulls(grams, allowed)


def common_covariance(held: Tangency, centre: Array, radius: float) -> Array:
    """Of the ball's centre (3, 3), metres: across the line of sight, and in depth by its size."""
    return common_of(held.by_centre, centre, radius)


def common_of(by_centre: Array, centre: Array, radius: float) -> Array:
    """`common_covariance` from the residuals' derivatives by the centre (N, 3) alone."""
    distance = float(np.linalg.norm(centre))
    axis = centre / distance
    across = np.linalg.norm(by_centre - np.outer(by_centre @ axis, axis), axis=1)
    pixels_per_metre = float(np.median(across))
    radius_pixels = pixels_per_metre * radius
    sigma = min(max(COMMON_ERROR / radius_pixels, LEAST_COMMON), MOST_COMMON)
    aside, deep = sigma / pixels_per_metre, sigma / radius_pixels * distance
    along = np.outer(axis, axis)
    covariance: Array = aside**2 * (np.eye(3) - along) + deep**2 * along
    return covariance
