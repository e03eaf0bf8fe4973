# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a ball's limb crosses profiles of light: samples across the outline in, edges out.

A ball darkens (or glows) towards its limb, and the steepest place of a profile therefore lies
inside the true edge. Here each profile is explained as background + ball, where the ball's light is
`a + b n_z`, n_z being how far the surface faces the camera: `sqrt(2 d / R - d^2 / R^2)` at depth d
inside an outline of radius R. All is blurred by the picture's own sharpness. For every place of the
edge the amplitudes are solved linearly (variable projection, Golub & Pereyra 1973); the place that
leaves least is the edge, and the curvature there is its certainty.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import erf

import numpy as np

from ..arrays import Array

_erf = np.vectorize(erf, otypes=[float])
SAMPLE_STEP = 0.5
PLACE_STEP = 0.125
# the background may change across a profile, but by less than the edge does: a weak prior on its
# slope, in units of noise over contrast and pixel, keeps it from explaining noise
SLOPE_PRIOR = 5.0
FACING_NODES = 240


@dataclass(frozen=True, eq=False)
class LimbEdges:
    """Edges found on N profiles.

    - `offsets_pixels` (N,): place of the edge, outwards from the profile's middle
    - `curvatures` (N,): second derivative of the squared misfit by the place, per channel noise
    - `misfits` (N,): squared misfit that is left, in light squared
    - `gains` (N,): by how much the edge explains the profile better than no edge
    """

    offsets_pixels: Array
    curvatures: Array
    misfits: Array
    gains: Array


def sample_offsets(reach: float) -> Array:
    """The places (K,) along a normal at which a profile is sampled, in pixels, outwards."""
    count = round(reach / SAMPLE_STEP)
    return np.arange(-count, count + 1) * SAMPLE_STEP


def find_limb(
    profiles: Array,
    reach: float,
    search: float,
    blur_pixels: float,
    radius_pixels: float,
    noise_to_contrast: float = 0.1,
) -> LimbEdges:
    """Find the edge on profiles (N, K, C) of linear light sampled at `sample_offsets(reach)`.

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
    samples = np.swapaxes(profiles, 0, 1).reshape(profiles.shape[1], -1)
    total = (samples**2).sum(0)
    rank = bases.shape[2]
    amplitudes = bases.transpose(0, 2, 1).reshape(-1, len(samples)) @ samples
    explained = (amplitudes**2).reshape(len(places), rank, -1).sum(1)
    channels = profiles.shape[2]
    misfit = (total - explained).reshape(len(places), -1, channels).sum(2)
    without = (total - ((flat.T @ samples) ** 2).sum(0)).reshape(-1, channels).sum(1)
    best = np.clip(np.argmin(misfit, axis=0), 1, len(places) - 2)
    n = np.arange(misfit.shape[1])
    before, at, after = (misfit[best + i, n] for i in (-1, 0, 1))
    bend = np.maximum(before - 2 * at + after, 1e-30)
    shift = np.clip(0.5 * (before - after) / bend, -1, 1)
    least = np.maximum(at - 0.25 * (before - after) * shift, 0)
    return LimbEdges(
        places[best] + shift * PLACE_STEP,
        bend / PLACE_STEP**2,
        least,
        np.maximum(without - least, 0),
    )


def _in_steps(value: float, ratio: float) -> float:
    """The nearest power of `ratio`: bases hardly change within a step, and come from the cache."""
    return float(ratio ** round(np.log(max(value, 1e-3)) / np.log(ratio)))


@lru_cache(maxsize=256)
def _bases(
    reach: float, search: float, blur: float, radius: float, noise_to_contrast: float
) -> tuple[Array, Array, Array]:
    """Orthonormal bases (J, K, P) for every place (J,), and those of a profile without edge."""
    offsets = sample_offsets(reach)
    count = round(search / PLACE_STEP)
    places = np.arange(-count, count + 1) * PLACE_STEP
    depth = places[:, None] - offsets
    inside, facing, outside = _blurred(depth, blur, radius)
    ones = np.ones_like(depth)
    columns = np.stack([ones, inside, facing, outside], axis=2)
    prior = np.zeros((len(places), 1, 4))
    prior[:, 0, 3] = SLOPE_PRIOR * noise_to_contrast
    bases = np.linalg.qr(np.concatenate([columns, prior], axis=1))[0][:, :-1]
    flat, _ = np.linalg.qr(np.stack([np.ones_like(offsets), offsets], axis=1))
    return places, bases, flat


def _blurred(depth: Array, blur: float, radius: float) -> tuple[Array, Array, Array]:
    """Ball or not, ball times n_z, and the background's slope, each blurred, over the depth.

    A Gaussian's integrals, not sums over a few nodes: a step summed so is a staircase, and its
    edge lies half a node aside.
    """
    covered = 0.5 * (1 + _erf(depth / (blur * np.sqrt(2))))
    density = np.exp(-0.5 * (depth / blur) ** 2) / np.sqrt(2 * np.pi)
    within = depth * covered + blur * density
    return covered, _blurred_facing(depth, blur, radius), depth - within


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
