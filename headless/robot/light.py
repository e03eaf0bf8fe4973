# SPDX-License-Identifier: GPL-3.0-or-later
"""Colours between screen values (sRGB, as URDF and PyBullet have them) and linear light."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ...core.arrays import Array


def linear_from_srgb(screen: ArrayLike) -> Array:
    """Screen values from 0 to 1, any shape, to linear light (IEC 61966-2-1).

    >>> linear_from_srgb([0.0, 0.5, 1.0]).round(4).tolist()
    [0.0, 0.214, 1.0]
    """
    s = np.clip(np.asarray(screen, dtype=float), 0.0, 1.0)
    return np.where(s <= 0.04045, s / 12.92, ((s + 0.055) / 1.055) ** 2.4)


def srgb_from_linear(light: ArrayLike) -> Array:
    """The inverse of `linear_from_srgb`."""
    x = np.clip(np.asarray(light, dtype=float), 0.0, 1.0)
    return np.where(x <= 0.0031308, x * 12.92, 1.055 * x ** (1 / 2.4) - 0.055)
