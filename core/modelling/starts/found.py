# SPDX-License-Identifier: GPL-3.0-or-later
"""Guesses of a solid in, the objects that a fit starts from out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...arrays import Array
from ...errors import InvalidValue
from ...pose import Pose
from ...primitives import KINDS, Primitive, polygon_centre
from ...reference import ReferencePlane
from ...sketch import Sketch
from ..pick_plan import PickPlan
from .held import Grip, Held
from .trials import Trials

# guesses whose misfit is beyond this many times the best's are no rivals
RIVAL_FACTOR = 2.0
RIVAL_NOISE = 16.0
MOST_RIVALS = 4


@dataclass(frozen=True, eq=False)
class Starts:
    """The objects worth fitting, the likeliest first, and what each pick of them means.

    All are near to the picks and to what holds them, none is exact. `warnings` tell of picks that
    are doubtful whatever the fit makes of them.
    """

    things: tuple[Primitive, ...]
    plan: PickPlan
    warnings: tuple[str, ...] = ()


def known_parameters(sketch: Sketch, held: Held) -> dict[int, float]:
    """The parameters that are not to be solved, by index: typed sizes and those shared."""
    known: dict[int, float] = {}
    for relation, other, _ in held.others:
        if relation.kind != "same_size":
            continue
        if relation.own is None and len(other.parameters) == held.parameters:
            known |= dict(enumerate(map(float, other.parameters)))
        elif relation.own in sketch_sizes(sketch) and relation.own in other.size_names:
            value = other.sizes[other.size_names.index(relation.own)]
            known[sketch_sizes(sketch).index(relation.own)] = float(value)
    typed = {sketch_sizes(sketch).index(name): value for name, value in sketch.known.items()}
    return known | typed


def sketch_sizes(sketch: Sketch) -> tuple[str, ...]:
    """The names of the sizes of a sketch's kind."""
    return KINDS[sketch.kind].size_names


def things_of(
    sketch: Sketch, trials: Trials, known: Mapping[str, float] | None = None
) -> tuple[Primitive, ...]:
    """The guesses as objects that keep all that the operator said.

    Raises InvalidValue where none of them can be.
    """
    found, refusals = [], []
    for i in range(len(trials)):
        shape = trials.rotation[i], trials.place[i], trials.parameters[i]
        try:
            found.append(_thing(sketch, *shape, known or {}))
        except InvalidValue as error:
            refusals.append(error)
    if refusals and not found:
        raise refusals[0]
    return tuple(found)


def rivals(trials: Trials, costs: Array, sigma_pixels: float) -> Trials:
    """Of guesses, best first, those that fit about as well as the best."""
    within = RIVAL_FACTOR * costs[0] + RIVAL_NOISE * sigma_pixels**2
    return trials.chosen(np.flatnonzero(costs <= within)[:MOST_RIVALS])


def plane_of(grip: Grip) -> ReferencePlane:
    """What holds an object as a reference plane, for its messages and its frame."""
    return ReferencePlane(grip.name, grip.to.point, grip.to.direction)


def _thing(
    sketch: Sketch, rotation: Array, place: Array, parameters: Array, known: Mapping[str, float]
) -> Primitive:
    shape: dict[str, Any] = {}
    if sketch.kind == "box":
        shape["size"] = parameters
    elif sketch.kind == "prism":
        polygon = parameters[1:].reshape(-1, 2)
        middle = polygon_centre(polygon)
        place = place + rotation[:, :2] @ middle
        shape |= {"height": float(parameters[0]), "polygon": polygon - middle}
    else:
        sizes = zip(sketch_sizes(sketch), map(float, parameters), strict=True)
        shape |= dict(sizes)
    return KINDS[sketch.kind](
        sketch.name,
        Pose(rotation, place),
        on=sketch.on,
        relations=sketch.relations,
        picks=sketch.picks,
        known={**sketch.known, **known},
        appearance=sketch.appearance,
        motion=sketch.motion,
        **shape,
    )
