# SPDX-License-Identifier: GPL-3.0-or-later
"""The equations of a relation, with their derivatives by what is held and by what holds it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array


@dataclass(frozen=True, eq=False)
class RelationRows:
    """Equations (M,), with derivatives (M, 6 + P) by the object, (M, T) by what it is held by.

    `by_about` (M, A) is the derivative by the plane of a symmetry, None without.
    """

    values: Array
    by_own: Array
    by_to: Array
    by_about: Array | None = None


def across_of(direction: Array) -> Array:
    """Two unit vectors (2, 3) at right angles to a direction and to each other."""
    one = np.cross(direction, np.eye(3)[int(np.argmin(np.abs(direction)))])
    one = one / np.linalg.norm(one)
    return np.stack([one, np.cross(direction, one)])
