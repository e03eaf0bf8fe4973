# SPDX-License-Identifier: GPL-3.0-or-later
"""How light falls on an object: brightness of pixels by patch in, the smooth part of it out."""

from __future__ import annotations

import numpy as np

from ..arrays import Array, Mask
from ..robust import core_sigma, tukey_weights
from ..shape.charts import RoundChart, chart_of
from ..shape.hits import face_names
from .sure_pixels import Indices, Sight

# a curved face is cut into sectors, over which light changes little
SECTORS = 24
# a patch of light is believed when it holds this share of the pixels
PATCH_SHARE = 0.08
# fewer pixels tell a level, but no slope; or a slope, but no curvature
FEWEST_FOR_SLOPE, FEWEST_FOR_CURVE = 24, 80
ROUNDS = 8


def patches_of(sight: Sight, index: int, rows: Indices, columns: Indices) -> Indices:
    """The number (N,) of the patch of each pixel: its face, and on curved ones the sector of it."""
    thing = sight.things[index]
    face = sight.seen.face[rows, columns].astype(np.intp)
    patches = face * SECTORS**2
    origin, rays = sight.camera.rays_world(np.stack([columns, rows], axis=1))
    depth = sight.seen.depth[rows, columns][:, None]
    points = thing.world_from_object.inverse().apply(origin + depth * rays)
    for number, name in enumerate(face_names(thing)):
        on, chart = face == number, chart_of(thing, name)
        if isinstance(chart, RoundChart) and on.any():
            patches[on] += (chart.coordinates(points[on])[:, 0] * SECTORS).astype(np.intp)
        elif name == "surface":
            s, t = chart.coordinates(points).T
            patches += (s * SECTORS).astype(np.intp) * SECTORS
            patches += (t * SECTORS / 2).astype(np.intp)
    return np.unique(patches, return_inverse=True)[1].ravel()


def patch_levels(brightness: Array, patches: Indices, alike: Mask) -> Array:
    """The brightness that most of each patch has, of the pixels that are `alike` alone."""
    levels = np.zeros(patches.max() + 1)
    for patch in range(len(levels)):
        values = np.sort(brightness[(patches == patch) & alike])
        if not len(values):
            values = np.sort(brightness[patches == patch])
        levels[patch] = _shortest_half(values)
    return levels


def smooth_light(
    brightness: Array, patches: Indices, levels: Array, alike: Mask, places: Array
) -> Array:
    """The brightness (N,) of smooth light on an even surface: a parabola over each patch, robustly.

    `places` (N, 2) are the pixels. Prints and dirt are left over: they are not smooth.
    """
    smooth = levels[patches]
    for patch, level in enumerate(levels):
        here = np.flatnonzero((patches == patch) & alike)
        if len(here) < FEWEST_FOR_SLOPE:
            continue
        everywhere = np.flatnonzero(patches == patch)
        centre, span = places[here].mean(axis=0), np.ptp(places[here], axis=0) / 2 + 1.0
        terms = _terms((places[everywhere] - centre) / span, len(here) >= FEWEST_FOR_CURVE)
        used = alike[everywhere]
        fitted = _robust_fit(terms[used], brightness[here], level)
        # an even surface is neither black nor a lamp anywhere
        smooth[everywhere] = np.clip(terms @ fitted, 0.2 * level, 3.0 * level)
    return smooth


def best_lit(levels: Array, patches: Indices, alike: Mask) -> float:
    """The brightness of the brightest patch that holds enough of the pixels."""
    counts = np.bincount(patches[alike], minlength=len(levels))
    enough = counts >= min(PATCH_SHARE * counts.sum(), float(counts.max()))
    return float(levels[enough].max())


def _terms(places: Array, curved: bool) -> Array:
    x, y = places.T
    flat = [np.ones(len(x)), x, y]
    return np.stack([*flat, x * x, x * y, y * y] if curved else flat, axis=1)


def _robust_fit(terms: Array, values: Array, level: float) -> Array:
    """Tukey's estimate, from where most of the values lie."""
    fitted = np.zeros(terms.shape[1])
    fitted[0] = level
    for step in range(ROUNDS):
        residuals = values - terms @ fitted
        # slopes look like scatter at first: the first rounds are lenient
        sigma = core_sigma(residuals) * (3.0 if step < 2 else 1.0)
        weights = np.sqrt(tukey_weights(residuals, max(sigma, 1e-6)))
        fitted = np.linalg.lstsq(terms * weights[:, None], values * weights, rcond=None)[0]
    return fitted


def _shortest_half(values: Array) -> float:
    """The median of the narrowest half of sorted values (Rousseeuw's shorth)."""
    half = len(values) // 2 + 1
    widths = values[half - 1 :] - values[: len(values) - half + 1]
    start = int(widths.argmin())
    return float(np.median(values[start : start + half]))
