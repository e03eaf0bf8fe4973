# SPDX-License-Identifier: GPL-3.0-or-later
"""What a virtual environment file holds for the robot: exact objects, meshes, and what was odd."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.arrays import Array, frozen
from ...core.composite import Composite
from ...core.errors import InvalidValue
from ...core.primitives import Primitive


@dataclass(frozen=True, eq=False)
class WorldMesh:
    """Triangles standing in the world, z up: `vertices` (N, 3) in metres, `faces` (M, 3)."""

    name: str
    vertices: Array
    faces: NDArray[np.int64]

    def __post_init__(self) -> None:
        vertices = frozen(self.vertices, (None, 3), f"{self.name}: vertices")
        faces = np.array(self.faces, dtype=np.int64)
        if faces.ndim != 2 or faces.shape[1] != 3 or len(faces) == 0:
            raise InvalidValue(f"{self.name}: faces: expected shape (M, 3), got {faces.shape}")
        if faces.min() < 0 or faces.max() >= len(vertices):
            raise InvalidValue(
                f"{self.name}: faces: vertex {faces.max()} is asked for, there are {len(vertices)}"
            )
        faces.setflags(write=False)
        object.__setattr__(self, "vertices", vertices)
        object.__setattr__(self, "faces", faces)


@dataclass(frozen=True, eq=False)
class Environment:
    """Exact `objects`, their `composites`, `meshes` of nodes without exact shape, and `extras`.

    `extras` is what the exporter wrote into the scene, the camera among it, unchecked.
    """

    objects: tuple[Primitive, ...]
    meshes: tuple[WorldMesh, ...] = ()
    extras: Mapping[str, Any] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()
    composites: tuple[Composite, ...] = ()
