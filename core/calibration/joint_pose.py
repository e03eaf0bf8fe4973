# SPDX-License-Identifier: GPL-3.0-or-later
"""The pose that all sightings agree on: measured outlines and points in, pose and errors out.

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
from ..covariance import inverse_information
from ..errors import DegeneratePositions
from ..least_squares import levenberg_marquardt
from ..pose import Pose
from ..robust import robust_sigma, tukey_weights
from .asking import Asked
from .common_error import Say, common_of, marginalised
from .measured import Measured
from .observation import Observation, OutlineObservation, numbers_told
from .unknowns import BIAS, Columns, Refinable, Refined, State, Unknowns

# 1 sigma of the edge bias that the limb's model leaves, measured on rendered balls
BIAS_SIGMA_PIXELS = 0.05
REWEIGHTINGS = 3


@dataclass(frozen=True, eq=False)
class JointFit:
    """The pose with its covariance (6, 6), the shared bias, and what each sighting is left with.

    - `misfit`: how much more the sightings disagree than their own noise explains, as a factor on
      sigma; 1 when all is well. The covariance is already scaled by it.
    - `places_base` (S, 3): where each target is, in the frame that the pose is from; `offsets`
      (K, 3) are those solved for, with 1 sigma, by `targets`
    - `sighting_misfits` (S,): the same per sighting, over its degrees of freedom
    - `residuals_pixels`: for each sighting (N,), outwards, the bias taken off
    - `unknowns`: the P numbers solved for, the pose's twist first; `says` (S,): what each sighting
      says of them, before the misfit; `prior_information` (P, P): what was known beforehand. The
      covariance of all of them is `inverse(sum of informations + prior) * misfit**2`.
    - `refined`: by what factor refining changed radius and focal length
    - `asked`: what is not solved for, but would explain the residuals better
    """

    camera_from_base: Pose
    covariance: Array
    edge_bias_pixels: float
    edge_bias_sigma_pixels: float
    misfit: float
    sighting_misfits: Array
    residuals_pixels: tuple[Array, ...]
    unknowns: tuple[str, ...]
    says: tuple[Say, ...]
    prior_information: Array
    places_base: Array
    targets: tuple[str, ...]
    offsets: Array
    offset_sigmas: Array
    refined: tuple[Refined, ...]
    asked: Asked


def fit_pose(
    observations: Sequence[Observation],
    start: Pose,
    offsets: Array | None = None,
    refine: Sequence[Refinable] = (),
) -> JointFit:
    """The maximum-likelihood pose, with Tukey's weights against stray points of an outline.

    `offsets` (K, 3) is where to start those of unknown targets, in the order in which they come.

    Raises DegeneratePositions when the sightings leave a direction of the pose undetermined.
    """
    measured = Measured.of(observations)
    unknowns = Unknowns.of_places([o.place for o in observations], refine)
    state = State(start, np.zeros((0, 3)) if offsets is None else np.asarray(offsets, dtype=float))
    weights = np.ones(len(measured.sigma_pixels))
    for _ in range(REWEIGHTINGS):
        evaluate = partial(_whitened, measured=measured, unknowns=unknowns, weights=weights)
        state = levenberg_marquardt(state, evaluate, unknowns.moved).value
        columns = _columns(measured, unknowns, state)
        weights = _weights(measured, columns, weights)
    return _with_errors(observations, measured, unknowns, state, columns, weights)


def _columns(measured: Measured, unknowns: Unknowns, state: State) -> Columns:
    return measured.columns(state.camera_from_base.apply(unknowns.places_base(state)), state)


def _whitened(
    state: State, measured: Measured, unknowns: Unknowns, weights: Array
) -> tuple[Array, Array]:
    columns = _columns(measured, unknowns, state)
    root = np.sqrt(weights) / measured.sigma_pixels
    rows = unknowns.rows(columns, measured.owner, state) * root[:, None]
    prior = np.zeros((1, rows.shape[1]))
    prior[0, BIAS] = 1 / BIAS_SIGMA_PIXELS
    residuals = np.append(columns.residual_pixels * root, state.edge_bias_pixels * prior[0, BIAS])
    return residuals, np.vstack([rows, prior])


def _grams(measured: Measured, columns: Columns, weights: Array) -> Array:
    """Products (S, 8, 8) of each sighting's whitened columns, its residuals the last of them."""
    stacked = np.column_stack([columns.by_centre, columns.shared, columns.residual_pixels])
    stacked *= (np.sqrt(weights) / measured.sigma_pixels)[:, None]
    return np.array([stacked[rows].T @ stacked[rows] for rows in measured.rows])


