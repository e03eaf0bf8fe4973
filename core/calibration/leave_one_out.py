# SPDX-License-Identifier: GPL-3.0-or-later
"""What each sighting does to the pose: a joint fit in, what leaving one of them out changes, out.

Nothing is fitted again: one Gauss-Newton step on the fit's own normal equations without the
sighting tells the change to first order.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..covariance import inverse_information
from .common_error import Say
from .ellipsoid import three_f_tail
from .joint_pose import JointFit
from .unknowns import BIAS

# the pose hangs on a sighting without which the camera moves by so many of its stated sigmas
HANGS_SIGMAS = 5.0
# a sighting disagrees when chance would show as much in so few of all calibrations
DISAGREES_CHANCE = 0.002
# beside the worst, others that chance would show this rarely, and without which the rest agrees by
# this share of the best factor, may be the culprit as well; where so few numbers are left to check,
# the factor itself is chance
SUSPECT_CHANCE, SUSPECT_SHARE, FEW_CHECKS = 0.05, 0.5, 4
DETERMINED = 1e-4


@dataclass(frozen=True, eq=False)
class LeftOut:
    """What becomes of the camera without one sighting.

    - `centre_moves` (3,), metres in the world, or in the flange that carries the camera; `turns`
      (3,), radians about the camera's axes
    - `sigmas`: the motion in stated sigmas of the pose, along the direction where it is most
    - `position_sigma`: total 1 sigma of the position without the sighting, metres
    - `agreement`: by what factor the other sightings agree better without it
    - `chance`: how often a sighting as good as the others would disagree with them this much;
      NaN where too few others are left to tell
    - `checks`: how many more numbers the other sightings give than there are unknowns
    """

    centre_moves: Array
    turns: Array
    sigmas: float
    position_sigma: float
    agreement: float
    chance: float
    checks: int

    @property
    def moves(self) -> float:
        """How far the camera's centre moves, metres."""
        return float(np.linalg.norm(self.centre_moves))

    @property
    def turn(self) -> float:
        """How far the camera turns, radians."""
        return float(np.linalg.norm(self.turns))


def leave_one_out(fit: JointFit) -> tuple[LeftOut | None, ...]:
    """One a sighting of the fit, in its order; None where the others can't hold the pose."""
    weighed, exact = _Normal.of(fit, fit.says), _Normal.of(fit, fit.own_says)
    if weighed is None or exact is None:
        return (None,) * len(fit.says)
    freedom = fit.asked.freedom
    return tuple(
        _without(fit, weighed, say, exact.surprise(own, freedom))
        for say, own in zip(fit.says, fit.own_says, strict=True)
    )


def leverage_warnings(
    names: Sequence[str], changes: Sequence[LeftOut | None], position_sigma: float
) -> tuple[str, ...]:
    """The sighting that the pose hangs on or that disagrees with the others, the worst one.

    `names` are those of the sightings of the fit; `position_sigma` is the stated total.
    """
    alike = DISAGREES_CHANCE / max(1, len(changes))
    known = [(n, c) for n, c in zip(names, changes, strict=True) if c is not None]
    judged = sorted((one for one in known if one[1].chance <= 1), key=lambda one: one[1].chance)
    if judged and judged[0][1].chance < alike:
        return (_accusation(judged),)
    hanging = [(n, c) for n, c in known if c.sigmas > HANGS_SIGMAS]
    if not hanging:
        return ()
    name, change = max(hanging, key=lambda one: one[1].sigmas)
    return (
        f"the pose hangs on {name}: without it {_moved(change)}, and its position is known to "
        f"{1e3 * change.position_sigma:.1f} mm instead of {1e3 * position_sigma:.1f}; "
        "hold the ball near there once more",
    )


