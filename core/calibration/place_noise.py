# SPDX-License-Identifier: GPL-3.0-or-later
"""How far targets are from where the robot says: what sightings leave in, one sigma in metres out.

A sharp picture sees a tenth of a millimetre that a robot does not. Then the sightings disagree by
more than their outlines explain, and what they share is not a factor on every sigma but an error of
the places. It shows across the line of sight alone: a ball's depth is told too badly.
"""

from __future__ import annotations

import numpy as np

from ..arrays import Array

STEPS, SETTLED = 30, 1e-6
# a direction that is told this much worse than the best is not told; no place is known better
NOT_TOLD, LEAST_VARIANCE = 1e-12, 1e-24


def place_sigma(grams: Array, allowed: Array, across: int) -> float:
    """1 sigma of the places, the same in all directions and for all sightings; 0 for none needed.

    The variance that makes chi-squared across the lines of sight equal its degrees of freedom
    `across` (Paule and Mandel 1982). `grams` (S, M, M) and `allowed` (S, 3, 3) are those of
    `marginalised`.
    """
    variances, squares = _across(grams, allowed)
    added = 0.0
    for _ in range(STEPS):
        spread = variances + added
        chi_squared = float((squares / spread).sum())
        if chi_squared <= across * (1 + SETTLED):
            break
        # Newton's method on the reciprocal, which is nearly straight
        slope = float((squares / spread**2).sum())
        added += chi_squared / slope * (chi_squared / across - 1)
    return float(np.sqrt(added))


def own_pulls(grams: Array, allowed: Array) -> Array:
    """Chi-squared (S,) of where each sighting alone would rather have its target."""
    rather, covariances = _own_moves(grams, allowed)
    # a column each: NumPy 2 would take the rows of (S, 3) for one matrix
    towards = np.linalg.solve(covariances, rather[..., None])[..., 0]
    pulls: Array = np.einsum("si,si->s", rather, towards)
    return pulls


def across_pulls(grams: Array, allowed: Array) -> Array:
    """`own_pulls`, but only across the line of sight: two degrees of freedom each."""
    variances, squares = _across(grams, allowed)
    pulls: Array = (squares / variances).sum(axis=1)
    return pulls


def _across(grams: Array, allowed: Array) -> tuple[Array, Array]:
    """Variances (S, 2) across the line of sight along their own axes, and squared moves there."""
    rather, covariances = _own_moves(grams, allowed)
    # the least told direction comes first: it is the line of sight
    variances, axes = np.linalg.eigh(covariances[:, 1:, 1:])
    squares = np.einsum("sij,si->sj", axes, rather[:, 1:]) ** 2
    return np.maximum(variances, LEAST_VARIANCE), squares


def _own_moves(grams: Array, allowed: Array) -> tuple[Array, Array]:
    """Where each sighting would rather have its target, (S, 3), with its covariance (S, 3, 3).

    Along the axes in which it tells that, the least told first.
    """
    of_centre, towards = grams[:, :3, :3], grams[:, :3, -1]
    values, vectors = np.linalg.eigh(of_centre)
    told = values > NOT_TOLD * np.maximum(values[:, -1:], 1e-300)
    inverse = np.where(told, 1 / np.where(told, values, 1.0), 0.0)
    rather = np.einsum("sij,si->sj", vectors, towards) * inverse
    covariances = np.swapaxes(vectors, 1, 2) @ allowed @ vectors
    # what is not told is zero, and weighs nothing whatever its variance
    covariances[:, range(3), range(3)] += np.where(told, inverse, 1.0)
    return rather, covariances
