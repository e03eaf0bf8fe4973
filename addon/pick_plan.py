# SPDX-License-Identifier: GPL-3.0-or-later
"""What has to be clicked to model an object of each kind, and the picks a document keeps of it.

A way to pick a kind is data: a `PickPlan`, and an operator in `operators/` that names it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..core.arrays import Array
from ..core.camera import Camera
from ..core.modelling.reverse_mapping import points_on_line_or_nan, points_on_plane_or_nan
from ..core.reference import ReferenceLine, ReferencePlane

# pixels (2,) of one role
Pixels = Sequence[Array]
Gather = Callable[[Camera, ReferencePlane, Sequence[Pixels]], list[Any]]


@dataclass(frozen=True)
class PickStep:
    """Picks of one role: `least` are needed, `most` can be given, None for any number.

    `prompts` say what each is for, the last also what all further ones are. Picks that lie
    `on_reference` are told in metres; with the first of the others the object takes its size.
    """

    role: str
    prompts: tuple[str, ...]
    least: int
    most: int | None
    on_reference: bool = True

    def prompt(self, count: int) -> str:
        """What the next pick is for, after `count` of them."""
        return self.prompts[min(count, len(self.prompts) - 1)]


@dataclass(frozen=True)
class PickPlan:
    """The steps of one kind, in order. `flat` are known sizes that stand in before the last step.

    `gather` makes the document's list of the last step's role from the pixels of all steps, where
    that is not simply the list of them.
    """

    kind: str
    steps: tuple[PickStep, ...]
    flat: Mapping[str, float] = field(default_factory=dict)
    gather: Gather | None = None

    def picks(
        self, camera: Camera, plane: ReferencePlane, pixels: Sequence[Pixels]
    ) -> dict[str, list[Any]]:
        """The document's picks from the pixels clicked in each step, in their order."""
        picks: dict[str, list[Any]] = {}
        for step, clicked in zip(self.steps, pixels, strict=True):
            if clicked or step.on_reference:
                picks[step.role] = [pixel.tolist() for pixel in clicked]
        last = self.steps[-1].role
        if self.gather is not None and last in picks:
            picks[last] = self.gather(camera, plane, pixels)
        return picks


def tops_of_box(camera: Camera, plane: ReferencePlane, pixels: Sequence[Pixels]) -> list[Any]:
    """A box's `top` as a document has it: for each base corner the pick above it, or null."""
    base, tops = np.array(pixels[0]), pixels[1]
    first, second, third = points_on_plane_or_nan(camera, plane, base)
    corners = np.array([first, second, third, first + third - second])
    return _above(camera, plane, corners, tops, unsure=2)


def tops_of_prism(camera: Camera, plane: ReferencePlane, pixels: Sequence[Pixels]) -> list[Any]:
    """A prism's `top`: for each base corner the pick above it, or null."""
    corners = points_on_plane_or_nan(camera, plane, np.array(pixels[0]))
    return _above(camera, plane, corners, pixels[1], unsure=len(corners) - 1)


def corner_below(
    camera: Camera, plane: ReferencePlane, corners: Array, pixel: Array, unsure: int
) -> int:
    """Which of the base corners (N, 3) a top pick (2,) belongs to.

    That of the upright edge next to it; when the pixel is above none of them, `unsure`.
    """
    distances = [_beside(camera, plane, corner, pixel) for corner in corners]
    if not np.isfinite(distances).any():
        return unsure
    return int(np.nanargmin(distances))


def _above(
    camera: Camera, plane: ReferencePlane, corners: Array, tops: Pixels, unsure: int
) -> list[Any]:
    # of two picks above one corner the later is meant
    above = {corner_below(camera, plane, corners, top, unsure): top.tolist() for top in tops}
    return [above.get(i) for i in range(len(corners))]


def _beside(camera: Camera, plane: ReferencePlane, foot: Array, pixel: Array) -> float:
    """Pixels between a pick and the upright half-line above `foot`; NaN when it is below."""
    if not np.isfinite(foot).all():
        return np.nan
    upright = ReferenceLine("upright edge", foot, plane.normal)
    above = points_on_line_or_nan(camera, upright, pixel[None])
    if not (above[0] - foot) @ plane.normal > 0:
        return np.nan
    return float(np.linalg.norm(camera.project(above)[0] - pixel))


RIM = PickStep(
    "rim",
    (
        "base rim, point 1 of 3",
        "base rim, point 2 of 3",
        "base rim, point 3 of 3, far from the others",
    ),
    3,
    3,
)
BOX = PickPlan(
    "box",
    (
        PickStep(
            "base",
            (
                "base corner 1 of 3",
                "base corner 2 of 3, next to the first",
                "base corner 3 of 3, going on round",
            ),
            3,
            3,
        ),
        PickStep(
            "top",
            ("top corner, above any base corner", "another top corner, or Enter"),
            1,
            None,
            False,
        ),
    ),
    {"size_z": 1e-3},
    tops_of_box,
)
CYLINDER = PickPlan(
    "cylinder",
    (
        RIM,
        PickStep(
            "top",
            ("top rim, on the side that faces the camera", "another point of the top, or Enter"),
            1,
            None,
            False,
        ),
    ),
    {"height": 1e-3},
)
CONE = PickPlan(
    "cone", (RIM, PickStep("apex", ("the apex",), 1, 1, False)), {"height": 1e-3, "top_radius": 0.0}
)
FRUSTUM = PickPlan(
    "cone",
    (
        RIM,
        PickStep(
            "top",
            (
                "top rim, point 1 of 3",
                "top rim, point 2 of 3",
                "top rim, point 3 of 3",
                "another point of the top rim, or Enter",
            ),
            3,
            None,
            False,
        ),
    ),
)
TUBE = PickPlan(
    "tube",
    (
        RIM,
        PickStep("top", ("top outer rim, on the side that faces the camera",), 1, 1, False),
        PickStep(
            "hole",
            ("rim of the hole, at the top", "another point of the hole's rim, or Enter"),
            1,
            None,
            False,
        ),
    ),
)
PRISM = PickPlan(
    "prism",
    (
        PickStep(
            "base",
            (
                "base corner 1",
                "base corner 2, next to the first",
                "base corner 3, going on round",
                "another base corner; Enter ends the base",
            ),
            3,
            None,
        ),
        PickStep(
            "top",
            ("top corner, above any base corner", "another top corner, or Enter"),
            1,
            None,
            False,
        ),
    ),
    {"height": 1e-3},
    tops_of_prism,
)
SPHERE = PickPlan(
    "sphere",
    (
        PickStep(
            "outline",
            (
                "outline, point 1 of 3",
                "outline, point 2 of 3",
                "outline, point 3 of 3, far from the others",
                "another point of the outline, or Enter",
            ),
            3,
            None,
            False,
        ),
    ),
)
