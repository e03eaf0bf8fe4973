# SPDX-License-Identifier: GPL-3.0-or-later
"""A fitted object and its picks in, what a user is told of it out: residuals and doubts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..primitives import Primitive
from .model_fit import FittedObject
from .pick_plan import PickPlan

# a size whose 1 sigma is beyond this share of it deserves a word
DOUBTFUL_SHARE = 0.1


@dataclass(frozen=True, eq=False)
class Modelled:
    """A solved object, how far each pick is from it in pixels, and what is doubtful.

    `residual_pixels` (N,) follow the picks of `labels`: distances for corners, signed distances for
    curves. `rms_pixels` is their root mean square.
    """

    object: Primitive
    residual_pixels: Array
    rms_pixels: float
    warnings: tuple[str, ...] = ()
    labels: tuple[str, ...] = ()


def modelled(fitted: FittedObject, plan: PickPlan, more: Sequence[str] = ()) -> Modelled:
    """What is told of a fit; `more` are doubts that others have already."""
    corners = 2 * len(plan.anchors)
    residuals = fitted.observed.residuals
    away = np.linalg.norm(residuals[:corners].reshape(-1, 2), axis=1)
    distances = np.concatenate([away, residuals[corners:]])
    return Modelled(
        fitted.thing,
        distances,
        rms(distances),
        (*more, *_doubts(fitted, plan, distances)),
        plan.labels,
    )


def _doubts(fitted: FittedObject, plan: PickPlan, distances: Array) -> list[str]:
    thing, told = fitted.thing, []
    if not fitted.settled:
        told.append(f"{thing.name}: the fit had not settled when its steps ran out")
    if fitted.noise_scale > 1.0 and len(distances):
        worst = int(np.argmax(np.abs(distances)))
        told.append(
            f"{thing.name}: the picks miss the {thing.kind} by {rms(distances):.1f} px rms, more "
            f"than {plan.sigma_pixels:g} px of pick noise explain; the worst is "
            f"{plan.labels[worst]} with {abs(distances[worst]):.1f} px"
        )
    sigmas = thing.size_sigma()
    if sigmas is not None:
        told += [
            f"{thing.name}: {size} {1e3 * value:.1f} mm is only known to {1e3 * sigma:.1f} mm"
            for size, value, sigma in zip(thing.size_names, thing.sizes, sigmas, strict=True)
            if sigma > DOUBTFUL_SHARE * value
        ]
    return told


def rms(values: Array) -> float:
    """Root mean square, 0 for none."""
    return float(np.sqrt(np.mean(values**2))) if len(values) else 0.0
