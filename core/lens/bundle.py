# SPDX-License-Identifier: GPL-3.0-or-later
"""Corners in many pictures and a first lens in, the lens and all board poses that fit best out.

Maximum likelihood over the lens's parameters and six numbers a picture, with analytic derivatives;
the pictures' own unknowns are eliminated (Schur's complement), so that a step costs little however
many pictures there are. OpenCV minimises the same sum; it states no error for a fisheye.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..errors import InvalidValue
from ..intrinsics import Intrinsics
from ..pose import Pose, point_jacobian
from .parameters import parameters_of, pixels_by_parameters, with_parameters
from .view import BoardView

STEPS, TOLERANCE, LARGEST_DAMPING = 80, 1e-7, 1e12
# coefficients that the pictures leave free are still a lens's: this many at 1 sigma
COEFFICIENT_SIGMA = 10.0
SINGULAR = 1e-14


@dataclass(frozen=True, eq=False)
class LensFit:
    """A lens and the `camera_from_board` of each view, with residuals seen minus expected.

    `held` are the places of the lens's parameters that are given and not solved for.
    """

    lens: Intrinsics
    poses: tuple[Pose, ...]
    views: tuple[BoardView, ...]
    held: tuple[int, ...] = ()
    converged: bool = True

    @cached_property
    def residuals(self) -> tuple[Array, ...]:
        """Of each view, (N, 2) in pixels; NaN for what the lens does not image."""
        return tuple(
            view.pixels - self.lens.project(pose.apply(view.points))
            for view, pose in zip(self.views, self.poses, strict=True)
        )

    @cached_property
    def rms_pixels(self) -> float:
        """Root mean square distance of a corner from where it is expected."""
        return _rms(np.concatenate(self.residuals))

    @property
    def rms_of_views(self) -> Array:
        """The same of each view, (V,)."""
        return np.array([_rms(r) for r in self.residuals])

    @cached_property
    def normal(self) -> NormalEquations:
        """The normal equations at this fit."""
        return NormalEquations.at(self)

    @cached_property
    def noise_pixels(self) -> float:
        """The standard deviation of one coordinate of a corner."""
        numbers = sum(2 * len(r) for r in self.residuals)
        solved = len(parameters_of(self.lens)) - len(self.held)
        free = numbers - solved - 6 * len(self.views)
        square = sum(float((r**2).sum()) for r in self.residuals)
        return float(np.sqrt(square / max(free, 1)))

    @cached_property
    def covariance(self) -> Array | None:
        """Of the lens's parameters, (P, P); None where the pictures do not determine them.

        The noise is that of the residuals. What the corners of one picture have in common (a bent
        board, a blur) counts once: the covariance grows by the square of `disagreement`.
        """
        inverse = self._inverse
        if inverse is None:
            return None
        covariance = np.zeros_like(self.normal.lens[0])
        among = np.ix_(self._free, self._free)
        covariance[among] = (self.noise_pixels * max(1.0, self.disagreement)) ** 2 * inverse
        return covariance

    @cached_property
    def disagreement(self) -> float:
        """By how much more the pictures pull at the lens than their corners' noise explains.

        1 for independent corners; the root of the pulls' sum of squares over its expectation.
        """
        inverse = self._inverse
        if inverse is None:
            return 1.0
        _, pulls, shares = self.normal.reduced(0.0)
        own = [inverse @ share[np.ix_(self._free, self._free)] for share in shares]
        pulled = pulls[:, self._free] / max(self.noise_pixels, 1e-12)
        scatter = float(np.einsum("vi,ij,vj->", pulled, inverse, pulled))
        expected = len(inverse) - float(sum(np.trace(s @ s) for s in own))
        # two pictures leave nothing to disagree about
        return float(np.sqrt(scatter / expected)) if expected > 0.5 else 1.0

    @property
    def _free(self) -> NDArray[np.intp]:
        return np.setdiff1d(np.arange(len(parameters_of(self.lens))), self.held)

    @cached_property
    def _inverse(self) -> Array | None:
        """The inverse of the lens's own normal matrix, of what is solved for."""
        reduced = self.normal.reduced(0.0)[0]
        prior = np.where(self._free >= 4, (self.noise_pixels / COEFFICIENT_SIGMA) ** 2, 0.0)
        return _inverse(reduced[np.ix_(self._free, self._free)] + np.diag(prior))


@dataclass(frozen=True, eq=False)
class NormalEquations:
    """Blocks of each view: lens (V, P, P), mixed (V, P, 6), pose (V, 6, 6), and right sides."""

    lens: Array
    mixed: Array
    pose: Array
    lens_side: Array
    pose_side: Array

    @staticmethod
    def at(fit: LensFit) -> NormalEquations:
        blocks = [
            _blocks(fit, view, pose, residuals)
            for view, pose, residuals in zip(fit.views, fit.poses, fit.residuals, strict=True)
        ]
        return NormalEquations(*(np.array(part) for part in zip(*blocks, strict=True)))

    def reduced(self, damping: float) -> tuple[Array, Array, tuple[Array, ...]]:
        """The lens's own normal matrix (P, P), and each view's pull (V, P) and share (P, P)."""
        inverse = np.linalg.pinv(_damped(self.pose, damping), hermitian=True)
        carried = self.mixed @ inverse
        shares = _damped(self.lens, damping) - carried @ np.swapaxes(self.mixed, 1, 2)
        pulls = self.lens_side - (carried @ self.pose_side[:, :, None])[:, :, 0]
        return shares.sum(axis=0), pulls, tuple(shares)

    def step(self, damping: float) -> tuple[Array, Array]:
        """Marquardt's step of the lens (P,) and of the poses (V, 6)."""
        matrix, pulls, _ = self.reduced(damping)
        of_lens = _solved(matrix, pulls.sum(axis=0))
        left = self.pose_side - np.swapaxes(self.mixed, 1, 2) @ of_lens
        inverse = np.linalg.pinv(_damped(self.pose, damping), hermitian=True)
        return of_lens, (inverse @ left[:, :, None])[:, :, 0]

    def promised(self, of_lens: Array, of_poses: Array) -> float:
        """By how much a step promises to lower the sum of squares, at least."""
        lens = float(self.lens_side.sum(axis=0) @ of_lens)
        return lens + float((self.pose_side * of_poses).sum())


