# SPDX-License-Identifier: GPL-3.0-or-later
"""What pictures say of an object: residuals in pixels, and how they move with object and camera."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from ..arrays import Array
from ..camera import Camera
from .solid import Solid


@dataclass(frozen=True, eq=False)
class Observed:
    """Residuals (N,) in pixels, model minus picture, with 1 sigma (N,) each.

    `by_object` (N, 6 + P) is their derivative by the object's tangent, `by_camera` (N, 6) by the
    twist of the camera's pose. A residual that is NaN says that the object can't be seen so.
    """

    residuals: Array
    by_object: Array
    by_camera: Array
    sigma: Array


# what is seen of each object, by its name, for solids and a camera that are tried
Observe = Callable[[Mapping[str, Solid], Camera], Mapping[str, Observed]]
