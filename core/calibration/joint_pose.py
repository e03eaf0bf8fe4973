# SPDX-License-Identifier: GPL-3.0-or-later
"""The pose that all outlines agree on: measured outlines of balls at known places in, pose out.

One least-squares problem over every outline point of every sighting, instead of one centre a ball:
a single ball tells its depth badly and its direction well, and the joint fit uses each as it
deserves. One edge bias in pixels is shared by all outlines: what the limb model leaves is small and
about the same everywhere, so the bias has a prior: where the data can tell it they do, where they
can't its uncertainty goes into the pose.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from ..arrays import Array
from ..ball.sphere import OutlineRays, Tangency, tangency
from ..covariance import inverse_information
from ..errors import DegeneratePositions
from ..least_squares import levenberg_marquardt
from ..pose import Pose, point_jacobian
from ..robust import robust_sigma, tukey_weights
from .common_error import Say, common_covariance, say_of

# 1 sigma of the edge bias that the limb's model leaves, measured on rendered balls
BIAS_SIGMA_PIXELS = 0.05
REWEIGHTINGS = 4
TWIST = ("rotation x", "rotation y", "rotation z", "x", "y", "z")
UNKNOWNS = (*TWIST, "edge bias")


@dataclass(frozen=True, eq=False)
class OutlineObservation:
    """Outline points (N,) of a ball at `centre_world` (3,), with their sigmas (N,).

    `principal_point` (2,) in pixels is that of the lens; without it the focal length is not asked.
    """

    outline: OutlineRays
    sigma_pixels: Array
    centre_world: Array
    radius: float
    principal_point: Array | None = None


@dataclass(frozen=True, eq=False)
class JointFit:
    """The pose with its covariance (6, 6), the shared bias, and what each outline is left with.

    - `misfit`: how much more the outlines disagree than their own noise explains, as a factor on
      sigma; 1 when all is well. The covariance is already scaled by it.
    - `sighting_misfits` (S,): the same per sighting, over its three degrees of freedom
    - `residuals_pixels`: for each sighting (N,), outwards, the bias taken off
    - `unknowns`: the P numbers solved for, the pose's twist first; `says` (S,): what each outline
      says of them, before the misfit; `prior_information` (P, P): what was known beforehand. The
      covariance of all of them is `inverse(sum of informations + prior) * misfit**2`.
    - `focal_error`: by what share the true focal lengths seem longer than given, with its sigma;
      it is not solved for, only asked
    """

    camera_from_world: Pose
    covariance: Array
    edge_bias_pixels: float
    edge_bias_sigma_pixels: float
    misfit: float
    sighting_misfits: Array
    residuals_pixels: tuple[Array, ...]
    unknowns: tuple[str, ...]
    says: tuple[Say, ...]
    prior_information: Array
    focal_error: float
    focal_error_sigma: float


@dataclass(frozen=True, eq=False)
class _State:
    pose: Pose
    bias: float

    def moved(self, step: Array) -> _State:
        return _State(self.pose.perturbed(step[:6]), self.bias + float(step[6]))


def fit_pose(observations: Sequence[OutlineObservation], start: Pose) -> JointFit:
    """The maximum-likelihood pose of the outlines, with Tukey's weights against stray points.

    Raises DegeneratePositions when the outlines leave a direction of the pose undetermined.
    """
    state = _State(start, 0.0)
    weights = [np.ones(len(o.sigma_pixels)) for o in observations]
    for _ in range(REWEIGHTINGS):
        evaluate = partial(_whitened, observations=observations, weights=tuple(weights))
        state = levenberg_marquardt(state, evaluate, _State.moved).value
        held = [_held(o, state.pose) for o in observations]
        left = [t.residual_pixels - state.bias for t in held]
        scaled = [r / o.sigma_pixels for r, o in zip(left, observations, strict=True)]
        weights = [tukey_weights(s, max(1.0, robust_sigma(s))) for s in scaled]
    return _with_errors(state, observations, held, left, weights)


def _held(observation: OutlineObservation, pose: Pose) -> Tangency:
    centre = pose.apply(observation.centre_world)
    return tangency(observation.outline, centre, observation.radius)


def _rows(observation: OutlineObservation, held: Tangency, pose: Pose) -> Array:
    """Derivatives (N, 7) of the residuals by twist and bias."""
    by_twist = held.by_centre @ point_jacobian(pose.apply(observation.centre_world))
    return np.hstack([by_twist, -np.ones((len(by_twist), 1))])


def _whitened(
    state: _State, observations: Sequence[OutlineObservation], weights: Sequence[Array]
) -> tuple[Array, Array]:
    residuals = [np.array([state.bias / BIAS_SIGMA_PIXELS])]
    rows = [np.array([[0, 0, 0, 0, 0, 0, 1 / BIAS_SIGMA_PIXELS]])]
    for observation, weight in zip(observations, weights, strict=True):
        held = _held(observation, state.pose)
        root = np.sqrt(weight) / observation.sigma_pixels
        residuals.append((held.residual_pixels - state.bias) * root)
        rows.append(_rows(observation, held, state.pose) * root[:, None])
    return np.concatenate(residuals), np.concatenate(rows)


def _with_errors(
    state: _State,
    observations: Sequence[OutlineObservation],
    held: Sequence[Tangency],
    left: Sequence[Array],
    weights: Sequence[Array],
) -> JointFit:
    # the eighth unknown is the focal length: it is not solved for, but asked whether it fits
    information, gradient, says = np.zeros((8, 8)), np.zeros(8), []
    information[6, 6] = 1 / BIAS_SIGMA_PIXELS**2
    gradient[6] = state.bias / BIAS_SIGMA_PIXELS**2
    prior = information[:7, :7].copy()
    for o, t, r, w in zip(observations, held, left, weights, strict=True):
        rows = np.column_stack([_rows(o, t, state.pose), _by_log_focal(o, t)])
        centre = state.pose.apply(o.centre_world)
        allowed = common_covariance(t, centre, o.radius)
        say = say_of(t, rows, r, np.sqrt(w) / o.sigma_pixels, allowed)
        information, gradient = information + say.information, gradient + say.gradient
        says.append(Say(say.information[:7, :7], say.gradient[:7], say.pull))
    covariance = inverse_information(information[:7, :7])
    if covariance is None:
        raise DegeneratePositions(
            "the outlines leave a direction of the pose undetermined; add a ball position away "
            "from the line through the others"
        )
    pulls = [say.pull for say in says]
    freedom = max(1, 3 * len(observations) - 7)
    # Birge's ratio: three numbers a ball, seven solved for; it may only widen what is stated
    misfit = float(np.sqrt(max(1.0, sum(pulls) / freedom)))
    return JointFit(
        state.pose,
        covariance[:6, :6] * misfit**2,
        state.bias,
        float(np.sqrt(covariance[6, 6])) * misfit,
        misfit,
        np.sqrt(np.array(pulls) / 3),
        tuple(left),
        UNKNOWNS,
        tuple(says),
        prior,
        *_focal_error(information, gradient, sum(pulls), freedom),
    )


def _by_log_focal(observation: OutlineObservation, held: Tangency) -> Array:
    """Derivative (N,) of the residuals by the logarithm of both focal lengths.

    A longer lens shows what it sees farther out: against it every pixel lies nearer the middle.
    """
    if observation.principal_point is None:
        return np.zeros(len(held.normals))
    from_middle = observation.outline.pixels - observation.principal_point
    by_log: Array = -np.einsum("ni,ni->n", held.normals, from_middle)
    return by_log


def _focal_error(
    information: Array, gradient: Array, pull: float, freedom: int
) -> tuple[float, float]:
    """By what share the focal length seems off, and its sigma; NaN where it can't be told."""
    covariance = inverse_information(information)
    if covariance is None or freedom < 2:
        return float("nan"), float("nan")
    step = -covariance @ gradient
    explained = float(step @ information @ step)
    left = max(1.0, (pull - explained) / (freedom - 1))
    return float(step[7]), float(np.sqrt(covariance[7, 7] * left))
