# SPDX-License-Identifier: GPL-3.0-or-later
"""Units that people read lengths in: metres go in, words with the unit come out."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class LengthUnit:
    """A unit by its sign; `digits` behind the point make a tenth of a millimetre."""

    sign: str
    per_metre: float
    digits: int

    def number(self, metres: float, finer: int = 0) -> str:
        """A length without the sign; `finer` adds digits, or takes away those that are few."""
        digits = max(self.digits + finer, 0)
        # adding nought turns -0.0 into 0.0
        return f"{round(metres * self.per_metre, digits) + 0.0:.{digits}f}"


MILLIMETRES = LengthUnit("mm", 1e3, 1)
UNITS = {
    unit.sign: unit
    for unit in (
        MILLIMETRES,
        LengthUnit("cm", 1e2, 2),
        LengthUnit("m", 1.0, 4),
        LengthUnit("in", 1 / 0.0254, 3),
    )
}
