# SPDX-License-Identifier: GPL-3.0-or-later
"""Standard normal draws, the same in every run."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from ..arrays import Array


@lru_cache(maxsize=256)
def normals(drawn: int, count: int, number: int = 0) -> Array:
    """Draws (drawn, count), symmetric about zero; another `number` is another set."""
    half = np.random.default_rng([count, number]).normal(size=(drawn // 2, count))
    draws = np.concatenate([half, -half])
    draws.setflags(write=False)
    return draws
