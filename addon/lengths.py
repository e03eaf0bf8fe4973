# SPDX-License-Identifier: GPL-3.0-or-later
"""Lengths as the user's unit has them: metres in, words out."""

from __future__ import annotations

from collections.abc import Iterable

PER_METRE = {"mm": 1e3, "cm": 1e2, "m": 1.0, "in": 1 / 0.0254}
# digits behind the point that make a tenth of a millimetre
DIGITS = {"mm": 1, "cm": 2, "m": 4, "in": 3}


def length(metres: float, unit: str, sigma: float | None = None, finer: int = 0) -> str:
    """One length, with ± 1 sigma where it is known; `finer` adds digits."""
    digits = DIGITS[unit] + finer
    error = "" if not sigma else f" ± {sigma * PER_METRE[unit]:.{digits}f}"
    return f"{metres * PER_METRE[unit]:.{digits}f}{error} {unit}"


def lengths(metres: Iterable[float], unit: str, finer: int = 0) -> str:
    """Several lengths with the unit once."""
    # adding nought turns -0.0 into 0.0
    digits = DIGITS[unit] + finer
    told = (f"{round(value * PER_METRE[unit], digits) + 0.0:.{digits}f}" for value in metres)
    return f"{'  '.join(told)} {unit}"
