# SPDX-License-Identifier: GPL-3.0-or-later
"""What a fit did not solve for and yet would explain it better: its equations in, answers out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..covariance import inverse_information


@dataclass(frozen=True)
class Answer:
    """How far something seems off, with 1 sigma, and by how many sigmas that is no chance."""

    value: float
    sigma: float
    explained: float
    significance: float


@dataclass(frozen=True, eq=False)
class Asked:
    """The normal equations of a fit with more unknowns than it solved for.

    - `names`: what can be asked beside the P solved: `radius` and `focal` as logarithms of a
      factor, `radial` as an error of the lens' first radial coefficient
    - `information` (P + A, P + A) and `gradient` (P + A,), priors included
    - `chi_squared` and `freedom`: what the fit is left with
    """

    names: tuple[str, ...]
    information: Array
    gradient: Array
    chi_squared: float
    freedom: int

    def about(self, name: str, given: Sequence[str] = ()) -> Answer | None:
        """What solving for `name` too would give, after those `given`; None where it can't be told.

        The significance is that of Student's t, as sigmas of a normal (Wallace 1959): the noise is
        judged by the same few residuals.
        """
        before = self._solved(given)
        after = self._solved((*given, name))
        freedom = self.freedom - len(given) - 1
        if before is None or after is None or freedom < 1:
            return None
        explained = after[2] - before[2]
        left = max(1.0, (self.chi_squared - after[2]) / freedom)
        value, variance = float(after[0][-1]), float(after[1][-1, -1])
        t = abs(value) / np.sqrt(variance * left)
        share = (8 * freedom + 1) / (8 * freedom + 3)
        normal = share * np.sqrt(freedom * np.log1p(t * t / freedom))
        return Answer(value, float(np.sqrt(variance * left)), explained / left, float(normal))

    def _solved(self, names: Sequence[str]) -> tuple[Array, Array, float] | None:
        """Step, covariance, and chi-squared explained, of the P and `names`."""
        count = len(self.gradient) - len(self.names)
        chosen = [*range(count), *(count + self.names.index(name) for name in names)]
        gradient = self.gradient[chosen]
        covariance = inverse_information(self.information[np.ix_(chosen, chosen)])
        if covariance is None:
            return None
        step = -covariance @ gradient
        return step, covariance, float(-step @ gradient)
