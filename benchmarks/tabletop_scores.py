# SPDX-License-Identifier: GPL-3.0-or-later
"""How far modelled things are from the truth and from what they state: errors of each, in a row.

The truth enters here alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from monocell.core.comparison import object_error
from monocell.core.primitives import Box, Primitive

# an eigenvalue of a covariance below this share of the largest is a direction given, not solved
GIVEN = 1e-10
# and in such a direction nothing is off by more than rounding, metres
ROUNDING = 1e-6
# the 95 % point of chi-squared by its degrees of freedom
QUANTILES = (0.0, 3.841, 5.991, 7.815, 9.488, 11.070, 12.592, 14.067, 15.507, 16.919, 18.307)
HEADER = ("things", "refused", "warned", "size %", "90 %", "place mm", "90 %", "in 95 %")


@dataclass(frozen=True, eq=False)
class ThingScore:
    """Of one thing: `place` is the error of its centre in metres, `size_errors` are shares of the
    true sizes, of those that were solved.

    `inside` tells whether place and sizes lie in the stated ellipsoid of 95 %. `refusal` is why
    there is no such thing, else empty.
    """

    cell: str
    name: str
    size_errors: np.ndarray
    place: float
    inside: bool
    warnings: tuple[str, ...] = ()
    refusal: str = ""


def refused(cell: str, name: str, why: str) -> ThingScore:
    return ThingScore(cell, name, np.full(0, np.nan), np.nan, False, (), why)


def score(
    cell: str, truth: Primitive, estimate: Primitive, warnings: tuple[str, ...]
) -> ThingScore:
    """Estimate minus truth; a box may have its x and y exchanged."""
    error = object_error(truth, estimate)
    solved = [name not in estimate.known for name in truth.size_names]
    return ThingScore(
        cell,
        truth.name,
        (np.abs(error.sizes) / truth.sizes)[solved],
        float(np.linalg.norm(error.position)),
        _inside(truth, estimate, np.concatenate([error.position, error.sizes])),
        warnings,
    )


def figures(scores: Sequence[ThingScore]) -> tuple[str, ...]:
    """The columns of `HEADER`. Sizes count one by one, each against itself."""
    solved = [s for s in scores if not s.refusal]
    counts = (str(len(scores)), str(len(scores) - len(solved)), str(sum(map(_warned, solved))))
    if not solved:
        return (*counts, *["-"] * 5)
    sizes = 100 * np.concatenate([s.size_errors for s in solved])
    places = 1e3 * np.array([s.place for s in solved])
    return (
        *counts,
        *(f"{np.quantile(sizes, q):.2f}" if len(sizes) else "-" for q in (0.5, 0.9)),
        *(f"{np.quantile(places, q):.2f}" for q in (0.5, 0.9)),
        f"{100 * np.mean([s.inside for s in solved]):.1f}",
    )


def _warned(one: ThingScore) -> bool:
    return bool(one.warnings)


def _inside(truth: Primitive, estimate: Primitive, error: np.ndarray) -> bool:
    """Whether an error of (place, sizes) lies in the 95 % ellipsoid of the estimate."""
    if estimate.covariance is None:
        return False
    places = [3, 4, 5, *(6 + k for k in _order(truth, estimate))]
    values, axes = np.linalg.eigh(estimate.covariance[np.ix_(places, places)])
    solved = values > GIVEN * values.max()
    along = axes.T @ error
    if np.abs(along[~solved]).max(initial=0.0) > ROUNDING:
        return False
    square = float((along[solved] ** 2 / values[solved]).sum())
    return square < QUANTILES[int(solved.sum())]


def _order(truth: Primitive, estimate: Primitive) -> list[int]:
    """Which of the estimate's sizes each of the truth's is."""
    if not isinstance(truth, Box):
        return list(range(len(truth.sizes)))
    turn = np.abs(truth.world_from_object.rotation.T @ estimate.world_from_object.rotation)
    return [int(k) for k in turn.argmax(axis=1)]
