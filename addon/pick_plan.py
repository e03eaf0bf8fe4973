# SPDX-License-Identifier: GPL-3.0-or-later
"""What has to be clicked to model a box or a cylinder, and the picks a document keeps of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..core.arrays import Array
from ..core.camera import Camera
from ..core.modelling.reverse_mapping import points_on_line_or_nan, points_on_plane_or_nan
from ..core.reference import ReferenceLine, ReferencePlane


@dataclass(frozen=True)
class PickPlan:
    """The clicks of one kind: `foot` on the reference in `prompts`, then one that sets the height.

    More than that one make the height surer. `flat` is the known size that stands for the height
    while there is none yet.
    """

    kind: str
    foot: str
    prompts: tuple[str, ...]
    flat: Mapping[str, float] = field(default_factory=dict)

    @property
    def clicks(self) -> int:
        """How many clicks finish it."""
        return len(self.prompts)

    @property
    def foot_clicks(self) -> int:
        """How many of them lie on the reference."""
        return self.clicks - 1


BOX = PickPlan(
    "box",
    "base",
    (
        "base corner 1 of 3",
        "base corner 2 of 3, next to the first",
        "base corner 3 of 3, going on round",
        "top corner, above any base corner",
    ),
    {"size_z": 1e-3},
)
CYLINDER = PickPlan(
    "cylinder",
    "rim",
    (
        "base rim, point 1 of 3",
        "base rim, point 2 of 3",
        "base rim, point 3 of 3, far from the others",
        "top rim, on the side that faces the camera",
    ),
    {"height": 1e-3},
)


def picks_of(
    plan: PickPlan, camera: Camera, plane: ReferencePlane, pixels: Sequence[Array]
) -> dict[str, list[Any]]:
    """The document's picks from clicked pixels (2,) of the picture as it came, in their order."""
    foot = [pixel.tolist() for pixel in pixels[: plan.foot_clicks]]
    picks: dict[str, list[Any]] = {plan.foot: foot}
    tops = pixels[plan.foot_clicks :]
    if tops and plan.kind == "box":
        # of two picks above one corner the later is meant
        above = {corner_below(camera, plane, np.array(foot), top): top.tolist() for top in tops}
        picks["top"] = [above.get(i) for i in range(4)]
    elif tops:
        picks["top"] = [top.tolist() for top in tops]
    return picks


def corner_below(camera: Camera, plane: ReferencePlane, base: Array, pixel: Array) -> int:
    """Which base corner a top pick (2,) belongs to: the one whose upright edge it lies nearest to.

    `base` (3, 2) are pixels of three corners in order; number 3 is the unseen fourth, opposite to
    number 1. When the pixel is above none of them the answer is the last picked, number 2.
    """
    first, second, third = points_on_plane_or_nan(camera, plane, base)
    corners = (first, second, third, first + third - second)
    distances = [_beside(camera, plane, corner, pixel) for corner in corners]
    if not np.isfinite(distances).any():
        return 2
    return int(np.nanargmin(distances))


def _beside(camera: Camera, plane: ReferencePlane, foot: Array, pixel: Array) -> float:
    """Pixels between a pick and the upright half-line above `foot`; NaN when it is below."""
    if not np.isfinite(foot).all():
        return np.nan
    upright = ReferenceLine("upright edge", foot, plane.normal)
    above = points_on_line_or_nan(camera, upright, pixel[None])
    if not (above[0] - foot) @ plane.normal > 0:
        return np.nan
    return float(np.linalg.norm(camera.project(above)[0] - pixel))