def fit_lens(start: LensFit, *, steps: int = STEPS) -> LensFit:
    """Descend from `start` to the least sum of squared residuals (Levenberg and Marquardt).

    Raises InvalidValue where the first lens does not image all corners.
    """
    fit, damping = start, 1e-4
    cost = _cost(fit)
    if not np.isfinite(cost):
        raise InvalidValue("the first lens does not image every corner; take another model")
    for _ in range(steps):
        of_lens, of_poses = fit.normal.step(damping)
        if fit.normal.promised(of_lens, of_poses) <= TOLERANCE * (cost + 1e-12):
            return replace(fit, converged=True)
        tried = _moved(fit, of_lens, of_poses)
        tried_cost = np.inf if tried is None else _cost(tried)
        if tried is not None and tried_cost < cost:
            fit, cost, damping = tried, tried_cost, max(0.1 * damping, 1e-12)
        elif damping >= LARGEST_DAMPING:
            return replace(fit, converged=True)
        else:
            damping *= 10
    return replace(fit, converged=False)


def fit_pose(lens: Intrinsics, view: BoardView, start: Pose, *, steps: int = 30) -> Pose:
    """The pose of one board under a lens that is taken as known."""
    fit, damping = LensFit(lens, (start,), (view,)), 1e-4
    cost = _cost(fit)
    for _ in range(steps if np.isfinite(cost) else 0):
        normal = fit.normal
        step = _solved(_damped(normal.pose[0], damping), normal.pose_side[0])
        if float(step @ normal.pose_side[0]) <= TOLERANCE * (cost + 1e-12):
            break
        tried = replace(fit, poses=(fit.poses[0].perturbed(step),))
        if (tried_cost := _cost(tried)) < cost:
            fit, cost, damping = tried, tried_cost, max(0.1 * damping, 1e-12)
        else:
            damping *= 10
    return fit.poses[0]


def subset(fit: LensFit, which: Sequence[int]) -> LensFit:
    """The fit with some of its views only."""
    return replace(
        fit,
        poses=tuple(fit.poses[i] for i in which),
        views=tuple(fit.views[i] for i in which),
    )


def _blocks(
    fit: LensFit, view: BoardView, pose: Pose, residuals: Array
) -> tuple[Array, Array, Array, Array, Array]:
    points = pose.apply(view.points)
    _, by_point = fit.lens.project_with_jacobian(points)
    by_lens = pixels_by_parameters(fit.lens, points).reshape(2 * len(points), -1)
    by_lens[:, list(fit.held)] = 0.0
    by_pose = (by_point @ point_jacobian(points)).reshape(-1, 6)
    left = residuals.ravel()
    return (
        by_lens.T @ by_lens,
        by_lens.T @ by_pose,
        by_pose.T @ by_pose,
        by_lens.T @ left,
        by_pose.T @ left,
    )


def _moved(fit: LensFit, of_lens: Array, of_poses: Array) -> LensFit | None:
    """The fit after a step, or None where the step leaves what a lens can be."""
    try:
        lens = with_parameters(fit.lens, parameters_of(fit.lens) + of_lens)
        poses = tuple(p.perturbed(s) for p, s in zip(fit.poses, of_poses, strict=True))
    except InvalidValue:
        return None
    return replace(fit, lens=lens, poses=poses)


def _cost(fit: LensFit) -> float:
    cost = sum(float((r**2).sum()) for r in fit.residuals)
    return cost if np.isfinite(cost) else float("inf")


def _damped(matrices: Array, damping: float) -> Array:
    """Matrices (..., n, n) with their diagonals raised by a share."""
    raised: Array = matrices * (1 + damping * np.eye(matrices.shape[-1]))
    return raised


def _solved(matrix: Array, side: Array) -> Array:
    """The solution in unit columns, so that what is not determined at all stays where it is."""
    scale = np.sqrt(np.maximum(np.diag(matrix), 1e-300))
    unit = matrix / np.outer(scale, scale)
    return np.linalg.lstsq(unit, side / scale, rcond=None)[0] / scale


def _inverse(matrix: Array) -> Array | None:
    """The inverse of a normal matrix in unit columns; None where it is singular to the last digit.

    The coefficients of a rational lens may repeat each other almost wholly: that is no reason not
    to state the error of its focal length.
    """
    if not np.isfinite(matrix).all() or (np.diag(matrix) <= 0).any():
        return None
    scale = 1.0 / np.sqrt(np.diag(matrix))
    values, vectors = np.linalg.eigh(matrix * np.outer(scale, scale))
    if values.min() < SINGULAR * values.max():
        return None
    inverse: Array = (vectors / values) @ vectors.T * np.outer(scale, scale)
    return 0.5 * (inverse + inverse.T)


def _rms(residuals: Array) -> float:
    return float(np.sqrt((residuals**2).sum(axis=1).mean()))
