# SPDX-License-Identifier: GPL-3.0-or-later
"""A solid within a few pixels of its edges in, the solid on them out, with what supports it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, Mask
from ..camera import Camera
from ..modelling.solid import Solid
from ..robust import tukey_weights
from ..rotation import vector_from_rotation
from .curve_samples import curve_samples
from .draws import normals
from .freedom import Freedom
from .stations import Look, Pass, Stations, find_stations, unhidden

PASSES = (
    Pass(5.0, 3.0, 4, 0.25, (1.0, 0.7), False),
    Pass(5.0, 2.5, 6, 0.12, (0.7, 0.5), False),
    Pass(4.0, 1.25, 8, 0.06, (0.6, 0.4), True),
    Pass(4.0, 1.25, 8, 0.03, (0.4, 0.25), True),
)
RIVALS = Pass(5.0, 3.5, 5, 0.3, (), False)
RIVALS_DRAWN, RIVALS_KEPT, RIVAL_ROUNDS, RIVAL_PIXELS = 600, 8, 4, 0.6
DRAWN, ELITE, ROUNDS = 160, 16, 6
# how far off the rough solid may be, in units of the prior
ROUGH = 0.3
# beside a clearer edge of its station, one that explains less than this is none
LEAST_SHARE = 0.12
# what one unit of the prior is in pixels; how near an edge has to be, round by round
UNIT_PIXELS, NARROWING, NEAREST_PIXELS = 5.0, 0.7, 0.3
# a rival with more than this many times the votes is told as having so many
MOST_SHARE = 10.0
# an edge this near to the outline supports it
SUPPORTING_PIXELS = 0.5


@dataclass(frozen=True, eq=False)
class EdgeFit:
    """A solid on its edges; over the stations (S,): `residual` (NaN without an edge), `weight`.

    `jacobian` (S, F) is by `motions` (6 + P, F), of one sigma of the prior each. `stands` tells
    whether its base meets something.
    """

    solid: Solid
    motions: Array
    names: tuple[str, ...]
    stations: Stations
    residual: Array
    sigma: Array
    weight: Array
    jacobian: Array
    stands: bool

    def tangent_to(self, solid: Solid) -> Array:
        """The motion (6 + P,) from this solid to another."""
        return tangent(self.solid, solid)

    @property
    def supported(self) -> Mask:
        """Which stations have an edge where the solid's is."""
        near: Mask = np.abs(np.nan_to_num(self.residual, nan=9.0)) < SUPPORTING_PIXELS
        return near


def refine(
    solid: Solid, freedom: Freedom, motions: Array, camera: Camera, look: Look
) -> EdgeFit | None:
    """Fit over `motions` (6 + P, F), of one sigma of the prior each.

    None where too little of an edge is left to look at, or the fit leaves the possible.
    """
    fit, total, first = None, np.zeros(motions.shape[1]), motions
    for stage in PASSES:
        motions = freedom.basis_like(solid, first)
        samples = unhidden(curve_samples(solid, camera), look.hidden)
        if len(samples) < 2 * motions.shape[1]:
            return fit
        stations = find_stations(samples, look, stage)
        jacobian = stations.by_object @ motions
        state, choice, weight = _settled(stations, jacobian, stage, total)
        total = total + state
        moved = solid.moved(motions @ state)
        if not freedom.possible(moved.parameters):
            return None
        solid = freedom.kept(moved)
        n = np.arange(len(choice))
        found = stations.standing[choice, n] & (stations.share[choice, n] > LEAST_SHARE)
        residual = np.where(found, jacobian @ state - stations.offsets[choice, n], np.nan)
        sigma = stations.sigma[choice, n]
        fit = EdgeFit(
            solid, motions, samples.names, stations, residual, sigma, weight, jacobian, look.stands
        )
    return fit


