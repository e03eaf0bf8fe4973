# SPDX-License-Identifier: GPL-3.0-or-later
"""The outline that most profiles agree on: several edges a profile in, the ball's centre out.

A profile beside a gripper crosses two edges or three, and the strongest need not be the ball's.
Every profile therefore keeps its candidates; three of them make a ball, the ball that most others
agree with wins (RANSAC, Fischler & Bolles 1981), and reweighted least squares finish it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, Mask
from ..errors import SphereNotFound
from ..robust import beside_runs, middle_of, robust_sigma, tukey_weights
from .limb import LimbEdges

# an edge has to explain its profile this much better than no edge, in units of the noise
SIGNIFICANT_GAIN, FULL_GAIN = 25.0, 400.0
# what even a perfect edge is uncertain by: sampling, the model of the limb
FLOOR_PIXELS = 0.02
# edges this near to an outline agree with it; one as vague as the second number counts half
AGREEMENT_PIXELS, VAGUE_PIXELS = 0.3, 0.5
TRIALS = 150
STEPS = 8
LARGEST_SCALE = 4.0
FEWEST = 8


@dataclass(frozen=True, eq=False)
class WeighedEdges:
    """Candidates (3, N) with what each is worth.

    - `offsets_pixels`, and `sigma_pixels` of each for the noise that its own profile shows
    - `valid`: significant and within the picture; `weights`: from 0 to 1, by clearness
    - `spoilt`: how much more than it may an edge leaves unexplained, at least 1
    """

    offsets_pixels: Array
    sigma_pixels: Array
    valid: Mask
    weights: Array
    spoilt: Array


@dataclass(frozen=True, eq=False)
class Agreement:
    """One edge a profile (N,), the nearest to the outline found, and the outline's own move (3,).

    `scale` is how much more the edges scatter than their own sigmas say.
    """

    move: Array
    offsets_pixels: Array
    sigma_pixels: Array
    residual_pixels: Array
    weights: Array
    scale: float


@dataclass(frozen=True, eq=False)
class Expectation:
    """Where the centre should be: `move` (3,) from where it stands, with information (3, 3)."""

    move: Array
    information: Array

    def after(self, move: Array) -> Expectation:
        """The same from a centre that was moved."""
        return Expectation(self.move - move, self.information)

    def unlikely(self, moves: Array) -> Array:
        """Half the squared sigmas (T,) that moves (T, 3) are off."""
        off = moves - self.move
        half: Array = 0.5 * np.einsum("ti,ij,tj->t", off, self.information, off)
        return half


NOTHING_EXPECTED = Expectation(np.zeros(3), np.zeros((3, 3)))


@dataclass(frozen=True)
class Tolerance:
    """When edges still belong to an outline, and when its place has settled.

    `slack_pixels` is added to every sigma, `least_scale` the smallest scatter in sigmas that is
    believed, `settled` the step in metres that ends the iteration.
    """

    slack_pixels: float
    least_scale: float
    settled: float


def weighed(
    edges: LimbEdges, noise: float, freedom: float, inside: Mask, trust: float
) -> WeighedEdges:
    """Judge edges by the `noise` (variance of one sample) and by what each leaves unexplained.

    `trust` is the share of a profile's contrast that the limb's model may leave even where it is
    right, as before the sharpness is known. Raises SphereNotFound when too few stand out.
    """
    allowed = noise + trust * edges.flat_misfits / freedom
    spoilt = np.maximum(edges.misfits / freedom / allowed, 1.0)
    sigma = np.sqrt(2 * allowed * spoilt / edges.curvatures + FLOOR_PIXELS**2)
    gains = (edges.flat_misfits - edges.misfits) / noise
    valid = edges.standing & inside & (gains > SIGNIFICANT_GAIN)
    if valid.any(axis=0).sum() < FEWEST:
        raise SphereNotFound(
            f"only {int(valid.any(axis=0).sum())} of {len(inside)} places of the outline have an "
            "edge that stands out of the noise"
        )
    clear = np.maximum(gains, 0) / (np.maximum(gains, 0) + FULL_GAIN) / spoilt
    vague = 1 + (sigma / VAGUE_PIXELS) ** 2
    return WeighedEdges(
        edges.offsets_pixels, sigma, valid, np.where(valid, clear / vague, 0), spoilt
    )


def agreed_move(edges: WeighedEdges, by_centre: Array, expected: Expectation) -> Array:
    """The move (3,) of the centre that most profiles agree with; `by_centre` (N, 3) as Tangency's.

    The centre as it stands is among the hypotheses.
    """
    moves = _hypotheses(edges, by_centre)
    predicted = -(moves @ by_centre.T)
    within = (np.abs(predicted) < np.abs(edges.offsets_pixels).max() + 1).all(axis=1)
    within[0] = True
    moves, predicted = moves[within], predicted[within]
    best = np.zeros(predicted.shape)
    rows = zip(edges.offsets_pixels, edges.sigma_pixels, edges.weights, strict=True)
    for offsets, sigma, weights in rows:
        near = AGREEMENT_PIXELS**2 + (1.5 * np.minimum(sigma, VAGUE_PIXELS)) ** 2
        best = np.maximum(best, weights * np.maximum(0, 1 - (offsets - predicted) ** 2 / near))
    winner: Array = moves[int(np.argmax(best.sum(axis=1) - expected.unlikely(moves)))]
    return winner


def settled(
    edges: WeighedEdges,
    by_centre: Array,
    start: Array,
    tolerance: Tolerance,
    expected: Expectation,
) -> Agreement:
    """Reweighted least squares from the move `start` (3,), each profile by its nearest edge.

    Raises SphereNotFound when too few edges are left.
    """
    move, n = start, np.arange(len(by_centre))
    for _ in range(STEPS):
        predicted = -(by_centre @ move)
        off = np.where(edges.valid, np.abs(edges.offsets_pixels - predicted), np.inf)
        nearest = np.argmin(off / edges.sigma_pixels, axis=0)
        offsets = edges.offsets_pixels[nearest, n]
        sigma = np.hypot(edges.sigma_pixels[nearest, n], tolerance.slack_pixels)
        residual = offsets - predicted
        valid = edges.valid[nearest, n]
        scale = _scale(residual[valid] / sigma[valid], tolerance.least_scale)
        weights = tukey_weights(residual / sigma, scale) * valid
        weights = weights * ~beside_runs(weights == 0)
        if (weights > 0).sum() < FEWEST:
            raise SphereNotFound("the edges around the guess form no outline of a ball")
        root = np.sqrt(weights) / sigma
        rows = by_centre * root[:, None]
        normal = rows.T @ rows + expected.information
        towards = expected.information @ (expected.move - move) - rows.T @ (residual * root)
        step = np.linalg.lstsq(normal, towards, rcond=1e-12)[0]
        move = move + step
        if np.linalg.norm(step) < tolerance.settled:
            break
    residual = offsets + by_centre @ move
    return Agreement(move, offsets, sigma, residual, weights, scale)


def _scale(scaled: Array, least: float) -> float:
    return float(np.clip(robust_sigma(scaled), least, max(LARGEST_SCALE, least)))


def _hypotheses(edges: WeighedEdges, by_centre: Array) -> Array:
    """Moves (T, 3) of the centre through three edges each, and none at all first."""
    rank, profile = np.nonzero(edges.valid)
    share = np.cumsum(edges.weights[rank, profile])
    drawn = np.random.default_rng(0).random((TRIALS, 3)) * share[-1]
    triples = np.searchsorted(share[:-1], drawn)
    rows, offsets = -by_centre[profile[triples]], edges.offsets_pixels[rank, profile][triples]
    volume = np.abs(np.linalg.det(rows))
    # three neighbours say little of the whole; the middle hypothesis is clear enough
    clear = volume > 0.1 * middle_of(volume)
    clear &= volume > 0
    moves = np.linalg.solve(rows[clear], offsets[clear][..., None])[..., 0]
    return np.concatenate([np.zeros((1, 3)), moves])
