# SPDX-License-Identifier: GPL-3.0-or-later
"""Outlines through three edges each: weights and rays of edges in, triples and outlines out."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array


def drawn_triples(weights: Array, count: int) -> NDArray[np.intp]:
    """Indices (K, count, 3) of edges drawn by weights (K, M): the stronger, the oftener.

    The same draws serve every row and every call: an answer depends on its own edges alone.
    """
    share = np.cumsum(weights, axis=1)
    triples = [np.searchsorted(row[:-1], _draws(count) * row[-1]) for row in share]
    return np.array(triples).reshape(len(weights), count, 3)


@cache
def _draws(count: int) -> Array:
    return np.random.default_rng(0).random(3 * count)


def outlines_through(rays: Array) -> Array:
    """Outlines `w` (..., 3) with `u . w = 1` for each three unit rays u (..., 3, 3).

    NaN where the three lie in one plane. By Cramer's rule: `w = (a x b + b x c + c x a) / [a b c]`.
    """
    a, b, c = rays[..., 0, :], rays[..., 1, :], rays[..., 2, :]
    # seen from one of them the differences are small, and lose no digits
    normal = _cross(b - a, c - a)
    volume = np.einsum("...i,...i->...", a, normal)
    volume = np.where(np.abs(volume) > 1e-12, volume, np.nan)
    outlines: Array = normal / volume[..., None]
    return outlines


def _cross(one: Array, other: Array) -> Array:
    """numpy's own takes five times as long."""
    turned: Array = one[..., [1, 2, 0]] * other[..., [2, 0, 1]]
    turned -= one[..., [2, 0, 1]] * other[..., [1, 2, 0]]
    return turned