def _weights(measured: Measured, columns: Columns, weights: Array) -> Array:
    """Tukey's weights of each outline against itself, wherever the others would have it.

    Else a ball in a wrong place would be voted down point by point, and nobody told.
    """
    grams = _grams(measured, columns, weights)
    moves = np.array([np.linalg.lstsq(g[:3, :3], g[:3, -1], rcond=1e-12)[0] for g in grams])
    own = columns.residual_pixels - np.einsum("ni,ni->n", columns.by_centre, moves[measured.owner])
    scaled = own / measured.sigma_pixels
    count = len(measured.radii)
    if not count:
        return weights
    outlines = tukey_weights(scaled[:count], max(1.0, robust_sigma(scaled[:count])))
    return np.concatenate([outlines, np.ones(len(scaled) - count)])


def _with_errors(
    observations: Sequence[Observation],
    measured: Measured,
    unknowns: Unknowns,
    state: State,
    columns: Columns,
    weights: Array,
) -> JointFit:
    centres = state.camera_from_base.apply(unknowns.places_base(state))
    allowed = _allowed(observations, measured, columns, centres)
    reduced, pulls = marginalised(_grams(measured, columns, weights), allowed)
    says = _says(reduced, pulls, unknowns.chain(state))
    asked = _asked(says, unknowns, state, sum(numbers_told(o) for o in observations))
    count = unknowns.count
    covariance = inverse_information(asked.information[:count, :count])
    if covariance is None:
        raise DegeneratePositions(_undetermined(unknowns))
    # Birge's ratio: three numbers a ball, two a point; it may only widen what is stated
    misfit = float(np.sqrt(max(1.0, pulls.sum() / asked.freedom)))
    sigmas = np.sqrt(np.diag(covariance)) * misfit
    return JointFit(
        state.camera_from_base,
        covariance[:6, :6] * misfit**2,
        state.edge_bias_pixels,
        float(sigmas[BIAS]),
        misfit,
        np.sqrt(pulls / [numbers_told(o) for o in observations]),
        tuple(columns.residual_pixels[rows] for rows in measured.rows),
        unknowns.names,
        tuple(Say(s.information[:count, :count], s.gradient[:count], s.pull) for s in says),
        _prior(count),
        unknowns.places_base(state),
        unknowns.targets,
        state.offsets,
        sigmas[BIAS + 1 : unknowns.after_offsets].reshape(-1, 3),
        unknowns.refinements(state, sigmas),
        asked,
    )


def _says(reduced: Array, pulls: Array, chain: Array) -> list[Say]:
    """What each sighting says of everything, solved for or only asked."""
    turned = np.swapaxes(chain, 1, 2)
    informations = turned @ reduced[:, :-1, :-1] @ chain
    gradients = (turned @ reduced[:, :-1, -1:])[..., 0]
    return [Say(i, g, float(p)) for i, g, p in zip(informations, gradients, pulls, strict=True)]


def _asked(says: Sequence[Say], unknowns: Unknowns, state: State, told: int) -> Asked:
    prior = _prior(len(says[0].gradient))
    gradient = prior[BIAS] * state.edge_bias_pixels
    return Asked(
        unknowns.asked,
        sum((say.information for say in says), prior),
        sum((say.gradient for say in says), gradient),
        sum(say.pull for say in says) + state.edge_bias_pixels * float(gradient[BIAS]),
        max(1, told - unknowns.count),
    )


def _prior(count: int) -> Array:
    prior = np.zeros((count, count))
    prior[BIAS, BIAS] = 1 / BIAS_SIGMA_PIXELS**2
    return prior


def _allowed(
    observations: Sequence[Observation], measured: Measured, columns: Columns, centres: Array
) -> Array:
    """What shading and sampling move each ball's centre by, unseen (S, 3, 3); points by nothing."""
    return np.array(
        [
            common_of(columns.by_centre[rows], centre, o.radius)
            if isinstance(o, OutlineObservation)
            else np.zeros((3, 3))
            for o, rows, centre in zip(observations, measured.rows, centres, strict=True)
        ]
    )


def _undetermined(unknowns: Unknowns) -> str:
    if unknowns.targets:
        return (
            "the sightings leave a direction of the pose or of the unknown offset undetermined; "
            "turn the flange about two axes between sightings, and add sightings"
        )
    return (
        "the outlines leave a direction of the pose undetermined; add a ball position away "
        "from the line through the others"
    )
