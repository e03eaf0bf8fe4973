# SPDX-License-Identifier: GPL-3.0-or-later
"""One sketch in, the fitted object that its picks mean out, with the rivals that fit as well."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array
from ..camera import Camera
from ..errors import NotConverged, PickError
from ..primitives import Primitive
from ..sketch import Sketch
from .holding import References
from .model_fit import FittedObject, fit_model
from .pick_equations import pick_observer
from .pick_plan import PickPlan
from .pick_visibility import hidden_picks, hidden_warnings
from .rivals import doubt, far_picks
from .starts.start import start

# two fits whose chi squared differs by less than this, three sigma, are within each other's noise
WITHIN_NOISE = 9.0
# fits that agree to this share of their sizes are one and the same
SAME_SHARE = 1e-3


@dataclass(frozen=True, eq=False)
class Chosen:
    """The object that fits best, the plan of its picks, and what is doubtful already.

    `doubt` (6 + P, K) are motions of one sigma each towards rivals, None without any; the object's
    covariance holds them.
    """

    fitted: FittedObject
    plan: PickPlan
    warnings: tuple[str, ...]
    doubt: Array | None = None


@dataclass(frozen=True, eq=False)
class _Candidate:
    fitted: FittedObject
    chi_squared: float
    hidden: tuple[int, ...]
    far: int


def choose(
    camera: Camera,
    sketch: Sketch,
    references: References,
    things: Mapping[str, Primitive],
    pick_sigma_pixels: float,
) -> Chosen:
    """Fit every start of a sketch, held by what stands already, and choose.

    Of those within the noise of the best, the one is taken that hides the fewest of its own picks,
    then that has the fewest of its top rim on the far side. Others that hide no more are its
    rivals: the next is named, and the covariance reaches to all. Raises PickError naming object and
    pick, and what `fit_model` raises.
    """
    starts = start(camera, sketch, references, things, pick_sigma_pixels)
    found, refusals = [], []
    for thing in starts.things:
        try:
            found.append(_fitted(camera, thing, starts.plan, references, things))
        except (PickError, NotConverged) as error:
            refusals.append(error)
    if not found:
        raise refusals[0]
    found.sort(key=lambda c: c.chi_squared)
    scale = found[0].fitted.noise_scale
    good = [c for c in found if c.chi_squared <= found[0].chi_squared + WITHIN_NOISE * scale**2]
    # between perfect fits the larger is taken: its top picks are on the side facing the camera
    good.sort(key=lambda c: (len(c.hidden), c.far, round(c.chi_squared, 6), -_volume(c)))
    best = good[0]
    rivals = [c for c in good[1:] if len(c.hidden) == len(best.hidden) and not _same(c, best)]
    worse = [(c.fitted.thing, (c.chi_squared - best.chi_squared) / scale**2) for c in rivals]
    towards = doubt(best.fitted.thing, worse)
    hidden = hidden_warnings(best.fitted.thing, camera, starts.plan)
    doubts = (*starts.warnings, *_rival_doubts(best, rivals), *hidden)
    return Chosen(_doubted(best.fitted, towards), starts.plan, doubts, towards)


def _doubted(fitted: FittedObject, towards: Array | None) -> FittedObject:
    covariance = fitted.thing.covariance
    if towards is None or covariance is None:
        return fitted
    whole = replace(fitted.thing, covariance=covariance + towards @ towards.T)
    return replace(fitted, thing=whole)


def _fitted(
    camera: Camera,
    thing: Primitive,
    plan: PickPlan,
    references: References,
    things: Mapping[str, Primitive],
) -> _Candidate:
    others = [other for name, other in things.items() if name != thing.name]
    fit = fit_model(
        camera, references, [*others, thing], pick_observer({thing.name: plan}), [thing.name]
    )
    fitted = fit.objects[thing.name]
    hidden, far = hidden_picks(fitted.thing, camera, plan), far_picks(fitted.thing, camera, plan)
    return _Candidate(fitted, fit.chi_squared, hidden, far)


def _volume(one: _Candidate) -> float:
    return float(np.prod(2 * one.fitted.thing.half_extent))


def _same(one: _Candidate, other: _Candidate) -> bool:
    a, b = one.fitted.thing, other.fitted.thing
    size = float(np.abs(b.sizes).max())
    apart = np.abs(a.sizes - b.sizes).max()
    moved = np.abs(a.world_from_object.translation - b.world_from_object.translation).max()
    return bool(max(apart, moved) <= SAME_SHARE * size)


def _rival_doubts(best: _Candidate, rivals: list[_Candidate]) -> list[str]:
    if not rivals:
        return []
    thing, other = best.fitted.thing, rivals[0].fitted.thing
    return [
        f"{thing.name}: the picks fit two {thing.kind}s: {_sizes(thing)} (taken) and "
        f"{_sizes(other)}; its +/- reaches to both; {_settling(best, rivals[0])}"
    ]


def _settling(best: _Candidate, rival: _Candidate) -> str:
    if best.far < rival.far:
        return "add a pick to tell them apart: of the top rim, on its far side"
    return "add a pick to tell them apart"


def _sizes(thing: Primitive) -> str:
    told = [
        f"{name} {1e3 * size:.1f}" for name, size in zip(thing.size_names, thing.sizes, strict=True)
    ]
    return ", ".join(told) + " mm"
