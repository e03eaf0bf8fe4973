# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a ball's limb may cross profiles of light: samples across the outline in, edges out.

A ball darkens (or glows) towards its limb, and the steepest place of a profile therefore lies
inside the true edge. Here each profile is explained as background + ball, where the ball's light is
`a + b n_z + c d`: n_z is how far the surface faces the camera, `sqrt(2 d / R - d^2 / R^2)` at depth
d inside an outline of radius R, and the last term what light from the side adds. All is blurred by
the picture's own sharpness. For every place of the edge the amplitudes are solved linearly
(variable projection, Golub & Pereyra 1973); each place that leaves less than those beside it is a
candidate, and the curvature there is its certainty.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import erf

import numpy as np

from ..arrays import Array, Mask

SAMPLE_STEP = 0.5
PLACE_STEP = 0.125
CANDIDATES = 3
# the background and the ball may change across a profile, but by less than the edge does: weak
# priors on both slopes, in units of noise over contrast, keep them from explaining noise
SLOPE_PRIOR, DEPTH_PRIOR, DEPTH_UNIT = 5.0, 30.0, 4.0
UNKNOWNS = 5
# a picture without noise leaves nothing but rounding
LEAST_MISFIT = 1e-9
FACING_NODES = 240
_erf = np.vectorize(erf, otypes=[float])


@dataclass(frozen=True)
class Reach:
    """How far a profile is sampled, in pixels: into the ball, and out of it."""

    inwards: float
    outwards: float

    def offsets(self) -> Array:
        """The places (K,) along a normal at which a profile is sampled, in pixels, outwards."""
        first, last = round(self.inwards / SAMPLE_STEP), round(self.outwards / SAMPLE_STEP)
        return np.arange(-first, last + 1) * SAMPLE_STEP


@dataclass(frozen=True, eq=False)
class LimbEdges:
    """Up to three edges on each of N profiles, the one that explains most first.

    - `offsets_pixels` (3, N): places of the edges, outwards from the profile's middle
    - `curvatures` (3, N): second derivative of the squared misfit by the place
    - `misfits` (3, N): squared misfit that is left, in light squared
    - `standing` (3, N): whether the place leaves less than those beside it
    - `flat_misfits` (N,): what is left without any edge
    - `search_pixels`: how far from the middle places were tried
    """

    offsets_pixels: Array
    curvatures: Array
    misfits: Array
    standing: Mask
    flat_misfits: Array
    search_pixels: float


def find_limb(
    profiles: Array,
    reach: Reach,
    search: float,
    blur_pixels: float,
    radius_pixels: float,
    noise_to_contrast: float = 0.1,
) -> LimbEdges:
    """Find edges on profiles (N, K, C) of linear light sampled at `reach.offsets()`.

    Places up to `search` pixels from the middle are tried; `blur_pixels` is the sigma of the
    picture's sharpness, `radius_pixels` that of the outline.
    """
    places, bases, flat = _bases(
        reach,
        search,
        round(blur_pixels, 3),
        _in_steps(radius_pixels, 1.05),
        _in_steps(noise_to_contrast, 1.5),
    )
    count, _, channels = profiles.shape
    # every basis holds the constant, so taking it off changes nothing but keeps the digits
    centred = profiles - profiles.mean(axis=1, keepdims=True)
    samples = np.ascontiguousarray(np.swapaxes(centred, 0, 1).reshape(profiles.shape[1], -1))
    total = np.einsum("km,km->m", samples, samples).reshape(count, channels).sum(1)
    amplitudes = (bases @ samples).reshape(len(places), UNKNOWNS, count, channels)
    misfit = total - np.einsum("jpnc,jpnc->jn", amplitudes, amplitudes)
    tilts = (flat.T @ samples).reshape(2, count, channels)
    without = total - np.einsum("pnc,pnc->n", tilts, tilts)
    return _edges(np.maximum(misfit, LEAST_MISFIT), np.maximum(without, LEAST_MISFIT), places)