def rivalry(fit: EdgeFit, camera: Camera, look: Look) -> float:
    """How many votes the best state elsewhere has, as a share of those where the solid is.

    Elsewhere is where the edges are RIVAL_PIXELS off or more, rms, and within reach of the search.
    """
    samples = unhidden(curve_samples(fit.solid, camera), look.hidden)
    if len(samples) < 4:
        return 1.0
    stations = find_stations(samples, look, RIVALS)
    jacobian = stations.by_object @ fit.motions
    own = stations.votes(np.zeros((1, len(jacobian))), NEAREST_PIXELS)[0]
    count = jacobian.shape[1]
    # of many drawn at all distances the best are looked at more closely
    best = normals(RIVALS_DRAWN, count, RIVALS_DRAWN) * RIVALS.spread
    best = best[np.argsort(-_votes_elsewhere(stations, best @ jacobian.T, 1.0))[:RIVALS_KEPT]]
    for number in range(RIVAL_ROUNDS):
        near = normals(DRAWN // 2, count, number) * 0.25 * RIVALS.spread * NARROWING**number
        tried = np.concatenate([best, (best[:, None] + near).reshape(-1, count)])
        wide = NEAREST_PIXELS + 0.4 * NARROWING**number
        votes = _votes_elsewhere(stations, tried @ jacobian.T, wide)
        best = tried[np.argsort(-votes)[:RIVALS_KEPT]]
    rival = float(_votes_elsewhere(stations, best @ jacobian.T, NEAREST_PIXELS).max())
    return min(max(rival, 0.0) / max(float(own), 1e-9), MOST_SHARE)


def tangent(start: Solid, end: Solid) -> Array:
    """The motion (6 + P,) that takes one solid to another of its kind."""
    turn = vector_from_rotation(end.rotation @ start.rotation.T)
    return np.concatenate([turn, end.place - start.place, end.parameters - start.parameters])


def _votes_elsewhere(stations: Stations, moves: Array, near: float) -> Array:
    """Votes (T,) for moves (T, S), below zero for those that are no other place."""
    elsewhere = np.sqrt((moves**2).mean(axis=1)) > RIVAL_PIXELS
    return np.where(elsewhere, stations.votes(moves, near), -1.0)


def _settled(
    stations: Stations, jacobian: Array, stage: Pass, total: Array
) -> tuple[Array, NDArray[np.intp], Array]:
    """The state (F,) most stations agree on, the candidate (S,) of each, and weights (S,)."""
    n, count = np.arange(len(jacobian)), jacobian.shape[1]
    state = _agreed(stations, jacobian, stage.spread, total)
    choice, weight = np.zeros(len(n), dtype=np.intp), np.zeros(len(n))
    for scale in np.repeat(stage.scales, 2):
        off = np.where(stations.standing, np.abs(jacobian @ state - stations.offsets), 1e3)
        off = np.where(stations.share > LEAST_SHARE, off, 1e3)
        choice = off.argmin(axis=0)
        sigma = stations.sigma[choice, n]
        weight = tukey_weights(off[choice, n] / np.hypot(scale, 2 * sigma), 0.45)
        over = (
            weight * stations.worth * stations.parted[choice, n] / (sigma**2 + (0.25 * scale) ** 2)
        )
        normal = (jacobian * over[:, None]).T @ jacobian + np.eye(count) / ROUGH**2
        gradient = jacobian.T @ (over * stations.offsets[choice, n]) - total / ROUGH**2
        state = np.linalg.solve(normal, gradient)
    return state, choice, weight


def _agreed(stations: Stations, jacobian: Array, spread: float, total: Array) -> Array:
    """The state (F,) that most edges vote for: drawn, and drawn closer."""
    count = jacobian.shape[1]
    mean, root = np.zeros(count), spread * np.eye(count)
    best = mean
    for number in range(ROUNDS):
        states = mean + normals(DRAWN, count, number) @ root.T
        states[0] = mean
        near = spread * UNIT_PIXELS * NARROWING**number + NEAREST_PIXELS
        votes = stations.votes(states @ jacobian.T, near)
        votes -= 0.5 * np.square((total + states) / ROUGH).sum(axis=1)
        order = np.argsort(-votes)[:ELITE]
        best = states[order[0]]
        chosen = states[order]
        mean = chosen.mean(axis=0)
        covariance = np.cov(chosen.T).reshape(count, count) * 1.5
        root = np.linalg.cholesky(covariance + np.eye(count) * (0.02 * spread) ** 2)
    return best
