# SPDX-License-Identifier: GPL-3.0-or-later
"""What has to be clicked to model a solid, and the picks a document keeps of the clicks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

from ...core.arrays import Array
from ...core.camera import Camera
from ...core.modelling.reverse_mapping import points_on_line_or_nan, points_on_plane_or_nan
from ...core.reference import Reference, ReferenceLine, ReferencePlane
from ...core.relation import Relation

Held = Literal["stands", "lies", "floats"]
Taken = Sequence[tuple[str, Array]]
# solids whose picks are corners, each known by its place in the list
CORNERED = ("box", "prism")


@dataclass(frozen=True)
class Stage:
    """The clicks for one role of the document's picks.

    `prompts` say what each click that is needed is for; `more` what further ones are, made with
    Shift, up to `most`. `sets` are the sizes that the role tells: the stage is not needed where all
    of them are known already. A `closing` stage takes any number, until it is closed.
    """

    role: str
    prompts: tuple[str, ...]
    more: str
    sets: tuple[str, ...] = ()
    most: int = 99
    closing: bool = False


@dataclass(frozen=True)
class PickPlan:
    """The clicks for one kind of solid, in order, and how it is held by the active reference.

    `flat` is a kind and known sizes that stand for the solid once its first stage is full.
    """

    kind: str
    stages: tuple[Stage, ...]
    held: Held = "stands"
    known: Mapping[str, float] = field(default_factory=dict)
    flat: tuple[str, Mapping[str, float]] | None = None

    def stage_of(self, role: str) -> Stage | None:
        """The stage of a role, None where the plan has none."""
        return next((stage for stage in self.stages if stage.role == role), None)

    def holding(self, reference: Reference | None) -> tuple[str | None, tuple[Relation, ...]]:
        """What the object's `on` and relations are. Only a ball is held by a line: it touches."""
        if reference is None or self.held == "floats":
            return None, ()
        if isinstance(reference, ReferenceLine):
            return None, (Relation("touches", reference.name),)
        lying = (Relation("lies_on", reference.name),)
        return reference.name, lying if self.held == "lies" else ()


def picks_of(
    plan: PickPlan, camera: Camera, reference: Reference | None, taken: Taken
) -> dict[str, list[Any]]:
    """The document's picks from clicks: a role and a pixel (2,) of the picture as it came each."""
    picks: dict[str, list[Any]] = {}
    for role, pixel in taken:
        picks.setdefault(role, []).append(pixel.tolist())
    if plan.kind not in CORNERED or "top" not in picks:
        return picks
    base = np.array(picks["base"])
    count = 4 if plan.kind == "box" else len(base)
    # of two picks above one corner the later is meant
    above = {
        corner_below(camera, reference, base, np.array(top), count): top for top in picks["top"]
    }
    return picks | {"top": [above.get(i) for i in range(count)]}


def corner_below(
    camera: Camera, plane: Reference | None, base: Array, pixel: Array, count: int
) -> int:
    """Which base corner a top pick (2,) belongs to: the one whose upright edge it lies nearest to.

    `base` (N, 2) are pixels of corners in order; the fourth of a box may be unseen: it is opposite
    to the second. When the pixel is above none of them the answer is the last picked.
    """
    last = len(base) - 1
    if not isinstance(plane, ReferencePlane):
        return last
    corners = list(points_on_plane_or_nan(camera, plane, base))
    if len(corners) == 3 and count == 4:
        corners.append(corners[0] + corners[2] - corners[1])
    distances = [_beside(camera, plane, corner, pixel) for corner in corners]
    if not np.isfinite(distances).any():
        return last
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
