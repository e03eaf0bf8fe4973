# SPDX-License-Identifier: GPL-3.0-or-later
"""A solid and names of its corners and centres in, those points with their derivatives out.

| kind | anchors |
|---|---|
| all | `centre` |
| all but the sphere | `base centre`, `top centre` |
| box | `x-y-base`, `x+y-base`, ... `x+y+top` |
| prism | `base0`, `base1`, ..., `top0`, ... |
| cone | `apex`, which is its `top centre` |
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from itertools import product

import numpy as np

from ..arrays import Array
from ..errors import InvalidValue

HEIGHTS = {"cylinder": 1, "cone": 2, "tube": 2, "prism": 0, "box": 2}


def anchors(kind: str, parameters: Array, names: Sequence[str]) -> tuple[Array, Array]:
    """Points (K, 3) in the solid's frame and their derivatives (K, 3, P) by its parameters.

    Every anchor is linear in the parameters. Raises InvalidValue for a name that is not there.
    """
    table = _table(kind, len(parameters))
    for name in names:
        if name not in table:
            raise InvalidValue(f"a {kind} has no point {name!r}; it has {', '.join(table)}")
    by = np.array([table[name] for name in names]).reshape(-1, 3, len(parameters))
    return by @ parameters, by


def anchor_names(kind: str, parameters: int) -> tuple[str, ...]:
    """The names of a solid with so many parameters."""
    return tuple(_table(kind, parameters))


@lru_cache(maxsize=64)
def _table(kind: str, count: int) -> dict[str, Array]:
    table = {"centre": np.zeros((3, count))}
    if kind in HEIGHTS:
        for name, side in (("base centre", -0.5), ("top centre", 0.5)):
            table[name] = np.zeros((3, count))
            table[name][2, HEIGHTS[kind]] = side
    if kind == "cone":
        table["apex"] = table["top centre"]
    if kind == "box":
        for signs in product((-1, 1), repeat=3):
            x, y, z = signs
            name = f"x{'+' if x > 0 else '-'}y{'+' if y > 0 else '-'}{'top' if z > 0 else 'base'}"
            table[name] = np.diag(np.array(signs) / 2)
    if kind == "prism":
        for (end, side), i in product((("base", -0.5), ("top", 0.5)), range((count - 1) // 2)):
            corner = np.zeros((3, count))
            corner[0, 1 + 2 * i] = corner[1, 2 + 2 * i] = 1.0
            corner[2, 0] = side
            table[f"{end}{i}"] = corner
    return table
