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

from .arrays import Array
from .covariance import inverse_information
from .errors import DegeneratePositions
from .least_squares import levenberg_marquardt
from .pose import Pose, point_jacobian
from .robust import robust_sigma, tukey_weights
from .sphere import OutlineRays, Tangency, tangency

# 1 sigma of the edge bias that the limb's model leaves, measured on rendered balls
BIAS_SIGMA_PIXELS = 0.05
REWEIGHTINGS = 4
# what shifts and swells a whole outline without showing in its residuals (shading, sampling): this
# many square pixels over the ball's radius, within bounds; found on synthetic balls of 9 to 100 px
COMMON_ERROR, LEAST_COMMON, MOST_COMMON = 0.35, 0.006, 0.05


@dataclass(frozen=True, eq=False)
class OutlineObservation:
    """Outline points (N,) of a ball at `centre_world` (3,), their sigmas (N,), used or not."""

    outline: OutlineRays
    sigma_pixels: Array
    centre_world: Array
    radius: float


@dataclass(frozen=True, eq=False)
class JointFit:
    """The pose with its covariance (6, 6), the shared bias, and what each outline is left with.

    - `misfit`: how much more the outlines disagree than their own noise explains, as a factor on
      sigma; 1 when all is well. The covariance is already scaled by it.
    - `sighting_misfits` (S,): the same per sighting, over its three degrees of freedom
    - `residuals_pixels`: for each sighting (N,), outwards, the bias taken off
    """

    camera_from_world: Pose
    covariance: Array
    edge_bias_pixels: float
    edge_bias_sigma_pixels: float
    misfit: float
    sighting_misfits: Array
    residuals_pixels: tuple[Array, ...]


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
    information = np.zeros((7, 7))
    information[6, 6] = 1 / BIAS_SIGMA_PIXELS**2
    pulls = []
    for o, t, r, w in zip(observations, held, left, weights, strict=True):
        told, pull = _told_by(o, t, r, w, state.pose)
        information += told
        pulls.append(pull)
    covariance = inverse_information(information)
    if covariance is None:
        raise DegeneratePositions(
            "the outlines leave a direction of the pose undetermined; add a ball position away "
            "from the line through the others"
        )
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
    )


def _told_by(
    observation: OutlineObservation, held: Tangency, left: Array, weights: Array, pose: Pose
) -> tuple[Array, float]:
    """What one ball tells of pose and bias (7, 7), its common error allowed for, and its pull.

    The common error moves the ball's centre by a small random amount; it is marginalised. The pull
    is the chi-squared of where this ball alone would rather be, three degrees of freedom.
    """
    root = np.sqrt(weights) / observation.sigma_pixels
    rows = _rows(observation, held, pose) * root[:, None]
    by_centre = held.by_centre * root[:, None]
    allowed = _common_covariance(observation, held, pose)
    of_centre = by_centre.T @ by_centre
    mixed = by_centre.T @ rows
    swallowed = np.linalg.inv(of_centre + np.linalg.inv(allowed))
    rather = np.linalg.lstsq(of_centre, by_centre.T @ (left * root), rcond=None)[0]
    spread = np.linalg.pinv(of_centre) + allowed
    return rows.T @ rows - mixed.T @ swallowed @ mixed, float(
        rather @ np.linalg.solve(spread, rather)
    )


def _common_covariance(observation: OutlineObservation, held: Tangency, pose: Pose) -> Array:
    """Of the ball's centre (3, 3), metres: across the line of sight, and in depth by its size."""
    centre = pose.apply(observation.centre_world)
    distance = float(np.linalg.norm(centre))
    axis = centre / distance
    across = np.linalg.norm(held.by_centre - np.outer(held.by_centre @ axis, axis), axis=1)
    pixels_per_metre = float(np.median(across))
    radius_pixels = pixels_per_metre * observation.radius
    sigma = float(np.clip(COMMON_ERROR / radius_pixels, LEAST_COMMON, MOST_COMMON))
    aside, deep = sigma / pixels_per_metre, sigma / radius_pixels * distance
    along = np.outer(axis, axis)
    covariance: Array = aside**2 * (np.eye(3) - along) + deep**2 * along
    return covariance
