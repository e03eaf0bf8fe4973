# SPDX-License-Identifier: GPL-3.0-or-later
"""Nonlinear least squares: residuals with analytic derivatives in, the minimum out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

import numpy as np

from .arrays import Array

T = TypeVar("T")
LARGEST_DAMPING = 1e12
SMALLEST_DAMPING = 1e-12


@dataclass(frozen=True, eq=False)
class Minimum(Generic[T]):
    """Where the descent ended: the value, its whitened residuals (N,) and jacobian (N, P).

    `converged` is False when the steps ran out first.
    """

    value: T
    residuals: Array
    jacobian: Array
    converged: bool

    @property
    def cost(self) -> float:
        """Half the sum of squared residuals."""
        return 0.5 * float(self.residuals @ self.residuals)


def levenberg_marquardt(
    start: T,
    evaluate: Callable[[T], tuple[Array, Array]],
    move: Callable[[T, Array], T],
    *,
    steps: int = 60,
    tolerance: float = 1e-10,
) -> Minimum[T]:
    """Minimise the squared residuals that `evaluate` returns with their jacobian (N,), (N, P).

    `move(value, step)` applies a step (P,) on the value's own manifold. Residuals must be divided
    by their sigma beforehand. The damping follows Marquardt (1963), scaled by the diagonal, so that
    metres and radians need no common unit. Ends when a step promises less than `tolerance` of the
    cost, or when the cost has no digits left to lose.
    """
    value, (residuals, jacobian) = start, evaluate(start)
    damping = 1e-4
    for _ in range(steps):
        step, promised = _damped_step(residuals, jacobian, damping)
        cost = float(residuals @ residuals)
        if promised <= tolerance * (cost + 1e-24):
            return Minimum(value, residuals, jacobian, converged=True)
        tried = move(value, step)
        tried_residuals, tried_jacobian = evaluate(tried)
        tried_cost = float(tried_residuals @ tried_residuals)
        if np.isfinite(tried_cost) and tried_cost < cost:
            value, residuals, jacobian = tried, tried_residuals, tried_jacobian
            damping = max(damping * 0.2, SMALLEST_DAMPING)
        elif damping >= LARGEST_DAMPING:
            return Minimum(value, residuals, jacobian, converged=True)
        else:
            damping *= 8.0
    return Minimum(value, residuals, jacobian, converged=False)


def _damped_step(residuals: Array, jacobian: Array, damping: float) -> tuple[Array, float]:
    """Marquardt's step (P,), and by how much it promises to lower the squared residuals."""
    scale = np.linalg.norm(jacobian, axis=0)
    scale[scale == 0] = 1.0
    unit = jacobian / scale
    # with unit columns, lstsq drops what is undetermined and never what is only in small units
    normal, gradient = unit.T @ unit, unit.T @ residuals
    step = -np.linalg.lstsq(normal + damping * np.diag(np.diag(normal)), gradient, rcond=None)[0]
    return step / scale, -float(gradient @ step)
