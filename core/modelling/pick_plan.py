# SPDX-License-Identifier: GPL-3.0-or-later
"""What each pick of an object means: a named corner, or a point somewhere on named curves."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ..arrays import Array


@dataclass(frozen=True, eq=False)
class PickPlan:
    """Pixels (K, 2) of named `anchors`, and pixels (L, 2) that lie on one of some curves.

    `curves[i]` names the curves (of `core.shape.curves`) that pixel i may lie on: the nearest is
    meant. `labels` name the picks for messages, points first: `block: base[2]`. `sigma_pixels` is
    1 sigma of a pick in u and in v.
    """

    points: Array = field(default_factory=lambda: np.zeros((0, 2)))
    anchors: tuple[str, ...] = ()
    on_curves: Array = field(default_factory=lambda: np.zeros((0, 2)))
    curves: tuple[tuple[str, ...], ...] = ()
    labels: tuple[str, ...] = ()
    sigma_pixels: float = 1.0

    @property
    def equations(self) -> int:
        """How many equations the picks give: two a point, one a curve."""
        return 2 * len(self.anchors) + len(self.curves)
