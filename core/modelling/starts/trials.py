# SPDX-License-Identifier: GPL-3.0-or-later
"""Many guesses of one solid in, all of them descended at once out.

A start needs no last digit: derivatives are differences, and what holds the object is a stiff
spring. The fit that follows is exact. All guesses go through NumPy together, so that fifty cost
little more than one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array, Mask
from ...rotation import hat

DIFFERENCE = 1e-6
FIRST_DAMPING = 1e-3
# indices or a mask
Rows = NDArray[np.intp] | Mask
# a descent whose cost falls by less than this share, and squared pixels, shows where it ends
SETTLED_SHARE, SETTLED_GAIN = 1e-3, 1e-3
# guesses this near to each other, in shares of their sizes, are one
SAME_SHARE = 0.01


@dataclass(frozen=True, eq=False)
class Trials:
    """M guesses of a solid: `rotation` (M, 3, 3), `place` (M, 3), `parameters` (M, P)."""

    rotation: Array
    place: Array
    parameters: Array

    def __len__(self) -> int:
        return len(self.place)

    def chosen(self, rows: Rows) -> Trials:
        """Some of the guesses, by index or mask."""
        return Trials(self.rotation[rows], self.place[rows], self.parameters[rows])

    def moved(self, steps: Array) -> Trials:
        """Each moved by (rotation vector in its own axes, motion, parameters), (M, 6 + P)."""
        return Trials(
            self.rotation @ _rotations(steps[:, :3]),
            self.place + steps[:, 3:6],
            self.parameters + steps[:, 6:],
        )

    def points(self, by: Array) -> Array:
        """World points (M, K, 3) of material points that are linear in the parameters (K, 3, P)."""
        local = np.tensordot(self.parameters, by, axes=(1, 2))
        at: Array = local @ np.swapaxes(self.rotation, 1, 2) + self.place[:, None]
        return at

    def repeated(self, times: int) -> Trials:
        """Every guess several times in a row."""
        return self.chosen(np.repeat(np.arange(len(self)), times))

    @staticmethod
    def joined(parts: list[Trials]) -> Trials:
        """All guesses of several."""
        return Trials(
            np.concatenate([p.rotation for p in parts]),
            np.concatenate([p.place for p in parts]),
            np.concatenate([p.parameters for p in parts]),
        )


Residuals = Callable[[Trials], Array]


def costs(trials: Trials, residuals: Residuals) -> Array:
    """The sum of squared residuals of each guess (M,), infinite where one can't be seen so."""
    values = residuals(trials)
    total: Array = np.where(np.isfinite(values), values**2, np.inf).sum(axis=1)
    return total


def best(trials: Trials, residuals: Residuals, count: int) -> Trials:
    """The guesses with the smallest residuals, best first; none that can't be seen."""
    cost = costs(trials, residuals)
    order = np.argsort(cost, kind="stable")[:count]
    return trials.chosen(order[np.isfinite(cost[order])])


def descended(trials: Trials, residuals: Residuals, free: Mask, steps: int) -> Trials:
    """Each guess after up to `steps` of Marquardt's steps along the `free` (6 + P,) of its tangent.

    The tangent is that of `Trials.moved`.
    """
    values, damping = residuals(trials), np.full(len(trials), FIRST_DAMPING)
    cost = _squared(values)
    for _ in range(steps):
        if not len(trials):
            break
        step = np.zeros((len(trials), len(free)))
        step[:, free] = _steps(_derivatives(trials, values, residuals, free), values, damping)
        tried = trials.moved(step)
        tried_values = residuals(tried)
        tried_cost = _squared(tried_values)
        better = tried_cost < cost
        gained = np.where(better, cost - tried_cost, 0.0)
        trials = _merged(better, tried, trials)
        values = np.where(better[:, None], tried_values, values)
        settled = better & (gained <= SETTLED_SHARE * cost + SETTLED_GAIN)
        cost = np.where(better, tried_cost, cost)
        damping = np.where(better, damping * 0.1, damping * 10.0)
        if (settled | (damping > 1e6)).all():
            break
    return trials


def distinct(trials: Trials, *, polygon: bool = False) -> Trials:
    """The guesses without those that say what an earlier one says.

    The numbers of a `polygon` change with its turn and place in its own frame: of it, only the axis
    is compared.
    """
    kept: list[int] = []
    for i in range(len(trials)):
        scale = np.inf if polygon else SAME_SHARE * float(np.abs(trials.parameters[i]).max())
        if not any(
            np.abs(trials.parameters[i] - trials.parameters[j]).max() < scale
            and np.abs(trials.place[i] - trials.place[j]).max() < scale
            and np.abs(trials.rotation[i, :, 2] - trials.rotation[j, :, 2]).max() < SAME_SHARE
            for j in kept
        ):
            kept.append(i)
    return trials.chosen(np.array(kept, dtype=int))


def _squared(values: Array) -> Array:
    squared: Array = np.where(np.isfinite(values), values**2, np.inf).sum(axis=1)
    return squared


def _derivatives(trials: Trials, values: Array, residuals: Residuals, free: Mask) -> Array:
    """Of the residuals by the free tangent, (M, N, F)."""
    columns = np.flatnonzero(free)
    nudges = DIFFERENCE * np.eye(len(free))[columns]
    nudged = trials.repeated(len(columns)).moved(np.tile(nudges, (len(trials), 1)))
    changed = residuals(nudged).reshape(len(trials), len(columns), values.shape[1])
    by = np.swapaxes(changed - values[:, None], 1, 2) / DIFFERENCE
    return np.nan_to_num(by, nan=0.0, posinf=0.0, neginf=0.0)


def _steps(by: Array, values: Array, damping: Array) -> Array:
    finite = np.nan_to_num(values, nan=0.0, posinf=0.0, neginf=0.0)
    scale = np.sqrt((by**2).sum(axis=1))
    scale[scale == 0] = 1.0
    unit = by / scale[:, None]
    turned = np.swapaxes(unit, 1, 2)
    normal = turned @ unit
    diagonal = np.arange(normal.shape[1])
    # directions that nothing determines are damped, too
    normal[:, diagonal, diagonal] += damping[:, None] + 1e-12
    gradient = turned @ finite[:, :, None]
    step: Array = -np.linalg.solve(normal, gradient)[:, :, 0] / scale
    return step


def _merged(better: Mask, one: Trials, other: Trials) -> Trials:
    return Trials(
        np.where(better[:, None, None], one.rotation, other.rotation),
        np.where(better[:, None], one.place, other.place),
        np.where(better[:, None], one.parameters, other.parameters),
    )


def _rotations(vectors: Array) -> Array:
    """Rodrigues' formula for rotation vectors (M, 3)."""
    angle = np.sqrt((vectors**2).sum(axis=1))[:, None, None]
    k = hat(vectors)
    sine = np.sinc(angle / np.pi)
    versine = 0.5 * np.sinc(angle / (2 * np.pi)) ** 2
    rotation: Array = np.eye(3) + sine * k + versine * (k @ k)
    return rotation
