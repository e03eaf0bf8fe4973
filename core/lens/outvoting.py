# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures that contradict the others: a fit of all in, a fit of those that agree out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..errors import InvalidValue
from .bundle import LensFit, fit_lens, fit_pose, subset

# a picture whose corners are this many times as far off as the median picture's is looked at
SUSPICIOUS, OUTVOTED = 2.5, 3.0
# and only from so many pixels on: in clean pictures a small difference is none
SMALLEST_RMS = 0.15
# all pictures may be spoiled by one
POOR_RMS = 1.0
FEWEST = 3
# leaving one more out helps no longer when the noise falls by less than this factor
NO_BETTER = 1.5
MOST_TRIED_TOGETHER = 12


def outvoted(fit: LensFit) -> tuple[LensFit, dict[int, float]]:
    """The fit of the pictures that agree, and the rms of each that does not, by its place.

    Pictures are left out one by one, the worst first (of a dozen or fewer, the one whose absence
    helps most), until leaving out more no longer helps; those that then agree come back. At most
    half can be outvoted.
    """
    rms = fit.rms_of_views
    limit = max(SUSPICIOUS * float(np.median(rms)), SMALLEST_RMS)
    if len(rms) <= FEWEST or (rms.max() < limit and fit.rms_pixels < POOR_RMS):
        return fit, {}
    path = _path(fit)
    last = path[-1][1].noise_pixels
    kept, closer = next(
        (k, f) for k, f in path if f.noise_pixels <= max(NO_BETTER * last, SMALLEST_RMS)
    )
    off = _rms_of_absent(fit, closer, kept)
    border = max(OUTVOTED * float(np.median(closer.rms_of_views)), SMALLEST_RMS)
    out = {i: value for i, value in off.items() if value > border}
    if len(out) < len(off):
        everyone = [i for i in range(len(fit.views)) if i not in out]
        closer = fit_lens(subset(_with_lens(fit, closer), everyone))
    return closer, out


def _path(fit: LensFit) -> list[tuple[tuple[int, ...], LensFit]]:
    """Nested sets of pictures, each with its fit, from all down to half of them."""
    kept, path = tuple(range(len(fit.views))), [(tuple(range(len(fit.views))), fit)]
    while len(kept) > max(FEWEST, (len(fit.views) + 1) // 2):
        now = path[-1][1]
        worst = np.argsort(-now.rms_of_views)
        count = 3 if len(kept) <= MOST_TRIED_TOGETHER else 1
        tried = []
        for place in worst[:count]:
            rest = [i for i in range(len(kept)) if i != place]
            try:
                closer = fit_lens(subset(now, rest), steps=25)
            except InvalidValue:
                continue
            tried.append((tuple(kept[i] for i in rest), closer))
        if not tried:
            break
        kept, best = min(tried, key=lambda one: one[1].noise_pixels)
        path.append((kept, best))
    return path


def _rms_of_absent(fit: LensFit, closer: LensFit, kept: Sequence[int]) -> dict[int, float]:
    """How well the pictures that were left out agree with the lens of the others."""
    off = {}
    for i in sorted(set(range(len(fit.views))) - set(kept)):
        pose = fit_pose(closer.lens, fit.views[i], fit.poses[i])
        off[i] = LensFit(closer.lens, (pose,), (fit.views[i],)).rms_pixels
        off[i] = off[i] if np.isfinite(off[i]) else float("inf")
    return off


def _with_lens(fit: LensFit, closer: LensFit) -> LensFit:
    poses = [fit_pose(closer.lens, v, p) for v, p in zip(fit.views, fit.poses, strict=True)]
    return replace(fit, lens=closer.lens, poses=tuple(poses))
