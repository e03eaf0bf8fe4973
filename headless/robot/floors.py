# SPDX-License-Identifier: GPL-3.0-or-later
"""The floor of an exported environment: the scene's extras in, a slab the arm stays out of out."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ...core.document.reference_entries import reference_from_entry
from ...core.pose import Pose
from ...core.primitives import Box
from ...core.reference import ReferencePlane

# a slab this large is under all that an arm reaches
SIDE, THICKNESS = 4.0, 0.05
# planes steeper than this are walls, which things may lean on without filling the room behind
LEVEL = 0.999


def floor_of(extras: Mapping[str, Any]) -> Box | None:
    """The first level plane among the environment's references as a box, its top in the plane.

    None without one. Raises DocumentError when the references can't be read.
    """
    for i, entry in enumerate(extras.get("references", ())):
        plane = reference_from_entry(entry, f"references[{i}]")
        if isinstance(plane, ReferencePlane) and plane.normal[2] > LEVEL:
            middle = plane.point - np.array([0, 0, THICKNESS / 2])
            size = np.array([SIDE, SIDE, THICKNESS])
            return Box(plane.name, Pose(np.eye(3), middle), size=size)
    return None
