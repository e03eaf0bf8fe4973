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
# directions of a centre that are told this much worse than the best are not told at all
NOT_TOLD = 1e-12


@dataclass(frozen=True, eq=False)
class Say:
    """What one sighting says of P unknowns: information (P, P), gradient (P,), and its own pull.

    The pull is the chi-squared of where this sighting alone would rather have its target: three
    degrees of freedom for a ball, two for a point.
    """

    information: Array
    gradient: Array
    pull: float


def say_of(held: Tangency, rows: Array, left: Array, root: Array, allowed: Array) -> Say:
    """Marginalise a small random move of the ball's centre, of covariance `allowed` (3, 3).

    `rows` (N, P) are derivatives of the residuals `left` (N,), and `root` (N,) the square roots of
    their weights.
    """
    whitened = np.column_stack([held.by_centre, rows, left]) * root[:, None]
    reduced, pulls = marginalised(np.array([whitened.T @ whitened]), allowed[None])
    return Say(reduced[0, 3:-1, 3:-1], reduced[0, 3:-1, -1], float(pulls[0]))


def marginalised(grams: Array, allowed: Array) -> tuple[Array, Array]:
    """Products of whitened columns (S, M, M) after the centre's move, and the pulls (S,).

    The columns are the centre (3), whatever else moves the residuals, and the residuals last; the
    move has the covariance `allowed` (S, 3, 3), zero for none.
    """
    of_centre, towards = grams[:, :3, :3], grams[:, :3, -1]
    swallowed = allowed @ np.linalg.inv(np.eye(3) + of_centre @ allowed)
    reduced = grams - grams[:, :, :3] @ swallowed @ grams[:, :3, :]
    spread = of_centre + of_centre @ allowed @ of_centre
    pulls = np.einsum("si,sij,sj->s", towards, _pseudo_inverse(spread), towards)
    return reduced, pulls


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


def _pseudo_inverse(matrices: Array) -> Array:
    """Of symmetric matrices (S, 3, 3), without what they do not tell."""
    values, vectors = np.linalg.eigh(matrices)
    told = values > NOT_TOLD * np.maximum(values[:, -1:], 1e-300)
    inverse = np.where(told, 1 / np.where(told, values, 1.0), 0.0)
    result: Array = (vectors * inverse[:, None, :]) @ np.swapaxes(vectors, 1, 2)
    return result
