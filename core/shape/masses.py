# SPDX-License-Identifier: GPL-3.0-or-later
"""What objects weigh: their motion and exact volume in, kilograms and what was assumed out."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..arrays import Array
from ..composite import Composite
from ..errors import InvalidValue
from ..primitives import Primitive
from .mass import volume

# water: right to a factor of three for most things that a robot moves
DEFAULT_DENSITY = 1000.0


def masses(
    things: Sequence[Primitive], composites: Sequence[Composite] = ()
) -> tuple[Array, tuple[str, ...]]:
    """The mass of each object in kg, (N,), and the names of those whose density was assumed.

    An object's own mass or density comes first, then those of its composite, whose mass is shared
    out by volume; what says neither has the density of water, `DEFAULT_DENSITY`.

    Raises InvalidValue for a mass of a composite whose parts have masses of their own.
    """
    found = np.full(len(things), np.nan)
    volumes = np.array([volume(thing) for thing in things])
    index = {thing.name: i for i, thing in enumerate(things)}
    for i, thing in enumerate(things):
        if thing.motion.mass is not None:
            found[i] = thing.motion.mass
        elif thing.motion.density is not None:
            found[i] = thing.motion.density * volumes[i]
    for composite in composites:
        parts = [index[part] for part in composite.parts]
        if composite.motion.density is not None:
            open_ones = [i for i in parts if np.isnan(found[i])]
            found[open_ones] = composite.motion.density * volumes[open_ones]
        if composite.motion.mass is not None:
            weighed = [things[i].name for i in parts if not np.isnan(found[i])]
            if weighed:
                raise InvalidValue(
                    f"{composite.name}: motion.mass is that of all its parts, and {weighed[0]} has "
                    "a mass of its own; leave one of the two"
                )
            found[parts] = composite.motion.mass * volumes[parts] / volumes[parts].sum()
    unknown = np.isnan(found)
    found[unknown] = DEFAULT_DENSITY * volumes[unknown]
    return found, tuple(
        thing.name for thing, assumed in zip(things, unknown, strict=True) if assumed
    )