def _edges(misfit: Array, without: Array, places: Array) -> LimbEdges:
    """The lowest places of each column, between the steps by a parabola."""
    low = np.full(misfit.shape, np.inf)
    inner = (misfit[1:-1] <= misfit[:-2]) & (misfit[1:-1] < misfit[2:])
    low[1:-1][inner] = misfit[1:-1][inner]
    kept = min(CANDIDATES, len(places))
    order = np.argpartition(low, kept - 1, axis=0)[:kept] if kept < len(places) else low.argsort(0)
    order = np.take_along_axis(order, np.take_along_axis(low, order, 0).argsort(0), 0)
    best = np.clip(order, 1, len(places) - 2)
    before, at, after = (np.take_along_axis(misfit, best + i, 0) for i in (-1, 0, 1))
    bend = np.maximum(before - 2 * at + after, 1e-30)
    shift = np.clip(0.5 * (before - after) / bend, -1, 1)
    return LimbEdges(
        places[best] + shift * PLACE_STEP,
        bend / PLACE_STEP**2,
        np.maximum(at - 0.25 * (before - after) * shift, LEAST_MISFIT),
        np.isfinite(np.take_along_axis(low, order, 0)),
        without,
        float(places[-1]),
    )


def _in_steps(value: float, ratio: float) -> float:
    """The nearest power of `ratio`: bases hardly change within a step, and come from the cache."""
    return float(ratio ** round(np.log(max(value, 1e-3)) / np.log(ratio)))


@lru_cache(maxsize=256)
def _bases(
    reach: Reach, search: float, blur: float, radius: float, noise_to_contrast: float
) -> tuple[Array, Array, Array]:
    """Orthonormal bases (J, P, K) for every place (J,), and those of a profile without edge."""
    offsets = reach.offsets()
    count = max(1, round(search / PLACE_STEP))
    places = np.arange(-count, count + 1) * PLACE_STEP
    depth = places[:, None] - offsets
    covered, deep, outside = _blurred(depth, blur)
    facing = _blurred_facing(depth, blur, radius)
    columns = np.stack(
        [np.ones_like(depth), covered, facing, outside, deep / DEPTH_UNIT],
        axis=2,
    )
    prior = np.zeros((len(places), 2, UNKNOWNS))
    prior[:, 0, 3] = SLOPE_PRIOR * noise_to_contrast
    prior[:, 1, 4] = DEPTH_PRIOR * noise_to_contrast
    bases = np.linalg.qr(np.concatenate([columns, prior], axis=1))[0][:, :-2]
    flat, _ = np.linalg.qr(np.stack([np.ones_like(offsets), offsets], axis=1))
    return places, np.ascontiguousarray(bases.transpose(0, 2, 1)), flat


def _blurred(depth: Array, blur: float) -> tuple[Array, Array, Array]:
    """Ball or not, the depth within it, and that without it (below zero), each blurred.

    A Gaussian's integrals, not sums over a few nodes: a step summed so is a staircase, and its
    edge lies half a node aside.
    """
    covered = 0.5 * (1 + _erf(depth / (blur * np.sqrt(2))))
    density = np.exp(-0.5 * (depth / blur) ** 2) / np.sqrt(2 * np.pi)
    within = depth * covered + blur * density
    return covered, within, depth - within


def _blurred_facing(depth: Array, blur: float, radius: float) -> Array:
    """The integral of n_z(y) over the depths y > 0 under a Gaussian around `depth`.

    Over w = sqrt(y) the integrand is smooth at the limb, where n_z itself sets in steeply.
    """
    farthest = max(float(depth.max()) + 6 * blur, blur)
    w = np.linspace(0, np.sqrt(farthest), FACING_NODES)
    x = np.minimum(w**2 / radius, 1)
    share = np.exp(-0.5 * ((w**2 - depth[..., None]) / blur) ** 2) / (blur * np.sqrt(2 * np.pi))
    facing: Array = share @ (np.sqrt(x * (2 - x)) * 2 * w * (w[1] - w[0]))
    return facing
