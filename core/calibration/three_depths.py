# SPDX-License-Identifier: GPL-3.0-or-later
"""Depths from distances: three rays and the distances between three points in, the depths out.

The paper's section 3.2 (eq. 9-15), known as P3P: each pair of rays and its distance is an
elliptical cylinder in the depths, and the three meet in at most four real places.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array, frozen

PAIRS = ((1, 2), (0, 2), (0, 1))
# relative: how real a root is, how well distances are met, how near two answers are the same: at a
# double root polishing ends that far apart
REAL, FITS, SAME = 1e-3, 1e-6, 3e-5
POLISHING = 6


def depths_of_three(rays: ArrayLike, points_world: ArrayLike) -> Array:
    """All positive depths (K, 3), K from 0 to 4, along unit rays (3, 3) to points (3, 3) apart.

    `|s_i u_i - s_j u_j| == |p_i - p_j|`. Eliminated to a quartic in `s_3 / s_1` (Grunert 1841, in
    the form of Haralick and others 1994), then polished by Newton's method on the distances.
    """
    u = frozen(rays, (3, 3), "rays")
    p = frozen(points_world, (3, 3), "points_world")
    squared = np.array([((p[i] - p[j]) ** 2).sum() for i, j in PAIRS])
    cosines = np.array([u[1] @ u[2], u[0] @ u[2], u[0] @ u[1]])
    lengths = np.sqrt(squared)
    found: list[Array] = []
    for depths in _rough_depths(_ratios(squared, cosines), squared, cosines):
        exact = _polished(depths, u, lengths)
        fits = np.abs(_distances(exact, u) - lengths).max() < FITS * lengths.max()
        known = any(np.allclose(exact, other, rtol=SAME) for other in found)
        if fits and (exact > 0).all() and not known:
            found.append(exact)
    return np.array(found).reshape(-1, 3)


def _ratios(squared: Array, cosines: Array) -> Array:
    """Positive real roots of the quartic in `s_3 / s_1`."""
    a, b, c = squared
    alpha, beta, gamma = cosines
    q, r = (a - c) / b, (a + c) / b
    quartic = [
        (q - 1) ** 2 - 4 * c / b * alpha**2,
        4 * (q * (1 - q) * beta - (1 - r) * alpha * gamma + 2 * c / b * alpha**2 * beta),
        2
        * (
            q**2
            - 1
            + 2 * q**2 * beta**2
            + 2 * (b - c) / b * alpha**2
            - 4 * r * alpha * beta * gamma
            + 2 * (b - a) / b * gamma**2
        ),
        4 * (-q * (1 + q) * beta + 2 * a / b * gamma**2 * beta - (1 - r) * alpha * gamma),
        (1 + q) ** 2 - 4 * a / b * gamma**2,
    ]
    roots = np.roots(quartic)
    # noise parts a double root into a pair beside the real axis: its real part is polished later
    real = roots[np.abs(roots.imag) < REAL * np.maximum(1, np.abs(roots))].real
    return real[real > 0]


def _rough_depths(ratios: Array, squared: Array, cosines: Array) -> list[Array]:
    """Depths for each ratio `s_3 / s_1`: the second lies on a circle round the first point.

    Both of the circle's answers are given; the third distance tells later which one holds.
    """
    _, b, c = squared
    _, beta, gamma = cosines
    rough = []
    for v in ratios:
        first = b / max(1 + v * v - 2 * v * beta, 1e-300)
        # noise at a double root may leave the circle by a hair
        root = np.sqrt(max(gamma**2 - 1 + c / first, 0.0))
        rough += [np.sqrt(first) * np.array([1.0, u, v]) for u in {gamma + root, gamma - root}]
    return rough


def _polished(depths: Array, rays: Array, lengths: Array) -> Array:
    for _ in range(POLISHING):
        jacobian = np.zeros((3, 3))
        for k, (i, j) in enumerate(PAIRS):
            between = depths[i] * rays[i] - depths[j] * rays[j]
            way = between / max(float(np.linalg.norm(between)), 1e-300)
            jacobian[k, i], jacobian[k, j] = rays[i] @ way, -(rays[j] @ way)
        step = np.linalg.lstsq(jacobian, _distances(depths, rays) - lengths, rcond=None)[0]
        depths = depths - step
    return depths


def _distances(depths: Array, rays: Array) -> Array:
    placed = rays * depths[:, None]
    return np.array([np.linalg.norm(placed[i] - placed[j]) for i, j in PAIRS])