def _accusation(known: Sequence[tuple[str, LeftOut]]) -> str:
    """Of the sightings, the most suspect first: the culprit, or those it is among."""
    name, change = known[0]
    least = 0.0 if change.checks < FEW_CHECKS else SUSPECT_SHARE * change.agreement
    suspects = [n for n, c in known if c.chance < SUSPECT_CHANCE and c.agreement > least]
    effect = f"{_moved(change)}, and the others agree {change.agreement:.1f} times better"
    if len(suspects) == 1:
        return (
            f"{name} disagrees with the others: without it {effect}; check its picture and position"
        )
    return (
        f"one of {', '.join(suspects)} disagrees with the others, too few to tell which: without "
        f"{name} {effect}; check their pictures and positions, add a sighting"
    )


def _moved(change: LeftOut) -> str:
    return (
        f"the camera moves by {1e3 * change.moves:.1f} mm and {np.degrees(change.turn):.3f} deg, "
        f"{change.sigmas:.1f} of its sigmas"
    )


@dataclass(frozen=True)
class _Surprise:
    """By what factor the others agree better without one, how rare that is, and how many checks."""

    agreement: float
    chance: float
    checks: int


@dataclass(frozen=True, eq=False)
class _Normal:
    """The normal equations of all sightings, their inverse, and chi-squared where they cancel."""

    information: Array
    gradient: Array
    covariance: Array
    pull: float

    @staticmethod
    def of(fit: JointFit, says: Sequence[Say]) -> _Normal | None:
        information = sum((say.information for say in says), fit.prior_information)
        prior = fit.prior_information[BIAS] * fit.edge_bias_pixels
        gradient = sum((say.gradient for say in says), prior)
        covariance = inverse_information(information)
        if covariance is None:
            return None
        pull = float(sum(say.pull for say in says) - gradient @ covariance @ gradient)
        return _Normal(information, gradient, covariance, pull)

    def surprise(self, say: Say, freedom: int) -> _Surprise:
        """How much one sighting disagrees, against the scale that the others show.

        The scale is not let fall below the outlines' own: agreeing by luck accuses nobody.
        """
        gain, directions = self._disagreement(say)
        checks = max(0, freedom - directions)
        if checks < 1 or directions == 0:
            return _Surprise(1.0, float("nan"), checks)
        scale = max(1.0, (self.pull - gain) / checks)
        agreement = float(np.sqrt(max(1.0, self.pull / freedom) / scale))
        # a mean square over its directions, as three of them would show it
        return _Surprise(agreement, three_f_tail(3 * gain / directions / scale, checks), checks)

    def _disagreement(self, say: Say) -> tuple[float, int]:
        """By how much chi-squared falls without a sighting, and in how many directions it may.

        Where all gradients cancel, its own has the covariance `I - I C I` when it is as good as
        the others.
        """
        information = say.information
        cancelled = say.gradient - information @ self.covariance @ self.gradient
        scale = 1 / np.sqrt(np.maximum(np.diag(information), 1e-300))
        spread = (information - information @ self.covariance @ information) * np.outer(
            scale, scale
        )
        values, vectors = np.linalg.eigh(spread)
        kept = values > DETERMINED
        along = vectors.T @ (cancelled * scale)
        return float((along[kept] ** 2 / values[kept]).sum()), int(kept.sum())


def _without(fit: JointFit, whole: _Normal, say: Say, surprise: _Surprise) -> LeftOut | None:
    others = inverse_information(whole.information - say.information)
    if others is None:
        return None
    # a fit with Tukey's weights stands a little beside where its gradients cancel: what counts is
    # how far the place where they do moves
    twist = (whole.covariance @ whole.gradient - others @ (whole.gradient - say.gradient))[:6]
    stated = whole.covariance[:6, :6] * fit.misfit**2
    return LeftOut(
        -fit.camera_from_base.rotation.T @ twist[3:],
        twist[:3],
        float(np.sqrt(twist @ np.linalg.solve(stated, twist))),
        float(np.sqrt(np.trace(others[3:6, 3:6]))) * fit.misfit,
        surprise.agreement,
        surprise.chance,
        surprise.checks,
    )
