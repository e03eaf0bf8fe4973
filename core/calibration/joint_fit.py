# SPDX-License-Identifier: GPL-3.0-or-later
"""What a joint fit came to: the state it reached and what is left in, pose and errors out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..covariance import inverse_information
from ..errors import DegeneratePositions
from ..pose import Pose
from .asking import Asked
from .common_error import Say, common_of, marginalised
from .measured import Measured
from .observation import Observation, OutlineObservation, numbers_told
from .place_noise import own_pulls, place_sigma
from .unknowns import BIAS, Columns, Refined, State, Unknowns

# 1 sigma of the edge bias that the limb's model leaves: 0.05 px for matt rendered balls;
# but a polished ball mirrors what stands behind it at its limb, and looks 0.2 px too small
BIAS_SIGMA_PIXELS = 0.12


@dataclass(frozen=True, eq=False)
class JointFit:
    """The pose with its covariance (6, 6), the shared bias, and what each sighting is left with.

    - `disagreement`: how much more the sightings disagree than their own noise explains, as a
      factor on sigma; 1 when all is well
    - `chi_squared`: what they leave by their own noise, the prior included; best where it is least
    - `place_sigma`: by how many metres places would have to be off to explain that, 1 sigma; the
      covariance and what the sightings say already carry it
    - `misfit`: what is left even so, as a factor on sigma that the covariance is scaled by
    - `places_base` (S, 3): where each target is, in the frame that the pose is from; `offsets`
      (K, 3) are those solved for, with 1 sigma, by `targets`
    - `sighting_misfits` (S,): the same per sighting, over its degrees of freedom
    - `residuals_pixels`: for each sighting (N,), outwards, the bias taken off
    - `unknowns`: the P numbers solved for, the pose's twist first; `says` (S,): what each sighting
      says of them, before the misfit; `prior_information` (P, P): what was known beforehand. The
      covariance of all of them is `inverse(sum of informations + prior) * misfit**2`.
    - `refined`: by what factor refining changed radius and focal length
    - `own_says` (S,): the same as `says` were all places exact, to tell who disagrees
    - `asked`: what is not solved for, but would explain the residuals better
    """

    camera_from_base: Pose
    covariance: Array
    edge_bias_pixels: float
    edge_bias_sigma_pixels: float
    disagreement: float
    chi_squared: float
    place_sigma: float
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
    own_says: tuple[Say, ...]
    asked: Asked


@dataclass(frozen=True, eq=False)
class Stand:
    """Where a fit stands: its state, what each sighting leaves there, and what errors are allowed.

    - `grams` (S, 8, 8): products of each sighting's whitened columns, its residuals the last
    - `allowed` (S, 3, 3): by what shading and sampling may move each target's centre, unseen
    - `place_sigma`: by what the places may be off beside that, metres
    """

    observations: Sequence[Observation]
    measured: Measured
    unknowns: Unknowns
    state: State
    columns: Columns
    grams: Array
    allowed: Array
    place_sigma: float

    @staticmethod
    def at(
        state: State,
        observations: Sequence[Observation],
        measured: Measured,
        unknowns: Unknowns,
        weights: Array,
    ) -> Stand:
        """Raises nothing: a state that leaves the pose open is refused by `fit` and `improved`."""
        centres = state.camera_from_base.apply(unknowns.places_base(state))
        columns = measured.columns(centres, state)
        grams = grams_of(measured, columns, weights)
        allowed = _allowed(observations, measured, columns, centres)
        noise = place_sigma(grams, allowed, _across(observations, unknowns))
        return Stand(observations, measured, unknowns, state, columns, grams, allowed, noise)

    @property
    def disagreement(self) -> float:
        """By what factor the sightings disagree beyond their own noise (Birge's ratio)."""
        pulls = own_pulls(self.grams, self.allowed).sum()
        return float(np.sqrt(max(1.0, pulls / _freedom(self.observations, self.unknowns))))

    @property
    def chi_squared(self) -> float:
        """What is left by the sightings' own noise, and by the bias against its prior."""
        bias = self.state.edge_bias_pixels / BIAS_SIGMA_PIXELS
        return float(own_pulls(self.grams, self.allowed).sum()) + bias**2

    def improved(self) -> State:
        """The state after one step with the errors allowed. Raises DegeneratePositions."""
        says, count = self._says(self.place_sigma), self.unknowns.count
        gradient = sum((say.gradient for say in says), self._prior_gradient())
        covariance = self._covariance(says)
        return self.unknowns.moved(self.state, -covariance @ gradient[:count])

    def fit(self) -> JointFit:
        """All that is told of this state. Raises DegeneratePositions."""
        unknowns, state, count = self.unknowns, self.state, self.unknowns.count
        says, freedom = self._says(self.place_sigma), _freedom(self.observations, self.unknowns)
        covariance = self._covariance(says)
        misfit = float(np.sqrt(max(1.0, sum(say.pull for say in says) / freedom)))
        sigmas = np.sqrt(np.diag(covariance)) * misfit
        told = np.array([numbers_told(o) for o in self.observations])
        return JointFit(
            state.camera_from_base,
            covariance[:6, :6] * misfit**2,
            state.edge_bias_pixels,
            float(sigmas[BIAS]),
            self.disagreement,
            self.chi_squared,
            self.place_sigma,
            misfit,
            np.sqrt(own_pulls(self.grams, self.allowed) / told),
            tuple(self.columns.residual_pixels[rows] for rows in self.measured.rows),
            unknowns.names,
            _of_solved(says, count),
            _prior(count),
            unknowns.places_base(state),
            unknowns.targets,
            state.offsets,
            sigmas[BIAS + 1 : unknowns.after_offsets].reshape(-1, 3),
            unknowns.refinements(state, sigmas),
            _of_solved(self._says(0.0), count),
            self._asked(),
        )

    def _says(self, place_sigma: float) -> list[Say]:
        """What each sighting says of everything, solved for or only asked."""
        reduced, pulls = marginalised(self.grams, self.allowed + place_sigma**2 * np.eye(3))
        chain = self.unknowns.chain(self.state)
        turned = np.swapaxes(chain, 1, 2)
        informations = turned @ reduced[:, :-1, :-1] @ chain
        gradients = (turned @ reduced[:, :-1, -1:])[..., 0]
        return [
            Say(i, g, float(pull))
            for i, g, pull in zip(informations, gradients, pulls, strict=True)
        ]

    def _asked(self) -> Asked:
        says = self._says(0.0)
        return Asked(
            self.unknowns.asked,
            sum((say.information for say in says), _prior(len(says[0].gradient))),
            sum((say.gradient for say in says), self._prior_gradient()),
            self.grams,
            self.allowed,
            self.unknowns.chain(self.state),
            _freedom(self.observations, self.unknowns),
            _across(self.observations, self.unknowns),
        )

    def _prior_gradient(self) -> Array:
        prior = _prior(self.unknowns.count + len(self.unknowns.asked))
        return prior[BIAS] * self.state.edge_bias_pixels

    def _covariance(self, says: Sequence[Say]) -> Array:
        count = self.unknowns.count
        information = sum((say.information for say in says), _prior(len(says[0].gradient)))
        covariance = inverse_information(information[:count, :count])
        if covariance is None:
            raise DegeneratePositions(_undetermined(self.unknowns))
        return covariance


def _of_solved(says: Sequence[Say], count: int) -> tuple[Say, ...]:
    return tuple(Say(s.information[:count, :count], s.gradient[:count], s.pull) for s in says)


def grams_of(measured: Measured, columns: Columns, weights: Array) -> Array:
    """Products (S, 8, 8) of each sighting's whitened columns, its residuals the last of them."""
    stacked = np.column_stack([columns.by_centre, columns.shared, columns.residual_pixels])
    stacked *= (np.sqrt(weights) / measured.sigma_pixels)[:, None]
    return np.array([stacked[rows].T @ stacked[rows] for rows in measured.rows])


def _freedom(observations: Sequence[Observation], unknowns: Unknowns) -> int:
    """Three numbers a ball, two a point, less what is solved for; a bias only balls have."""
    told = [numbers_told(o) for o in observations]
    return max(1, sum(told) - unknowns.count + (max(told) < 3))


def _across(observations: Sequence[Observation], unknowns: Unknowns) -> int:
    """Across the lines of sight: two numbers a target; the bias is told by the balls' sizes."""
    return max(1, 2 * len(observations) - unknowns.count + 1)


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
