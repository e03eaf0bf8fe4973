# SPDX-License-Identifier: GPL-3.0-or-later
"""A ball's outline measured to a fraction of a pixel: a rough sphere in, the fitted one out."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import cv2
import numpy as np

from ..arrays import Array, Mask
from ..errors import SphereNotFound
from ..intrinsics import Intrinsics
from ..picture.pictures import Light
from ..robust import beside_runs, core_sigma, correlation_inflation, middle_of, tukey_weights
from .downhill import lowest
from .limb import LimbEdges, find_limb, sample_offsets
from .outline_checks import (
    LARGEST_CUT,
    cut_refusal,
    doubts_of,
    refuse_clutter,
    refuse_few,
    refuse_little,
    refuse_small,
)
from .sphere import OutlineRays, centre_covariance, tangency

MOST_POINTS, FEWEST_POINTS = 400, 48
BLURS = (0.4, 0.53, 0.7, 0.93, 1.25, 1.7, 2.3, 3.1)
SHARPNESS_POINTS = 80
FIRST_SEARCH, FIRST_BLUR, FIRST_POINTS, LARGE = 4.0, 0.7, 96, 60.0
# an edge has to explain its profile this much better than no edge, in units of the noise
SIGNIFICANT_GAIN = 25.0
# what a perfect edge is still uncertain by: sampling, the model of the limb
FLOOR_PIXELS = 0.02
# neighbouring profiles share pixels: their scatter understates the outline's error by this factor,
# found on synthetic balls with noise of known size
SHARED_PIXELS = 1.3
# what hides or outshines a part of an outline also pulls the edges beside it, unseen: sigmas grow
# by this much for the whole outline, in proportion to the part; found on synthetic fingers
HIDDEN_PART = 1.5
# edges belong to the outline when they lie in this band (pixels, or share of the radius: real balls
# are not round to more than half a percent), though they were looked for in a much wider one
BELONGS_PIXELS, BELONGS_SHARE = 0.6, 0.005
FINE_SEARCH = 1.75
OUT_OF_ROUND_SHARE = 0.003
# a step this small, as a share of the distance, is a hundredth of an outline's own error
SETTLED = 1e-6
JUDGED_SHARE, JUDGED_PIXELS = 0.06, 4.0
MOST_INDEPENDENT = 300.0


@dataclass(frozen=True, eq=False)
class SphereOutline:
    """A ball found in a picture.

    - `centre_camera` (3,) in metres and `covariance` (3, 3) of it, for the `radius` given
    - `pixels` (N, 2): outline points measured, `sigma_pixels` (N,) of each along its normal,
      `residual_pixels` (N,) outwards from the fitted outline, `used` (N,): not outvoted
    - `coverage`: share of the whole outline whose edge was found where it should be, and
      `evidence`: by how many sigmas that is more than chance
    - `cut`: share of the outline that lies outside the picture
    - `rms_pixels` of the used residuals' normal core; `blur_pixels`: the picture's sharpness, sigma
    """

    centre_camera: Array
    covariance: Array
    radius: float
    pixels: Array
    sigma_pixels: Array
    residual_pixels: Array
    used: Mask
    coverage: float
    evidence: float
    cut: float
    rms_pixels: float
    blur_pixels: float
    warnings: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class _Profiles:
    """Light (N, K, C) sampled across N places of an outline, within `reach` pixels of it."""

    light: Array
    reach: float
    places: OutlineRays
    normals: Array
    inside: Mask


@dataclass(frozen=True, eq=False)
class _Measured:
    """One pass around the outline: where edges are, how sure, and which profiles lie inside."""

    outline: OutlineRays
    edges: LimbEdges
    noise: float
    inside: Mask


class OutlineMeter:
    """Measures outlines in one picture of linear light (H, W, 3) whose corner is `origin` (2,)."""

    def __init__(self, light: Light, origin: Array, intrinsics: Intrinsics, radius: float) -> None:
        self._light, self._origin = light, origin
        self._intrinsics, self._radius = intrinsics, radius

    def measure(self, rough_centre: Array) -> SphereOutline:
        """The sphere whose outline lies near that of `rough_centre` (3,), in the camera frame.

        Raises SphereNotFound when too little of the outline has an edge where it should be, and
        SphereCut when too much of it lies outside the picture.
        """
        centre, contrast = rough_centre, 0.1
        # what is found at a large ball's scale is off by more pixels: look twice
        for _ in range(2 if self._size_pixels(centre) > LARGE else 1):
            measured = self._pass(centre, FIRST_SEARCH, FIRST_BLUR, contrast, FIRST_POINTS)
            centre, contrast = self._fitted(centre, measured), _noise_to_contrast(measured)
        blur = self._sharpness(centre, contrast)
        measured = self._pass(centre, FINE_SEARCH, blur, contrast)
        centre, contrast = self._fitted(centre, measured), _noise_to_contrast(measured)
        coverage, evidence = self._coverage(centre, blur, contrast)
        return self._judged(centre, measured, blur, coverage, evidence)

    def _pass(
        self, centre: Array, search: float, blur: float, contrast: float, most: int = MOST_POINTS
    ) -> _Measured:
        profiles = self._profiles(centre, max(4.0, 2.5 * blur + 2.0, search + 2.5), most)
        edges = find_limb(
            profiles.light,
            profiles.reach,
            min(search, 0.5 * profiles.reach),
            blur,
            self._size_pixels(centre),
            contrast,
        )
        _, samples, channels = profiles.light.shape
        freedom = max(1, (samples - 4) * channels - 1)
        noise = float(np.sqrt(max(middle_of(edges.misfits) / freedom, 1e-12)))
        outline = profiles.places.moved(profiles.normals, edges.offsets_pixels)
        return _Measured(outline, edges, noise, profiles.inside)

    def _profiles(self, centre: Array, reach: float, most: int = MOST_POINTS) -> _Profiles:
        size = self._size_pixels(centre)
        refuse_small(size)
        reach = min(reach, 0.6 * size)
        count = int(np.clip(2 * np.pi * size, FEWEST_POINTS, most))
        places = OutlineRays.around(self._intrinsics, centre, self._radius, count)
        if not np.isfinite(places.pixels).all():
            raise SphereNotFound("part of the outline lies outside what the lens images")
        normals = tangency(places, centre, self._radius).normals
        offsets = sample_offsets(reach)
        at = places.pixels[:, None] + normals[:, None] * offsets[:, None]
        inside = self._intrinsics.contains(at[:, 0]) & self._intrinsics.contains(at[:, -1])
        return _Profiles(self._sampled(at), reach, places, normals, inside)

    def _sampled(self, at: Array) -> Array:
        places = (at - self._origin).astype(np.float32)
        sampled = cv2.remap(
            self._light,
            places[..., 0],
            places[..., 1],
            cv2.INTER_CUBIC,
            borderMode=cv2.BORDER_REPLICATE,
        )
        return sampled.reshape(*places.shape[:2], -1).astype(float)

    def _size_pixels(self, centre: Array) -> float:
        focal = 0.5 * (self._intrinsics.fx + self._intrinsics.fy)
        distance = float(np.linalg.norm(centre))
        return float(np.tan(np.arcsin(min(0.999, self._radius / distance))) * focal)

    def _sigmas(self, measured: _Measured) -> Array:
        spread = 2 * measured.noise**2 / measured.edges.curvatures
        return np.sqrt(spread + FLOOR_PIXELS**2)

    def _out_of_round(self, sigma: Array, centre: Array) -> float:
        """What a ball is out of round by, in sigmas: the least spread that is believed.

        Else the arc that happens to fit best would vote the rest of a real ball down.
        """
        return OUT_OF_ROUND_SHARE * self._size_pixels(centre) / middle_of(sigma)

    def _candidates(self, measured: _Measured) -> Mask:
        significant = measured.edges.gains > SIGNIFICANT_GAIN * measured.noise**2
        candidates: Mask = significant & measured.inside
        if candidates.sum() < 8:
            if measured.inside.mean() < 1 - LARGEST_CUT:
                raise cut_refusal(1 - float(measured.inside.mean()))
            raise SphereNotFound(
                f"only {int(candidates.sum())} of {len(candidates)} places of the outline have an "
                "edge that stands out of the noise"
            )
        return candidates

    def _fitted(self, centre: Array, measured: _Measured) -> Array:
        """The sphere through the edges, by reweighted Gauss-Newton steps."""
        candidates = self._candidates(measured)
        outline = measured.outline.chosen(candidates)
        sigma = self._sigmas(measured)[candidates]
        least = self._out_of_round(sigma, centre)
        for _ in range(6):
            held = tangency(outline, centre, self._radius)
            scaled = held.residual_pixels / sigma
            weights = tukey_weights(scaled, max(core_sigma(scaled), least)) / sigma**2
            weights = weights * ~beside_runs(weights == 0)
            root = np.sqrt(weights)
            step = np.linalg.lstsq(
                held.by_centre * root[:, None], held.residual_pixels * root, rcond=None
            )[0]
            centre = centre - step
            if not np.isfinite(centre).all() or np.linalg.norm(centre) < 1.01 * self._radius:
                raise SphereNotFound("the edges around the guess form no outline of a ball")
            if np.linalg.norm(step) < SETTLED * np.linalg.norm(centre):
                break
        return centre

    def _sharpness(self, centre: Array, contrast: float) -> float:
        """The blur that explains the profiles best, between the steps by a parabola."""
        profiles = self._profiles(centre, 6.0, SHARPNESS_POINTS)
        size, reach = self._size_pixels(centre), profiles.reach
        light = profiles.light[profiles.inside]
        if len(light) < 8:
            raise cut_refusal(1 - float(profiles.inside.mean()))

        @cache
        def left(i: int) -> float:
            edges = find_limb(light, reach, min(1.5, 0.5 * reach), BLURS[i], size, contrast)
            # the worst profiles cross a finger or a texture and tell nothing of the sharpness
            kept = np.sort(edges.misfits)
            return float(kept[: max(6, int(0.6 * len(kept)))].mean())

        best = lowest(left, BLURS.index(FIRST_BLUR), len(BLURS))
        i = min(max(best, 1), len(BLURS) - 2)
        logs = np.log(BLURS[i - 1 : i + 2])
        bend, slope, _ = np.polyfit(logs, [left(i - 1), left(i), left(i + 1)], 2)
        between = float(np.exp(-slope / (2 * bend))) if bend > 0 else BLURS[best]
        return min(max(between, BLURS[i - 1]), BLURS[i + 1])

    def _coverage(self, centre: Array, blur: float, contrast: float) -> tuple[float, float]:
        """The share of the outline whose strongest edge, looked for far around, lies on it.

        Beside it the evidence: by how many sigmas that is more than edges anywhere would give.
        """
        size = self._size_pixels(centre)
        search = max(min(JUDGED_PIXELS, 0.3 * size), JUDGED_SHARE * size)
        measured = self._pass(centre, search, blur, contrast)
        outside = tangency(measured.outline, centre, self._radius).residual_pixels
        spread = 3 * np.sqrt(2 * measured.noise**2 / measured.edges.curvatures)
        band = max(BELONGS_PIXELS, BELONGS_SHARE * size) + np.minimum(spread, BELONGS_PIXELS)
        significant = measured.edges.gains > SIGNIFICANT_GAIN * measured.noise**2
        coverage = float((significant & measured.inside & (np.abs(outside) < band)).mean())
        chance = float(np.clip(band.mean() / search, 0.01, 0.9))
        independent = min(2 * np.pi * size, MOST_INDEPENDENT)
        return coverage, (coverage - chance) / np.sqrt(chance * (1 - chance) / independent)

    def _judged(
        self, centre: Array, measured: _Measured, blur: float, coverage: float, evidence: float
    ) -> SphereOutline:
        candidates = self._candidates(measured)
        outline = OutlineRays.of(self._intrinsics, measured.outline.pixels[candidates])
        held = tangency(outline, centre, self._radius)
        sigma = self._sigmas(measured)[candidates]
        scaled = held.residual_pixels / sigma
        scale = max(core_sigma(scaled), self._out_of_round(sigma, centre))
        used = tukey_weights(scaled, scale) > 0.1
        used &= ~beside_runs(~used)
        refuse_few(int(used.sum()), len(used))
        size = self._size_pixels(centre)
        cut = 1 - float(measured.inside.mean())
        refuse_little(coverage, cut)
        inflation = correlation_inflation(held.residual_pixels, used)
        hidden = 1 - float(used.sum()) / len(measured.inside)
        careful = SHARED_PIXELS * (1 + HIDDEN_PART * hidden)
        sigma = sigma * scale * careful * np.sqrt(inflation)
        rms = core_sigma(held.residual_pixels[used])
        refuse_clutter(evidence, rms, size)
        return SphereOutline(
            centre,
            centre_covariance(held, sigma, used),
            self._radius,
            outline.pixels,
            sigma,
            held.residual_pixels,
            used,
            coverage,
            evidence,
            cut,
            rms,
            blur,
            doubts_of(coverage, cut, rms, size),
        )


def _noise_to_contrast(measured: _Measured) -> float:
    contrast = np.sqrt(middle_of(measured.edges.gains) / 10)
    return float(measured.noise / max(contrast, 1e-6))
