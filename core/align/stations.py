# SPDX-License-Identifier: GPL-3.0-or-later
"""Places along a solid's edges and a picture in, where light and colours put those edges out.

Neighbours along an edge are looked at together: what light says of a step at every place, and what
colours say of where the object ends, are sums of log likelihoods.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, Mask
from ..picture.pictures import Picture
from .curve_samples import CurveSamples
from .step_edges import PLACE_STEP, Misfits, profiles, step_misfits
from .window import Window, looked_up

CANDIDATES = 3
# a step has to explain a group of profiles by so much more than none, in twice log likelihood
SIGNIFICANT_GAIN = 25.0
# what even a perfect edge is uncertain by
FLOOR_PIXELS = 0.04
# edges inside an outline count less: they may be the texture's
CREASES = 0.5
# what lost evidence costs an edge, in natural units, beyond what blur explains, and at most
PARTED, SLACK, UNPARTED = 0.4, 1.0, 0.05
# light may place an edge this near to where colours find it; colours alone know it to 1 sigma
NEAR_JOINT, BY_COLOR = 0.9, 0.6
# an edge of this gain has half a vote, and one as vague as this; votes are by so much of an outline
CLEAR_GAIN, VAGUE_PIXELS, POOLED_PIXELS = 60.0, 0.6, 12.0


@dataclass(frozen=True)
class Pass:
    """How far profiles reach and edges are searched, and how many profiles are pooled.

    `spread` and `scales` are how far apart states are drawn and when edges agree; `fading` tells
    whether light may fade into the corner with what an object stands on.
    """

    reach: float
    search: float
    pooled: int
    spread: float
    scales: tuple[float, ...]
    fading: bool


@dataclass(frozen=True, eq=False)
class Stations:
    """Neighbours along an edge looked at together: S groups of samples.

    `curve` (S,), `outline` (S,) and `length` (S,) in pixels as of the samples, `pixels` (S, 2)
    their middles, `by_object` (S, 6 + P) and `by_camera` (S, 6) their means. `offsets`, `sigma` and
    `gain` (3, S) are of the steps found, `standing` (3, S) whether there is one, `parted` (3, S)
    how far the object's colours end there.
    """

    curve: NDArray[np.intp]
    outline: Mask
    length: Array
    pixels: Array
    by_object: Array
    by_camera: Array
    offsets: Array
    sigma: Array
    gain: Array
    standing: Mask
    parted: Array

    @property
    def share(self) -> Array:
        """What each edge explains beside the clearest of its station, squared, (3, S)."""
        gain = np.where(self.standing, np.maximum(self.gain, 0.0), 0.0) * self.parted
        shared: Array = np.square(gain / np.maximum(gain.max(axis=0), 1e-9))
        return shared

    @property
    def worth(self) -> Array:
        """What each station counts, (S,): an edge inside the outline may be the texture's."""
        worth: Array = np.where(self.outline, 1.0, CREASES)
        return worth

    def votes(self, moves: Array, near: float) -> Array:
        """How many stations have an edge where moves (T, S) along their normals bring theirs, (T,).

        An edge counts up to about `near` pixels off, and more the clearer it is.
        """
        clear = self.gain / (self.gain + CLEAR_GAIN) / (1 + (self.sigma / VAGUE_PIXELS) ** 2)
        clear = np.where(self.standing, clear, 0.0) * self.share * self.worth * self.parted
        reach = near**2 + np.minimum(1.5 * self.sigma, VAGUE_PIXELS) ** 2
        best = np.zeros(moves.shape)
        for offsets, weight, wide in zip(self.offsets, clear, reach, strict=True):
            best = np.maximum(best, weight * np.maximum(0, 1 - (offsets - moves) ** 2 / wide))
        total: Array = (best * self.length).sum(axis=1) / POOLED_PIXELS
        return total


@dataclass(frozen=True, eq=False)
class Look:
    """The picture's linear light (H, W, 3), its sharpness and noise, and what is near others.

    `hidden` (H, W) is above 0 where other objects are in front or too near to tell apart, `region`
    the evidence for the object in a `window`, from its colours. `stands` tells whether its base
    meets something.
    """

    light: Picture
    blur: float
    noise: float
    hidden: Picture
    window: Window
    region: Array
    stands: bool

    def lost_evidence(self, samples: CurveSamples, shares: Array, search: float) -> Array:
        """What colours say against an edge at every place (J,) up to `search`, (J, S), per pixel.

        Along each normal pixels inside an edge should be the object's, and outside not: the sum of
        evidence, below its best. `shares` (S, N) join samples to stations.
        """
        count = max(2, round(search / PLACE_STEP))
        d = np.arange(-count, count + 1) * PLACE_STEP
        coarse = np.arange(-search - 0.5, search + 0.75, 0.5)
        places = samples.pixels[:, None] + coarse[:, None] * samples.normals[:, None]
        at = looked_up(self.region[:, :, None], self.window.places(places))[..., 0]
        mean = shares @ at
        # 2 L is what moving an edge by one pixel over evidence L changes
        sums = np.concatenate([np.zeros((len(mean), 1)), np.cumsum(mean, axis=1)], axis=1)
        ends = np.append(coarse - 0.25, coarse[-1] + 0.25)
        lost = np.array([np.interp(d, ends, row) for row in sums])
        return (lost.max(axis=1, keepdims=True) - lost).T


