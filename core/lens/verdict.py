# SPDX-License-Identifier: GPL-3.0-or-later
"""How far to believe a lens calibration: good, weak or failed, with the reasons in words."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np

from .bundle import LensFit
from .parameters import images_corners
from .quality import LensQuality

Verdict = Literal["good", "weak", "failed"]

FEW_PICTURES = 8
LEAST_TILT_DEGREES = 15.0
LEAST_COVERED = 0.6
LEAST_DISTANCE_RATIO = 1.15
WEAK_RMS, FAILED_RMS = 1.0, 5.0
WEAK_FOCAL, FAILED_FOCAL = 0.003, 0.02
# one lens and the right model give 0.6 to 1.3; a zoom that moved by 2 % gives 3, by 15 % 6
WEAK_DISAGREEMENT, FAILED_DISAGREEMENT = 2.5, 5.0
# a ring of residuals this many sigmas and pixels off, and this part of the noise
RING_SIGMAS, RING_PIXELS, RING_SHARE = 4.0, 0.05, 0.3
UNEVEN_FOCAL, OFF_CENTRE = 0.03, 0.15


def verdict_of(
    fit: LensFit, quality: LensQuality, outvoted: Sequence[str]
) -> tuple[Verdict, tuple[str, ...]]:
    """The verdict, and what to tell the user; `outvoted` are the pictures that were left out."""
    failures = [*_undetermined(quality), *_contradictions(fit)]
    doubts = [
        *_few(fit, outvoted),
        *_poor_pictures(quality),
        *_patterns(fit, quality),
        *_odd_lens(fit),
        *_loose(quality),
    ]
    if failures:
        return "failed", (*failures, *doubts)
    return ("weak" if doubts else "good"), tuple(doubts)


def _undetermined(quality: LensQuality) -> list[str]:
    sigmas = quality.sigmas()
    tilt = float(np.degrees(quality.tilts.max()))
    if sigmas is None:
        return [
            f"the pictures do not determine the lens (boards tilted up to {tilt:.0f} deg); tilt "
            "the board by 30 deg to all sides"
        ]
    share = sigmas["fx"] / quality.fit.lens.fx
    if share > FAILED_FOCAL:
        return [
            f"the focal length is known to {100 * share:.1f} % only (boards tilted up to "
            f"{tilt:.0f} deg); tilt the board by 30 deg to all sides"
        ]
    return []


def _contradictions(fit: LensFit) -> list[str]:
    failures = []
    if fit.rms_pixels > FAILED_RMS:
        failures.append(
            f"corners are {fit.rms_pixels:.1f} px (rms) from where they should be: is the board "
            "flat, its size right, and are all pictures from one lens and zoom?"
        )
    if fit.disagreement > FAILED_DISAGREEMENT:
        failures.append(_disagreement_told(fit))
    return failures


def _disagreement_told(fit: LensFit) -> str:
    return (
        f"the pictures pull at the lens {fit.disagreement:.1f} times as far as their corners' "
        "noise explains: are all from one lens, zoom and focus, is the board flat, and does the "
        f"model {fit.lens.distortion.model} fit this lens?"
    )


def _few(fit: LensFit, outvoted: Sequence[str]) -> list[str]:
    doubts = []
    if len(fit.views) < FEW_PICTURES:
        doubts.append(
            f"only {len(fit.views)} pictures were used; take at least {FEW_PICTURES}, 15 are better"
        )
    if 2 * len(outvoted) > len(fit.views):
        doubts.append(
            f"{len(outvoted)} of {len(fit.views) + len(outvoted)} pictures contradict the others; "
            "are all from one lens and zoom?"
        )
    if not fit.converged:
        doubts.append("the fit was still moving when it was stopped; try a smaller model")
    return doubts


def _poor_pictures(quality: LensQuality) -> list[str]:
    doubts = []
    tilt = float(np.degrees(quality.tilts.max()))
    if tilt < LEAST_TILT_DEGREES:
        doubts.append(
            f"no board is tilted more than {tilt:.0f} deg against the picture, so focal length and "
            "distance can hardly be told apart; tilt it by 30 deg to all sides"
        )
    if quality.covered < LEAST_COVERED:
        doubts.append(
            f"the boards cover {100 * quality.covered:.0f} % of the picture; hold the board in its "
            "corners too, or the distortion there is a guess"
        )
    ratio = float(quality.distances.max() / quality.distances.min())
    if ratio < LEAST_DISTANCE_RATIO:
        doubts.append(
            f"all boards are {quality.distances.min():.2f} to {quality.distances.max():.2f} m "
            "away; take some twice as far"
        )
    return doubts


def _patterns(fit: LensFit, quality: LensQuality) -> list[str]:
    doubts = []
    if fit.rms_pixels > WEAK_RMS:
        doubts.append(
            f"corners are {fit.rms_pixels:.2f} px (rms) from where they should be, 0.1 to 0.5 is "
            "usual: is the board flat, the focus sharp, the exposure short?"
        )
    if WEAK_DISAGREEMENT < fit.disagreement <= FAILED_DISAGREEMENT:
        doubts.append(_disagreement_told(fit))
    least = max(RING_PIXELS, RING_SHARE * fit.noise_pixels)
    for ring in quality.rings:
        if abs(ring.outward) > max(RING_SIGMAS * ring.sigma, least):
            doubts.append(
                f"corners {ring.inner:.0f} to {ring.outer:.0f} px from the middle all lie "
                f"{abs(ring.outward):.2f} px too far {'out' if ring.outward > 0 else 'in'}: the "
                f"model {fit.lens.distortion.model} does not fit this lens; try another"
            )
            break
    return doubts


def _odd_lens(fit: LensFit) -> list[str]:
    lens, doubts = fit.lens, []
    uneven = lens.fx / lens.fy - 1
    if abs(uneven) > UNEVEN_FOCAL:
        doubts.append(
            f"fx and fy differ by {100 * uneven:+.0f} %: were the pictures stretched, or are the "
            "board's squares not square?"
        )
    off = np.abs([lens.cx / (lens.width - 1) - 0.5, lens.cy / (lens.height - 1) - 0.5]).max()
    if off > OFF_CENTRE:
        doubts.append(
            f"the principal point is {100 * off:.0f} % of the picture off its middle: were the "
            "pictures cropped?"
        )
    if lens.distortion.model != "equidistant" and not images_corners(lens):
        doubts.append(
            "the lens found images nothing in the picture's corners; hold the board there too, or "
            "try --model equidistant"
        )
    return doubts


def _loose(quality: LensQuality) -> list[str]:
    sigmas = quality.sigmas()
    if sigmas is None:
        return []
    share = sigmas["fx"] / quality.fit.lens.fx
    if not WEAK_FOCAL < share <= FAILED_FOCAL:
        return []
    return [f"the focal length is known to {100 * share:.2f} % only; add tilted pictures"]
