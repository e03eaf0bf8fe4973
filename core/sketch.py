# SPDX-License-Identifier: GPL-3.0-or-later
"""An object that has been picked in the picture but not solved yet."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from .appearance import Appearance
from .arrays import positive
from .errors import InvalidValue
from .primitives import Box, Cylinder, Picks, Primitive

KINDS: dict[str, type[Primitive]] = {"box": Box, "cylinder": Cylinder}


@dataclass(frozen=True, eq=False)
class Sketch:
    """What the operator said of an object: its kind, its reference, pixels, and known sizes.

    `known` maps size names (`height`, `radius`, `size_z`, ...) to metres that were measured or
    typed and are not to be solved for.
    """

    name: str
    kind: str
    on: str
    picks: Picks
    known: Mapping[str, float] = field(default_factory=dict)
    appearance: Appearance | None = None

    def __post_init__(self) -> None:
        if self.kind not in KINDS:
            raise InvalidValue(f"{self.name}: kind {self.kind!r} is none of {', '.join(KINDS)}")
        sizes = KINDS[self.kind].size_names
        for size, value in self.known.items():
            if size not in sizes:
                raise InvalidValue(
                    f"{self.name}: a {self.kind} has no size {size!r}; it has {', '.join(sizes)}"
                )
            positive(value, f"{self.name}: known {size}")

    @staticmethod
    def of(thing: Primitive) -> Sketch:
        """The sketch a solved object came from, to solve it again after a better calibration.

        Raises InvalidValue for an object without picks or reference.
        """
        if thing.on is None or not thing.picks:
            raise InvalidValue(f"{thing.name}: has no picks on a reference to be solved from")
        return Sketch(thing.name, thing.kind, thing.on, thing.picks, thing.known, thing.appearance)
