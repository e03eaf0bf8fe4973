# SPDX-License-Identifier: GPL-3.0-or-later
"""A window's colours and where things may be in, how much each pixel speaks for one thing out.

Histograms of the object, of its neighbours and of the rest start from where each may be and are
learnt from the picture itself in a few rounds of expectation and maximisation, as in trackers that
go by regions (Prisacariu & Reid 2012). What may be no more than the ground in shadow speaks for
nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..picture.pictures import Picture

BINS = 12
# how many sigmas of the window's colours the bins span
SPAN = 2.2
# blur of a histogram in bins, and the share of evenly spread colours mixed in
BIN_BLUR, EVEN = 0.8, 0.02
ROUNDS = 3
# what one pixel may say at most, in natural units of log likelihood
LOUDEST = 2.5
# the grain of eight-bit colours: what varies less is noise
LEAST_SPREAD = 2.0
# ground is taken from where the object is with less than this probability
GROUND = 0.15
# light in shadow, as parts of the ground's; how far off the grey line it may be, in its spreads
DARKEST, BRIGHTEST, OFF_LINE = 0.12, 0.93, 2.5


@dataclass(frozen=True, eq=False)
class Colors:
    """A window's colours: the histogram cell of each pixel (N,), and its linear light (N, 3)."""

    cells: NDArray[np.intp]
    light: Array

    @staticmethod
    def of(encoded: Picture, light: Picture) -> Colors:
        """Of colours (rows, columns, 3), encoded from 0 to 255 and as amounts of light.

        Along its own principal axes a window of weak colours is told apart as finely as a loud one.
        """
        flat = encoded.reshape(-1, 3).astype(np.float32)
        centred = flat - np.median(flat, axis=0)
        values, axes = np.linalg.eigh(np.cov(centred.T))
        scale = axes / np.sqrt(np.maximum(values, LEAST_SPREAD**2)) / SPAN * (BINS / 2)
        place = centred @ scale + BINS / 2
        i, j, k = np.clip(place, 0, BINS - 1).astype(np.intp).T
        return Colors((i * BINS + j) * BINS + k, light.reshape(-1, 3))


def evidence(colors: Colors, inside: Picture, others: Sequence[Picture], asked: Picture) -> Array:
    """Log likelihood ratios (rows, columns) of object to surroundings.

    `inside` (rows, columns) is the probability that the object is there, `others` those of its
    neighbours where it is not; `asked` how far a pixel may speak at all, 0 where something else is
    in front.
    """
    prior = np.clip(inside.ravel(), 0.01, 0.99)
    weights: Array = asked.ravel()
    parts = [np.clip(other.ravel(), 0.0, 1.0) for other in others]
    ground = np.maximum(1 - np.sum(parts, axis=0), 0.02) if parts else np.ones(len(prior))
    shadow = in_shadow(colors.light, (prior < GROUND) & (ground * weights > 0.5))
    share: Array = prior
    ratio: Array = np.zeros(len(prior))
    for _ in range(ROUNDS):
        own = histogram(colors.cells, share * weights)
        rest = np.full(len(prior), 1e-12)
        for part in [ground, *parts]:
            rest += part * histogram(colors.cells, (1 - share) * weights * part)[colors.cells]
        ratio = np.clip(np.log(own[colors.cells] / rest), -LOUDEST, LOUDEST)
        ratio = np.where(ratio > 0, ratio * (1 - shadow), ratio)
        share = 1 / (1 + (1 - prior) / prior * np.exp(-ratio))
    loud: Array = (ratio * weights).reshape(inside.shape)
    return loud


def in_shadow(light: Array, ground: NDArray[np.bool_]) -> Array:
    """How far each pixel's light (N, 3) may be the ground's, dimmed, from 0 to 1."""
    if ground.sum() < 30:
        return np.zeros(len(light))
    usual = np.median(light[ground], axis=0)
    # black ground can't be told from its own shadow
    if not usual.any():
        return np.zeros(len(light))
    along = usual / np.linalg.norm(usual)
    reach = light @ along
    off = np.sqrt(np.maximum(np.einsum("ij,ij->i", light, light) - reach**2, 0.0))
    off /= np.maximum(reach, 1e-4)
    spread = float(np.median(off[ground]))
    part = reach / (usual @ along)
    # the darker, the less its colour can be told
    allowed = OFF_LINE * (spread + 0.01 / np.maximum(part, 0.02))
    dim = (part > DARKEST) & (part < BRIGHTEST)
    shadow: Array = np.exp(-0.5 * (off / allowed) ** 2) * dim
    return shadow


def histogram(cells: NDArray[np.intp], weights: Array) -> Array:
    """How likely each cell is (BINS^3,) among pixels with cells and weights (N,), smoothed."""
    counts: Array = np.bincount(cells, weights, minlength=BINS**3).astype(float)
    counts = counts.reshape(BINS, BINS, BINS)
    for axis in range(3):
        counts = np.moveaxis(counts, axis, 0)
        flat = np.ascontiguousarray(counts.reshape(BINS, -1))
        blurred = cv2.GaussianBlur(flat, (1, 5), BIN_BLUR, borderType=cv2.BORDER_REPLICATE)
        counts = np.moveaxis(np.asarray(blurred, dtype=float).reshape(counts.shape), 0, axis)
    total = max(float(counts.sum()), 1e-9)
    spread: Array = (counts / total * (1 - EVEN) + EVEN / BINS**3).ravel()
    return spread
