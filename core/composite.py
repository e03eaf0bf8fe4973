# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that belong together: an arm of its links, a pallet of its boards."""

from __future__ import annotations

from dataclasses import dataclass, field

from .errors import InvalidValue
from .motion import Motion


@dataclass(frozen=True, eq=False)
class Composite:
    """A named group of the objects `parts`, by name.

    A `static` composite says only that its parts belong together; each moves as it says itself. The
    parts of a `movable` or `attached` one are one rigid body, less those that hang on a hinge or
    slider of their own. Its `mass` is that of all parts together, its `density` that of each which
    gives neither. The joint of an attached one is in the frame of the first part of that body.

    Raises InvalidValue for no parts, or one named twice.
    """

    name: str
    parts: tuple[str, ...]
    motion: Motion = field(default_factory=Motion)

    def __post_init__(self) -> None:
        if not self.name:
            raise InvalidValue("name: a composite needs a name that is not empty")
        object.__setattr__(self, "parts", tuple(self.parts))
        if not self.parts:
            raise InvalidValue(f"{self.name}: parts: a composite needs one object at least")
        twice = [part for i, part in enumerate(self.parts) if part in self.parts[:i]]
        if twice:
            raise InvalidValue(f"{self.name}: parts: {twice[0]!r} is named twice")