def find_stations(samples: CurveSamples, look: Look, stage: Pass) -> Stations:
    """The stations of samples (N,), and the edges that light and colours show at them."""
    contact = np.array(["base" in name for name in samples.names] + [False])[samples.curve]
    contact &= stage.fading and look.stands
    light = profiles(look.light, samples.pixels, samples.normals, stage.reach)
    misfits = step_misfits(light, contact, stage.reach, stage.search, look.blur, look.noise)
    group = _groups(samples.curve, stage.pooled)
    count = int(group[-1]) + 1
    members = np.zeros((count, len(group)))
    members[group, np.arange(len(group))] = 1.0
    shares = members / members.sum(axis=1, keepdims=True)
    first = np.searchsorted(group, np.arange(count))
    pooled, outline = misfits.pooled(group, count), samples.outline[first]
    length = members @ samples.spacing
    lost = look.lost_evidence(samples, shares, stage.search) * outline
    joint = Misfits(
        pooled.places,
        pooled.with_step + 2 * PARTED * lost * length,
        pooled.without + 2 * PARTED * lost.mean(axis=0) * length,
    )
    offsets, sigma, gain, standing, best = _candidates(joint)
    if stage.fading:
        # colours find an edge, light places it
        alone = _candidates(pooled)
        clear = alone[3] & (np.abs(alone[0] - offsets[:1]) < NEAR_JOINT)
        offsets = np.where(clear, alone[0], offsets)
        sigma = np.where(clear, alone[1], np.maximum(sigma, BY_COLOR))
        gain = np.where(clear, alone[2], gain)
        standing = np.where(clear.any(axis=0), clear, standing)
        best = np.where(clear, alone[4], best)
    parted = np.exp(-np.maximum(np.take_along_axis(lost, best, axis=0) * PARTED - SLACK, 0.0))
    parted = np.maximum(parted, UNPARTED)
    return Stations(
        samples.curve[first],
        samples.outline[first],
        length,
        shares @ samples.pixels,
        shares @ samples.by_object,
        shares @ samples.by_camera,
        offsets,
        sigma,
        gain,
        standing,
        np.where(outline, parted, 1.0),
    )


def _groups(curve: NDArray[np.intp], size: int) -> NDArray[np.intp]:
    """The group of each sample: about `size` neighbours of one curve."""
    group, number = np.zeros(len(curve), dtype=np.intp), 0
    starts = [0, *(np.flatnonzero(np.diff(curve)) + 1), len(curve)]
    for start, end in pairwise(starts):
        parts = max(1, round((end - start) / size))
        group[start:end] = number + np.arange(end - start) * parts // (end - start)
        number += parts
    return group


def _candidates(misfits: Misfits) -> tuple[Array, Array, Array, Mask, NDArray[np.intp]]:
    """Offsets, sigma, gain and standing (3, S) of the likeliest places, likeliest first."""
    value = misfits.with_step
    low = np.full(value.shape, np.inf)
    inner = (value[1:-1] <= value[:-2]) & (value[1:-1] < value[2:])
    low[1:-1][inner] = value[1:-1][inner]
    order = np.argpartition(low, CANDIDATES, axis=0)[:CANDIDATES]
    order = np.take_along_axis(order, np.take_along_axis(low, order, 0).argsort(0), 0)
    best = np.clip(order, 1, len(value) - 2)
    before, at, after = (np.take_along_axis(value, best + i, 0) for i in (-1, 0, 1))
    bend = np.maximum(before - 2 * at + after, 1e-9)
    shift = np.clip(0.5 * (before - after) / bend, -1, 1)
    gain = misfits.without - at
    standing = np.isfinite(np.take_along_axis(low, order, 0)) & (gain > SIGNIFICANT_GAIN)
    sigma = np.sqrt(2 * PLACE_STEP**2 / bend + FLOOR_PIXELS**2)
    return misfits.places[best] + shift * PLACE_STEP, sigma, gain, standing, best


def unhidden(samples: CurveSamples, hidden: Picture) -> CurveSamples:
    """The samples that lie where `hidden` (H, W) is 0."""
    rows = np.round(samples.pixels[:, 1]).astype(int).clip(0, hidden.shape[0] - 1)
    columns = np.round(samples.pixels[:, 0]).astype(int).clip(0, hidden.shape[1] - 1)
    return samples.chosen(hidden[rows, columns] == 0)
