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
from functools import partial

import numpy as np

from ..arrays import Array
from ..least_squares import levenberg_marquardt
from ..pose import Pose
from ..robust import robust_sigma, tukey_weights
from .joint_fit import BIAS_SIGMA_PIXELS, JointFit, Stand, grams_of
from .measured import Measured
from .observation import Observation
from .unknowns import BIAS, Columns, Refinable, State, Unknowns

REWEIGHTINGS, REBALANCINGS = 3, 3
# an outline that keeps less than this share of its weight is in another place
MOST_LOST = 0.5
# below this factor outlines that are worse than they state make sightings disagree as well as
# places do, and their own weights are the better ones; found on pictures with noise and fingers
WORTH_REBALANCING = 2.5
# and above this one something is wrong that no robot's error is
LOST = 30.0

__all__ = ["BIAS_SIGMA_PIXELS", "JointFit", "fit_pose"]


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
    weights = own = np.ones(len(measured.sigma_pixels))
    for _ in range(REWEIGHTINGS):
        evaluate = partial(_whitened, measured=measured, unknowns=unknowns, weights=weights)
        state = levenberg_marquardt(state, evaluate, unknowns.moved).value
        columns = _columns(measured, unknowns, state)
        weights, own = _weights(measured, columns, weights)
    # against the common pose a displaced outline would lose what shows that it is displaced
    stand = Stand.at(state, observations, measured, unknowns, own)
    for _ in range(REBALANCINGS):
        if not WORTH_REBALANCING < stand.disagreement < LOST:
            break
        # places that are off count alike, however sharp their outlines are
        stand = Stand.at(stand.improved(), observations, measured, unknowns, own)
    return stand.fit()


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


def _weights(measured: Measured, columns: Columns, weights: Array) -> tuple[Array, Array]:
    """Tukey's weights of each outline's points against the pose that all agree on, and its own.

    What hides a part of a ball pulls the edges beside it, which the others tell. But an outline
    that loses most of its weight that way is of a ball in a wrong place: it is weighed against
    itself, or else it would be voted down point by point and nobody told.
    """
    count = len(measured.radii)
    if not count:
        return weights, weights
    scaled = (columns.residual_pixels / measured.sigma_pixels)[:count]
    moves = _own_moves(measured, columns, weights)
    by_move = np.einsum("ni,ni->n", columns.by_centre[:count], moves[measured.owner[:count]])
    own = _tukey(scaled - by_move / measured.sigma_pixels[:count])
    agreed = _tukey(scaled)
    left, kept = (
        np.bincount(measured.owner[:count], w, minlength=len(measured.rows)) for w in (agreed, own)
    )
    displaced = (left < MOST_LOST * kept)[measured.owner[:count]]
    points = weights[count:]
    together = np.concatenate([np.where(displaced, own, agreed), points])
    return together, np.concatenate([own, points])


def _own_moves(measured: Measured, columns: Columns, weights: Array) -> Array:
    """Where each sighting alone would have its target, (S, 3) from where it is expected."""
    grams = grams_of(measured, columns, weights)
    return np.array([np.linalg.lstsq(g[:3, :3], g[:3, -1], rcond=1e-12)[0] for g in grams])


def _tukey(scaled: Array) -> Array:
    return tukey_weights(scaled, max(1.0, robust_sigma(scaled)))
