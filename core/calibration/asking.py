# SPDX-License-Identifier: GPL-3.0-or-later
"""What a fit did not solve for and yet would explain it better: its equations in, answers out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..covariance import inverse_information
from .place_noise import across_pulls, own_pulls

# with no more left than this the sightings' own noise explains all, and is known beforehand
ALL_EXPLAINED = 1.5


@dataclass(frozen=True)
class Answer:
    """How far something seems off, with 1 sigma, and by how many sigmas that is no chance.

    `explained` is how much of chi-squared it takes away, of what is left without it.
    """

    value: float
    sigma: float
    explained: float
    significance: float


@dataclass(frozen=True, eq=False)
class Asked:
    """The normal equations of a fit with more unknowns than it solved for.

    - `names`: what can be asked beside the P solved: `radius` and `focal` as logarithms of a
      factor, `radial` as an error of the lens' first radial coefficient
    - `information` (P + A, P + A) and `gradient` (P + A,), by the sightings' own noise, with priors
    - `grams` (S, M, M), `allowed` (S, 3, 3), `chain` (S, M - 1, P + A): the sightings themselves
    - `freedom` of all that they tell, and `across` the lines of sight alone
    """

    names: tuple[str, ...]
    information: Array
    gradient: Array
    grams: Array
    allowed: Array
    chain: Array
    freedom: int
    across: int

    def about(self, name: str, given: Sequence[str] = ()) -> Answer | None:
        """What solving for `name` too would give, after those `given`; None where it can't be told.

        Where noise has to be judged by what is left, the significance is that of Student's t, as
        sigmas of a normal (Wallace 1959).
        """
        before, after = self._solved(given), self._solved((*given, name))
        more = len(given) + 1
        if before is None or after is None or self.across <= more:
            return None
        left = self._left(after[0], (*given, name))
        value, variance = float(after[0][-1]), float(after[1][-1, -1])
        t = abs(value) / np.sqrt(variance * left)
        freedom = max(1, (self.freedom if left < ALL_EXPLAINED else self.across) - more)
        share = (8 * freedom + 1) / (8 * freedom + 3)
        normal = share * np.sqrt(freedom * np.log1p(t * t / freedom))
        explained = (after[2] - before[2]) / left
        return Answer(value, float(np.sqrt(variance * left)), explained, float(normal))

    def _chosen(self, names: Sequence[str]) -> list[int]:
        count = len(self.gradient) - len(self.names)
        return [*range(count), *(count + self.names.index(name) for name in names)]

    def _solved(self, names: Sequence[str]) -> tuple[Array, Array, float] | None:
        """Step, covariance, and chi-squared explained, of the P and `names`."""
        chosen = self._chosen(names)
        gradient = self.gradient[chosen]
        covariance = inverse_information(self.information[np.ix_(chosen, chosen)])
        if covariance is None:
            return None
        step = -covariance @ gradient
        return step, covariance, float(-step @ gradient)

    def _left(self, step: Array, names: Sequence[str]) -> float:
        """What a step leaves of chi-squared for each degree of freedom, in all and across."""
        moves = self.chain[:, :, self._chosen(names)] @ step
        grams = self.grams.copy()
        grams[:, :-1, -1] += np.einsum("sij,sj->si", self.grams[:, :-1, :-1], moves)
        in_all = own_pulls(grams, self.allowed).sum() / max(1, self.freedom - len(names))
        across = across_pulls(grams, self.allowed).sum() / max(1, self.across - len(names))
        return max(1.0, float(in_all), float(across))
