# SPDX-License-Identifier: GPL-3.0-or-later
"""An object that has been picked in the picture but not solved yet."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from .appearance import Appearance
from .arrays import positive
from .errors import InvalidValue
from .motion import Motion
from .primitives import KINDS, Picks, Primitive
from .relation import Relation


@dataclass(frozen=True, eq=False)
class Sketch:
    """What the operator said of an object: its kind, what holds it, pixels, and known sizes.

    `on` names the reference it stands on, None where other `relations` (or, of a ball, its known
    radius alone) give its place. `known` maps size names (`height`, `radius`, `size_z`, ...) to
    metres that were measured or typed and are not to be solved for.
    """

    name: str
    kind: str
    on: str | None
    picks: Picks
    known: Mapping[str, float] = field(default_factory=dict)
    appearance: Appearance | None = None
    relations: tuple[Relation, ...] = ()
    motion: Motion = field(default_factory=Motion)

    def __post_init__(self) -> None:
        if self.kind not in KINDS:
            raise InvalidValue(f"{self.name}: kind {self.kind!r} is none of {', '.join(KINDS)}")
        sizes = KINDS[self.kind].size_names
        for size, value in self.known.items():
            if size not in sizes:
                raise InvalidValue(
                    f"{self.name}: a {self.kind} has no size {size!r}; it has {', '.join(sizes)}"
                )
            # a cone that is known to end in a point
            if (self.kind, size, value) != ("cone", "top_radius", 0):
                positive(value, f"{self.name}: known {size}")

    @staticmethod
    def of(thing: Primitive) -> Sketch:
        """The sketch a solved object came from, to solve it again after a better calibration.

        Raises InvalidValue for an object without picks.
        """
        if not thing.picks:
            raise InvalidValue(f"{thing.name}: has no picks to be solved from")
        return Sketch(
            thing.name,
            thing.kind,
            thing.on,
            thing.picks,
            thing.known,
            thing.appearance,
            thing.relations,
            thing.motion,
        )
