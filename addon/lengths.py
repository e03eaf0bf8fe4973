# SPDX-License-Identifier: GPL-3.0-or-later
"""Lengths as the user's unit has them: metres in, words out."""

from __future__ import annotations

from collections.abc import Iterable

from ..core.length_unit import UNITS


def length(metres: float, unit: str, sigma: float | None = None, finer: int = 0) -> str:
    """One length, with ± 1 sigma where it is known; `finer` adds digits."""
    told = UNITS[unit]
    error = "" if not sigma else f" ± {told.number(sigma, finer)}"
    return f"{told.number(metres, finer)}{error} {unit}"


def lengths(metres: Iterable[float], unit: str, finer: int = 0) -> str:
    """Several lengths with the unit once."""
    return f"{'  '.join(UNITS[unit].number(value, finer) for value in metres)} {unit}"


def place_unit(unit: str) -> str:
    """What coordinates in the world are told in: metres, as robots count, or else inches."""
    return "in" if unit == "in" else "m"
