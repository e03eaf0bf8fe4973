# SPDX-License-Identifier: GPL-3.0-or-later
"""An alignment or proposals in, candidates that a person takes or leaves out."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...core.align.propose import Proposal
from ...core.align.result import AlignedObject
from ...core.arrays import Array
from ...core.camera import Camera
from ...core.primitives import Primitive
from ...core.shape.hits import hits
from ..lengths import length


@dataclass(frozen=True, eq=False)
class Candidate:
    """An object as it would be, and as it is.

    - `before`: None for an object that is not there yet; `after`: None where nothing was found
    - `taken`: whether it becomes what it would be; `free`: whether a person may choose
    - `told`: what would change; `reasons`: why it is not believed
    - `moved`: how far its visible edges would move, rms pixels; None for what is new
    """

    before: Primitive | None
    after: Primitive | None
    taken: bool
    free: bool
    told: str
    reasons: tuple[str, ...] = ()
    moved: float | None = None

    @property
    def shown(self) -> Primitive:
        """Where it would stand, or else stands."""
        thing = self.after or self.before
        assert thing is not None
        return thing

    @property
    def name(self) -> str:
        return self.shown.name


@dataclass(frozen=True, eq=False)
class Offer:
    """Candidates, each taken or left."""

    candidates: tuple[Candidate, ...]

    @property
    def taken(self) -> tuple[Primitive, ...]:
        """The objects as they would be, of the candidates that are taken."""
        return tuple(one.after for one in self.candidates if one.taken and one.after is not None)

    @property
    def open(self) -> bool:
        """Whether there is anything to choose."""
        return any(one.free for one in self.candidates)

    def toggled(self, index: int) -> Offer:
        """With one candidate taken that was left, or left that was taken, if it is free."""
        one = self.candidates[index]
        turned = replace(one, taken=one.taken != one.free)
        return Offer((*self.candidates[:index], turned, *self.candidates[index + 1 :]))

    def at(self, camera: Camera, pixel: Array) -> int | None:
        """The candidate that a pixel (2,) of the picture shows, the nearest to the camera."""
        origin, rays = camera.rays_world(np.asarray(pixel, dtype=float)[None])
        depths = [float(hits(one.shown, origin, rays).depth[0]) for one in self.candidates]
        if not np.isfinite(depths).any():
            return None
        return int(np.nanargmin(depths))


def offer_of_aligned(
    given: Iterable[Primitive], found: dict[str, AlignedObject], unit: str
) -> Offer:
    """What an alignment would change: the believed ones are taken."""
    return Offer(
        tuple(
            Candidate(
                thing,
                found[thing.name].tried,
                found[thing.name].believed,
                found[thing.name].believed,
                _change(thing, found[thing.name], unit),
                found[thing.name].reasons,
                found[thing.name].moved_pixels,
            )
            for thing in given
            if thing.name in found
        )
    )


def offer_of_proposals(proposals: Sequence[Proposal], doubtful: bool, unit: str) -> Offer:
    """What may stand there: the believed ones are taken, with `doubtful` the others as well."""

    def candidate(one: Proposal) -> Candidate:
        taken = one.believed or doubtful
        return Candidate(None, one.thing, taken, True, _sizes(one.thing, unit), one.reasons)

    return Offer(tuple(candidate(one) for one in proposals))


def _change(before: Primitive, found: AlignedObject, unit: str) -> str:
    if found.tried is None:
        return ""
    place = found.tried.world_from_object.translation - before.world_from_object.translation
    away = length(float(np.linalg.norm(place)), unit)
    return f"{found.moved_pixels:.1f} px, centre {away}"


def _sizes(thing: Primitive, unit: str) -> str:
    return f"{thing.kind} " + " × ".join(length(float(size), unit) for size in thing.sizes)
