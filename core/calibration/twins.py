# SPDX-License-Identifier: GPL-3.0-or-later
"""The same thing told or seen twice: sightings and outlines in, which of them repeat others out."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from ..arrays import Array
from ..ball.outline import SphereOutline
from ..pose import Pose
from ..sighting import PointSighting, Sighting

SAME_PLACE = 1e-6
# outlines nearer than this share of a radius are one
SAME_SHARE = 0.3


def told_twice(sightings: Sequence[Sighting]) -> dict[int, int]:
    """Sightings that repeat an earlier one, picture, place and all: later index to earlier."""
    repeated: dict[int, int] = {}
    by_picture: dict[str, list[int]] = {}
    for i, sighting in enumerate(sightings):
        known = by_picture.setdefault(sighting.picture, [])
        twin = next((k for k in known if _same(sightings[k], sighting)), None)
        if twin is None:
            known.append(i)
        else:
            repeated[i] = twin
    return repeated


def has_twins(
    sightings: Sequence[Sighting],
    outlines: Sequence[SphereOutline | None],
    duplicates: dict[int, int],
) -> bool:
    """Whether one outline of a picture stands for two sightings that mean different balls."""
    by_picture: dict[str, list[SphereOutline]] = {}
    for i, (sighting, outline) in enumerate(zip(sightings, outlines, strict=True)):
        if outline is not None and i not in duplicates:
            by_picture.setdefault(sighting.picture, []).append(outline)
    return any(
        same_outline(one, other)
        for listed in by_picture.values()
        for one, other in combinations(listed, 2)
    )


def same_outline(one: SphereOutline, other: SphereOutline) -> bool:
    """Whether two outlines of one picture are the same thing in it, at whatever depth."""
    rays, sizes = [], []
    for outline in (one, other):
        distance = float(np.linalg.norm(outline.centre_camera))
        rays.append(outline.centre_camera / distance)
        sizes.append(outline.radius / distance)
    return bool(np.linalg.norm(rays[0] - rays[1]) < SAME_SHARE * max(sizes))


def _same(one: Sighting, other: Sighting) -> bool:
    if isinstance(one, PointSighting) or isinstance(other, PointSighting):
        # a point clicked twice is measured twice
        return False
    return (
        one.target == other.target
        and _near(one.center_world, other.center_world)
        and _near(_matrix(one.world_from_flange), _matrix(other.world_from_flange))
    )


def _near(one: Array | None, other: Array | None) -> bool:
    if one is None or other is None:
        return one is other
    return bool(np.abs(one - other).max() < SAME_PLACE)


def _matrix(pose: Pose | None) -> Array | None:
    return None if pose is None else pose.matrix()
