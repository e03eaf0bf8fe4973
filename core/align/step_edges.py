# SPDX-License-Identifier: GPL-3.0-or-later
"""Profiles of light across an edge in, how likely a blurred step is at every place along them out.

On either side of the step light is a level and a slope, all blurred by the picture's own sharpness.
Where an object meets what it stands on, light fades into the corner on both sides, as the root of
the distance: fitted without that, the step would lie outside the corner. For every place the
amplitudes are solved linearly (variable projection, Golub & Pereyra 1973).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import erf

import cv2
import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, Mask
from ..picture.pictures import Picture

SAMPLE_STEP = 0.5
PLACE_STEP = 0.125
# priors in units of a step: on a slope over so many pixels, and on the fading into a corner
SLOPE_PIXELS, SLOPE_PRIOR, FADE_PRIOR = 4.0, 0.3, 0.1
CONTACT_SLOPE_PRIOR = 0.5
FADE_PIXELS = 4.0
NODES = 240
# samples lie half a pixel apart and share their light: so many count as one of their own
SHARED = 2.5
_erf = np.vectorize(erf, otypes=[float])


@dataclass(frozen=True, eq=False)
class Misfits:
    """Twice the negative log likelihood, up to a constant, over J places (J,) along N profiles.

    `with_step` (J, N), and `without` (N,) any. The noise of each profile is its own unknown.
    """

    places: Array
    with_step: Array
    without: Array

    def pooled(self, group: NDArray[np.intp], count: int) -> Misfits:
        """The same of groups of neighbours: group (N,) of each profile, below `count`."""
        members = np.zeros((len(group), count))
        members[np.arange(len(group)), group] = 1.0
        return Misfits(self.places, self.with_step @ members, self.without @ members)


def profiles(light: Picture, pixels: Array, normals: Array, reach: float) -> Array:
    """Light (N, K, C) along normals, every half pixel from -reach to reach."""
    offsets = _offsets(reach)
    places = (pixels[:, None] + offsets[:, None] * normals[:, None]).astype(np.float32)
    found = cv2.remap(
        light, places[..., 0], places[..., 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE
    )
    return np.asarray(found, dtype=float).reshape(len(pixels), len(offsets), -1)


def step_misfits(
    light: Array, contact: Mask, reach: float, search: float, blur: float, noise: float
) -> Misfits:
    """Of steps on profiles (N, K, C) up to `search` pixels off the middle.

    `contact` (N,) tells where an object meets what it stands on; `blur` is 1 sigma of the picture's
    sharpness in pixels, `noise` of a sample in light.
    """
    count, length, channels = light.shape
    centred = np.swapaxes(light - light.mean(axis=1, keepdims=True), 0, 1)
    own = length * channels / SHARED
    floor = length * channels * noise**2
    places, flat = _places(search), _flat(reach)
    with_step = np.empty((len(places), count))
    for fading in (False, True):
        rows = contact if fading else ~contact
        if not rows.any():
            continue
        bases = _bases(reach, search, round(blur, 2), fading)
        left = _left(np.ascontiguousarray(centred[:, rows]), bases.reshape(-1, length), len(places))
        with_step[:, rows] = own * np.log(left + floor)
    without = own * np.log(_left(np.ascontiguousarray(centred), flat.T, 1)[0] + floor)
    return Misfits(places, with_step, without)


def _left(samples: Array, bases: Array, places: int) -> Array:
    """What the bases (J P, K) leave of samples (K, N, C), squared, (J, N)."""
    length, count, channels = samples.shape
    flat = samples.reshape(length, -1)
    explained = np.square(bases @ flat).reshape(places, -1, count, channels).sum(axis=(1, 3))
    total = np.square(flat).sum(axis=0).reshape(count, channels).sum(axis=1)
    left: Array = np.maximum(total - explained, 0.0)
    return left


def _offsets(reach: float) -> Array:
    last = round(reach / SAMPLE_STEP)
    return np.arange(-last, last + 1) * SAMPLE_STEP


def _places(search: float) -> Array:
    count = max(2, round(search / PLACE_STEP))
    return np.arange(-count, count + 1) * PLACE_STEP


@lru_cache(maxsize=16)
def _flat(reach: float) -> Array:
    offsets = _offsets(reach)
    return np.linalg.qr(np.stack([np.ones_like(offsets), offsets], axis=1))[0]


@lru_cache(maxsize=64)
def _bases(reach: float, search: float, blur: float, fading: bool) -> Array:
    """Orthonormal bases (J, P, K) of what light may be, for every place (J,) of the step."""
    beyond = _offsets(reach) - _places(search)[:, None]
    outside, far = _blurred(beyond, blur)
    columns = [np.ones_like(beyond), outside, far / SLOPE_PIXELS, (beyond - far) / SLOPE_PIXELS]
    priors = [CONTACT_SLOPE_PRIOR if fading else SLOPE_PRIOR] * 2
    if fading:
        columns += [
            _blurred_root(side * beyond / FADE_PIXELS, blur / FADE_PIXELS) for side in (1, -1)
        ]
        priors += [FADE_PRIOR] * 2
    design = np.stack(columns, axis=2)
    prior = np.zeros((len(beyond), len(priors), len(columns)))
    prior[:, np.arange(len(priors)), 2 + np.arange(len(priors))] = priors
    q, _ = np.linalg.qr(np.concatenate([design, prior], axis=1))
    return np.ascontiguousarray(q[:, : beyond.shape[1]].transpose(0, 2, 1))


def _blurred(beyond: Array, blur: float) -> tuple[Array, Array]:
    """A step, and a ramp from it on, under a Gaussian's blur."""
    outside = 0.5 * (1 + _erf(beyond / (blur * np.sqrt(2))))
    density = np.exp(-0.5 * (beyond / blur) ** 2) / np.sqrt(2 * np.pi)
    return outside, beyond * outside + blur * density


def _blurred_root(beyond: Array, blur: float) -> Array:
    """The root of the distance beyond the step under a Gaussian's blur.

    Over w = sqrt(y) the integrand is smooth at the step, where the root itself sets in steeply.
    """
    farthest = max(float(beyond.max()) + 6 * blur, blur)
    w = np.linspace(0, np.sqrt(farthest), NODES)
    share = np.exp(-0.5 * ((w**2 - beyond[..., None]) / blur) ** 2) / (blur * np.sqrt(2 * np.pi))
    root: Array = share @ (2 * w**2 * (w[1] - w[0]))
    return root
