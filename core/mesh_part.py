# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh file standing somewhere: how the links of a robot arm reach a renderer."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from .arrays import Array, frozen
from .pose import Pose


@dataclass(frozen=True, eq=False)
class MeshPart:
    """An OBJ or STL file, its `scale` (3,), `color` (3,) in linear light, and where it stands."""

    path: Path
    world_from_mesh: Pose
    scale: Array
    color: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "scale", frozen(self.scale, (3,), "scale"))
        object.__setattr__(self, "color", frozen(self.color, (3,), "color"))
