# SPDX-License-Identifier: GPL-3.0-or-later
"""Checked, read-only float arrays: any array-like goes in, one with the stated shape comes out."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import InvalidValue

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


def frozen(value: ArrayLike, shape: tuple[int | None, ...], name: str) -> Array:
    """Return `value` as a finite, read-only float64 array of `shape` (None: any length).

    Raises InvalidValue with the expected and the given shape, or the place of the first
    number that is not finite.
    """
    array = _as_floats(value, name)
    if array.ndim != len(shape) or any(
        n is not None and n != m for n, m in zip(shape, array.shape, strict=True)
    ):
        wanted = "(" + ", ".join("N" if n is None else str(n) for n in shape) + ")"
        raise InvalidValue(f"{name}: expected shape {wanted}, got {array.shape}")
    if not np.isfinite(array).all():
        if array.ndim == 0:
            raise InvalidValue(f"{name}: must be finite, got {float(array)}")
        where = tuple(int(i) for i in np.argwhere(~np.isfinite(array))[0])
        raise InvalidValue(f"{name}: the number at {where} is {array[where]}, not finite")
    array.setflags(write=False)
    return array


def finite(value: Any, name: str) -> float:
    """Return `value` as a finite float. Raises InvalidValue."""
    return float(frozen(value, (), name))


def positive(value: Any, name: str) -> float:
    """Return `value` as a finite float above zero. Raises InvalidValue."""
    number = finite(value, name)
    if number <= 0:
        raise InvalidValue(f"{name}: must be above zero, got {number:g}")
    return number


def _as_floats(value: ArrayLike, name: str) -> Array:
    try:
        return np.array(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise InvalidValue(f"{name}: expected numbers, got {value!r:.60}") from None
