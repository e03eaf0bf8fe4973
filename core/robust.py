# SPDX-License-Identifier: GPL-3.0-or-later
"""Robust statistics: residuals with outliers and neighbours in, scales and weights out."""

from __future__ import annotations

import numpy as np

from .arrays import Array, Mask

# Tukey's constant for 95 % efficiency on normal errors
TUKEY = 4.685


def robust_sigma(residuals: Array) -> float:
    """The standard deviation of the normal core: 1.4826 times the median absolute residual."""
    return max(1.4826 * middle_of(np.abs(residuals)), 1e-9)


def middle_of(values: Array) -> float:
    """The upper median: an order statistic at a tenth of the cost of numpy's own median."""
    middle = len(values) // 2
    return float(np.partition(values, middle)[middle])


def core_sigma(residuals: Array) -> float:
    """The standard deviation of the normal core where up to half may be outliers.

    The median over all is widened by outliers: it is taken again over what lies within 2.5 sigma,
    until nothing changes.
    """
    sigma = robust_sigma(residuals)
    for _ in range(8):
        kept = residuals[np.abs(residuals) < 2.5 * sigma]
        # cut at 2.5 sigma, a normal core shows 1.02 times too small a median
        closer = 1.02 * robust_sigma(kept) if len(kept) > 8 else sigma
        if closer > 0.97 * sigma:
            break
        sigma = closer
    return sigma


def tukey_weights(residuals: Array, sigma: float) -> Array:
    """Tukey's biweight: 1 at zero, 0 from 4.685 sigma on."""
    z = np.minimum(np.abs(residuals) / (TUKEY * sigma), 1.0)
    weights: Array = np.square(1 - z * z)
    return weights


def correlation_inflation(residuals: Array, used: Mask, longest: int = 40) -> float:
    """By how much neighbours along a closed outline repeat each other: variance grows by this.

    `1 + 2 (rho_1 + rho_2 + ...)`, summed until the correlation dies out (the integrated
    autocorrelation; Sokal's window). Never below 1: it may only make a statement more careful.
    """
    values = np.where(used, residuals, 0.0)
    power = float((values**2).mean())
    if power <= 0:
        return 1.0
    total = 1.0
    for lag in range(1, min(longest, len(values) // 4)):
        rho = float((values * np.roll(values, lag)).mean()) / power
        if rho < 0.05:
            break
        total += 2 * rho
    return total


def beside_runs(outliers: Mask, run: int = 3, margin: int = 3) -> Mask:
    """What lies within `margin` of `run` or more outliers in a row, along a closed outline.

    Where something hides the outline, the edges next to its border are still there but pulled.
    """
    count = len(outliers)
    if not outliers.any() or count < run + 2 * margin:
        return np.zeros(count, dtype=bool)
    closed = np.concatenate([outliers[-(run + margin) :], outliers, outliers[: run + margin]])
    starts = np.convolve(closed, np.ones(run, dtype=int), mode="full") >= run
    near = np.convolve(starts, np.ones(run + 2 * margin, dtype=int), mode="full") > 0
    # a run that ends at k marks k - run + 1 - margin to k + margin; each convolution ends late
    first = 2 * (run + margin) - 1
    marked: Mask = near[first : first + count]
    return marked
