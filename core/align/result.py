# SPDX-License-Identifier: GPL-3.0-or-later
"""What an alignment found of each object, and whether it believes itself."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from ..primitives import Primitive


@dataclass(frozen=True, eq=False)
class AlignedObject:
    """One object: `thing` is the aligned one where it is believed, else as it was given.

    - `tried`: the object where the edges put it, believed or not; None where there are none
    - `moved_pixels`: how far its visible edges were moved by that, rms
    - `before_pixels`: how far its visible edges were from those of the picture, rms
    - `rms_pixels`, `median_pixels`: how far they are now, where there is an edge
    - `supported`: the share of its visible outline that lies on edges
    - `reasons`: why it is not believed; `warnings`: what else is doubtful
    """

    thing: Primitive
    tried: Primitive | None
    believed: bool
    reasons: tuple[str, ...]
    moved_pixels: float = 0.0
    before_pixels: float = 0.0
    rms_pixels: float = 0.0
    median_pixels: float = 0.0
    supported: float = 0.0
    warnings: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Aligned:
    """All objects in the order given, as they are now, and what was found of those aligned."""

    things: tuple[Primitive, ...]
    objects: Mapping[str, AlignedObject]
    warnings: tuple[str, ...] = ()
