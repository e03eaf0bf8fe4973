# SPDX-License-Identifier: GPL-3.0-or-later
"""A ball's outline measured to a fraction of a pixel: a rough sphere in, the fitted one out."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np

from ..arrays import Array, Mask
from ..errors import SphereNotFound
from ..intrinsics import Intrinsics
from ..picture.pictures import Light
from ..robust import beside_runs, core_sigma, correlation_inflation, middle_of
from .downhill import lowest
from .edge_consensus import (
    AGREEMENT_PIXELS,
    NOTHING_EXPECTED,
    Agreement,
    Expectation,
    Tolerance,
    agreed_move,
    settled,
)
from .outline_checks import (
    cut_refusal,
    doubts_of,
    refuse_clutter,
    refuse_few,
    refuse_little,
)
from .outline_ring import Look, OutlineRing
from .sphere import OutlineRays, centre_covariance, tangency

BLURS = (0.4, 0.53, 0.7, 0.93, 1.25, 1.7, 2.3, 3.1)
SHARPNESS_POINTS = 80
FIRST_SEARCH, FIRST_BLUR, FIRST_POINTS, LARGE = 3.0, 0.8, 96, 60.0
FINE_SEARCH, FINE_SHARE = 1.25, 0.006
# how near a centre is known that other places of the ball predict
PREDICTED_SEARCH, PREDICTED_ASIDE_PIXELS, PREDICTED_SIZE_PIXELS = 1.0, 0.3, 0.15
# what the model may leave of a contrast, before the sharpness is known and after
FIRST_TRUST, FINE_TRUST = 0.03, 0.005
# neighbouring profiles share pixels: their scatter understates the outline's error by this factor,
# found on synthetic balls with noise of known size
SHARED_PIXELS = 1.3
# what hides or outshines a part of an outline also pulls the edges beside it, unseen: sigmas grow
# by this much for the whole outline, in proportion to the part; found on synthetic fingers
HIDDEN_PART = 1.5
# edges belong to the outline when they lie in this band (pixels, or share of the radius: real balls
# are not round to more than half a percent), though they were looked for in a much wider one
BELONGS_PIXELS, BELONGS_SHARE = 0.6, 0.005
OUT_OF_ROUND_SHARE = 0.0015
# a step this small, as a share of the distance, is a hundredth of an outline's own error
SETTLED = 1e-6
# a point that robust weights leave less than this is outvoted
USED_WEIGHT = 0.1
JUDGED_SHARE, JUDGED_PIXELS, JUDGED_TRUST = 0.06, 4.0, 0.03
# an edge that leaves more than this of what it may is a texture's, and counts for nothing
MOST_SPOILT = 3.0
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


class OutlineMeter:
    """Measures outlines in one picture of linear light (H, W, 3) whose corner is `origin` (2,)."""

    def __init__(self, light: Light, origin: Array, intrinsics: Intrinsics, radius: float) -> None:
        self._ring = OutlineRing(light, origin, intrinsics, radius)
        self._intrinsics, self._radius = intrinsics, radius

    def measure(
        self, rough_centre: Array, *, predicted: bool = False, beforehand: float = 0.0
    ) -> SphereOutline:
        """The sphere whose outline lies near that of `rough_centre` (3,), in the camera frame.

        A centre `predicted` from the ball's other places is good to a fraction of a pixel: edges
        are sought near it only, and an arc that would need a ball of another size is none of it.
        `beforehand` are sigmas of evidence that there is a ball, before any edge is looked at.

        Raises SphereNotFound when too little of the outline has an edge where it should be, and
        SphereCut when too much of it lies outside the picture.
        """
        centre, contrast = rough_centre, 0.1
        expected = self._expected(rough_centre) if predicted else NOTHING_EXPECTED
        search = PREDICTED_SEARCH if predicted else FIRST_SEARCH
        # what is found at a large ball's scale is off by more pixels: look twice
        for _ in range(2 if self._ring.size_pixels(centre) > LARGE else 1):
            seen = self._ring.look(centre, search, FIRST_BLUR, contrast, FIRST_POINTS)
            move = self._agreement(seen, FIRST_TRUST, AGREEMENT_PIXELS, expected).move
            centre, contrast = centre + move, seen.noise_to_contrast
            expected = expected.after(move)
        blur = self._sharpness(centre, contrast)
        fine = PREDICTED_SEARCH if predicted else FINE_SEARCH
        fine = max(fine, FINE_SHARE * self._ring.size_pixels(centre))
        seen = self._ring.look(centre, fine, blur, contrast)
        move = self._agreement(seen, FINE_TRUST, AGREEMENT_PIXELS, expected).move
        centre, contrast = centre + move, seen.noise_to_contrast
        seen = self._ring.look(centre, fine, blur, contrast)
        agreement = self._agreement(seen, FINE_TRUST, 0.0, expected.after(move))
        coverage, evidence = self._coverage(centre + agreement.move, blur, contrast)
        agreed = agreement.residual_pixels[agreement.weights > USED_WEIGHT]
        size = self._ring.size_pixels(centre)
        refuse_clutter(
            evidence,
            coverage,
            core_sigma(agreed),
            size,
            predicted=predicted,
            beforehand=beforehand,
        )
        return self._judged(seen, agreement, blur, coverage, evidence)

    def _expected(self, centre: Array) -> Expectation:
        """What the ball's other places say of this one's centre."""
        distance = float(np.linalg.norm(centre))
        size = self._ring.size_pixels(centre)
        axis = centre / distance
        aside = PREDICTED_ASIDE_PIXELS * self._radius / size
        deep = PREDICTED_SIZE_PIXELS * distance / size
        along = np.outer(axis, axis)
        return Expectation(np.zeros(3), (np.eye(3) - along) / aside**2 + along / deep**2)

    def _agreement(
        self, seen: Look, trust: float, slack_pixels: float, expected: Expectation
    ) -> Agreement:
        """The sphere that most edges agree on; without slack, from where it stands."""
        edges = seen.weighed(trust)
        distance = float(np.linalg.norm(seen.centre))
        # the arc that happens to fit best would else vote the rest of a real ball down
        round_to = OUT_OF_ROUND_SHARE * self._ring.size_pixels(seen.centre)
        sigma = middle_of(edges.sigma_pixels[edges.valid])
        tolerance = Tolerance(slack_pixels, max(1.0, round_to / sigma), SETTLED * distance)
        start = np.zeros(3)
        if slack_pixels:
            start = agreed_move(edges, seen.by_centre, expected)
        found = settled(edges, seen.by_centre, start, tolerance, expected)
        where = seen.centre + found.move
        if not np.isfinite(where).all() or np.linalg.norm(where) < 1.01 * self._radius:
            raise SphereNotFound("the edges around the guess form no outline of a ball")
        return found

    def _sharpness(self, centre: Array, contrast: float) -> float:
        """The blur that explains the profiles best, between the steps by a parabola."""

        @cache
        def left(i: int) -> float:
            seen = self._ring.look(centre, 1.0, BLURS[i], contrast, SHARPNESS_POINTS)
            # the worst profiles cross a finger or a texture and tell nothing of the sharpness
            kept = np.sort(seen.edges.misfits[0, seen.inside])
            if len(kept) < 8:
                raise cut_refusal(1 - float(seen.inside.mean()))
            return float(kept[: max(6, int(0.5 * len(kept)))].mean())

        best = lowest(left, BLURS.index(0.7), len(BLURS))
        i = min(max(best, 1), len(BLURS) - 2)
        logs = np.log(BLURS[i - 1 : i + 2])
        bend, slope, _ = np.polyfit(logs, [left(i - 1), left(i), left(i + 1)], 2)
        between = float(np.exp(-slope / (2 * bend))) if bend > 0 else BLURS[best]
        return min(max(between, BLURS[i - 1]), BLURS[i + 1])

    def _coverage(self, centre: Array, blur: float, contrast: float) -> tuple[float, float]:
        """The share of the outline that has an edge on it, though edges were looked for far around.

        Beside it the evidence: by how many sigmas that is more than edges anywhere would give.
        """
        size = self._ring.size_pixels(centre)
        search = max(min(JUDGED_PIXELS, 0.35 * size), JUDGED_SHARE * size)
        seen = self._ring.look(centre, search, blur, contrast)
        edges = seen.weighed(JUDGED_TRUST)
        band = max(BELONGS_PIXELS, BELONGS_SHARE * size)
        clear = edges.valid & (edges.spoilt < MOST_SPOILT)
        within = clear & (np.abs(edges.offsets_pixels) < band)
        coverage = float(within.any(axis=0).mean())
        elsewhere = 1 - min(band / search, 0.9)
        chance = 1 - elsewhere ** clear.sum(axis=0)
        spread = np.sqrt(max(float((chance * (1 - chance)).mean()), 1e-3))
        independent = min(2 * np.pi * size, MOST_INDEPENDENT)
        return coverage, (coverage - float(chance.mean())) / spread * np.sqrt(independent)

    def _judged(
        self, seen: Look, agreement: Agreement, blur: float, coverage: float, evidence: float
    ) -> SphereOutline:
        centre = seen.centre + agreement.move
        measured = agreement.weights > USED_WEIGHT
        measured &= ~beside_runs(~measured)
        pixels = seen.places.pixels + seen.normals * agreement.offsets_pixels[:, None]
        outline = OutlineRays.of(self._intrinsics, pixels)
        held = tangency(outline, centre, self._radius)
        used = measured
        refuse_few(int(used.sum()), len(used))
        size = self._ring.size_pixels(centre)
        cut = 1 - float(seen.inside.mean())
        refuse_little(coverage, cut)
        careful = SHARED_PIXELS * (1 + HIDDEN_PART * (1 - float(used.mean())))
        inflation = correlation_inflation(held.residual_pixels, used)
        sigma = agreement.sigma_pixels * agreement.scale * careful * np.sqrt(inflation)
        rms = core_sigma(held.residual_pixels[used])
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
