# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that no picks place in, moved as little as keeps their relations to others out."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

import numpy as np

from ..arrays import Array
from ..camera import Camera
from ..pose import Pose
from ..primitives import Primitive
from .holding import References, holds_of
from .model_fit import fit_model
from .observed import Observe, Observed
from .solid import Solid

# relations that are off by less than this (metres, or sines) hold
HOLDS = 1e-9
# a size gives way a thousand times less easily than a place
PLACE_SIGMA, SIZE_SIGMA = 1e-3, 1e-6


def followed(
    camera: Camera,
    references: References,
    things: Sequence[Primitive],
    solved: Sequence[str],
    held: Collection[str] = (),
) -> tuple[Primitive, ...]:
    """All objects, those without picks that stand on or hang on others moved after these.

    `solved` are the names of those that picks have placed. An object that is held by references
    alone stays where it was put, unless it is one of `held`, as does one whose relations hold. What
    moves keeps its covariance. Raises NotConverged for relations that contradict each other.
    """
    now = {thing.name: thing for thing in things}
    for name in [thing.name for thing in things if thing.name not in solved]:
        if not _is_off(now[name], references, now, by_all=name in held):
            continue
        before = now[name]
        now[name] = _of_its_size(before)
        stay = _staying(name, Solid.of(before))
        moved = fit_model(camera, references, tuple(now.values()), stay, [name]).objects[name].thing
        now[name] = replace(
            moved, known=before.known, covariance=before.covariance, by_camera=before.by_camera
        )
    return tuple(now.values())


def _of_its_size(thing: Primitive) -> Primitive:
    """With its sizes held, unless a relation is about them."""
    if any(relation.kind in ("same_size", "symmetric") for relation in thing.relations):
        return thing
    return replace(thing, known=dict(zip(thing.size_names, map(float, thing.sizes), strict=True)))


def _is_off(
    thing: Primitive, references: References, things: Mapping[str, Primitive], *, by_all: bool
) -> bool:
    """Whether a relation to another object, or with `by_all` to anything, does not hold."""
    holds = holds_of(thing, references, list(things))
    return any(
        float(np.abs(hold.rows(things, references).values).max(initial=0.0)) > HOLDS
        for hold in holds
        if by_all or any(target.is_object for target in hold.targets)
    )


def _staying(name: str, start: Solid) -> Observe:
    """As if the object had been seen where it is: it moves no farther than it has to."""
    sigma = np.array([PLACE_SIGMA] * 6 + [SIZE_SIGMA] * len(start.parameters))

    def observe(solids: Mapping[str, Solid], camera: Camera) -> Mapping[str, Observed]:
        solid = solids[name]
        return {
            name: Observed(
                _apart(solid, start), np.eye(len(sigma)), np.zeros((len(sigma), 6)), sigma
            )
        }

    return observe


def _apart(solid: Solid, start: Solid) -> Array:
    turned = Pose(solid.rotation @ start.rotation.T, np.zeros(3)).rotation_vector()
    return np.concatenate([turned, solid.place - start.place, solid.parameters - start.parameters])
