# SPDX-License-Identifier: GPL-3.0-or-later
"""Which distortion model the pictures ask for: each one's fit in, its error on unseen corners out.

Cross-validation: a lens is fitted to some pictures and foretells corners of the others. A model
with too few coefficients misses; one with too many foretells worse than it fits.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array, Mask
from ..errors import InvalidValue
from .bundle import LensFit, fit_lens, fit_pose, subset
from .parameters import images_corners
from .view import BoardView

# in the order in which the earlier is taken when both foretell as well
MODELS = ("none", "plumb_bob", "equidistant", "rational_polynomial")
FOLDS = 5
FOLD_STEPS = 25
# a difference of the squared error below this part of it is no difference
EQUAL = 0.1
# and a lens that folds back inside the picture has to be better by this factor of the rms
FOLDED = 1.25


@dataclass(frozen=True, eq=False)
class ModelScore:
    """A model's fit, and its error on corners of pictures it never saw.

    `unseen` (V,) are the mean squared errors of each picture, in square pixels.
    """

    fit: LensFit
    unseen: Array

    @property
    def model(self) -> str:
        """The distortion model."""
        return self.fit.lens.distortion.model

    @property
    def name(self) -> str:
        """The model, and what of it is not solved for."""
        return f"{self.model}, k3 = 0" if self.fit.held else self.model

    @property
    def coefficients(self) -> int:
        """How many coefficients were solved for."""
        return len(self.fit.lens.distortion.coefficients) - len(self.fit.held)

    @property
    def rms_pixels(self) -> float:
        """On the corners it was fitted to."""
        return self.fit.rms_pixels

    @property
    def whole(self) -> bool:
        """Whether the lens images something in all four corners of the picture."""
        return images_corners(self.fit.lens)

    @property
    def unseen_rms_pixels(self) -> float:
        """The root of the mean over the pictures."""
        return float(np.sqrt(self.unseen.mean()))


def score(fit: LensFit) -> ModelScore:
    """The error of the fit's model on corners that it was not fitted to."""
    count = len(fit.views)
    folds = min(FOLDS, count)
    unseen = np.full(count, np.inf)
    for fold in range(folds):
        rest = [i for i in range(count) if i % folds != fold]
        try:
            lens = fit_lens(subset(fit, rest), steps=FOLD_STEPS).lens
        except InvalidValue:
            continue
        for i in range(fold, count, folds):
            unseen[i] = _unseen_square(replace(fit, lens=lens), i)
    return ModelScore(fit, unseen)


def best_model(scores: Sequence[ModelScore]) -> ModelScore:
    """The first in order of `MODELS` that foretells unseen corners as well as the best one.

    As well: within one standard error of the pictures' differences, or 5 % of the rms. A lens that
    folds back inside the picture was mostly bent by noise: one that does not comes before it,
    unless it foretells much worse.
    """
    ordered = sorted(scores, key=lambda one: (MODELS.index(one.model), one.coefficients))
    best = min(ordered, key=lambda one: one.unseen_rms_pixels)
    whole = [one for one in ordered if one.whole]
    if whole and not best.whole:
        instead = min(whole, key=lambda one: one.unseen_rms_pixels)
        if instead.unseen_rms_pixels <= FOLDED * best.unseen_rms_pixels:
            ordered, best = whole, instead
    elif whole:
        ordered = whole
    return next(one for one in ordered if one is best or _as_good(one, best))


def _as_good(one: ModelScore, best: ModelScore) -> bool:
    if not np.isfinite(one.unseen).all():
        return False
    more = one.unseen - best.unseen
    error = float(more.std(ddof=1) / np.sqrt(len(more)))
    return float(more.mean()) <= max(error, EQUAL * float(best.unseen.mean()))


def _unseen_square(fit: LensFit, i: int) -> float:
    """The mean squared error of one picture's corners; each half places the board for the other."""
    halves = np.arange(len(fit.views[i].numbers)) % 2 == 0
    total = 0.0
    for known in (halves, ~halves):
        pose = fit_pose(fit.lens, _part(fit.views[i], known), fit.poses[i])
        told = LensFit(fit.lens, (pose,), (_part(fit.views[i], ~known),))
        total += 0.5 * told.rms_pixels**2
    return total if np.isfinite(total) else float("inf")


def _part(view: BoardView, which: Mask) -> BoardView:
    return replace(view, numbers=view.numbers[which], pixels=view.pixels[which])
