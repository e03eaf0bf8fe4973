# SPDX-License-Identifier: GPL-3.0-or-later
"""Poses into Blender's matrices, and an object's place back as pose and scale."""

from __future__ import annotations

from typing import Any

import numpy as np
from mathutils import Matrix

from ..core.arrays import Array
from ..core.errors import InvalidValue
from ..core.pose import Pose

# float32 matrices are orthogonal to about 1e-7; a shear that matters is far above this
SHEAR_TOLERANCE = 1e-4


def matrix_of(pose: Pose) -> Matrix:
    """The pose as Blender's 4x4 matrix (float32)."""
    return Matrix(pose.matrix().tolist())


def stand(ob: Any, world_from_object: Pose) -> None:
    """Place an object, its scale exactly 1 (Blender's own decomposition is 6e-8 off).

    It stays with its parent. What the parent's own place and scale do to it goes into its parent
    inverse, so that it stands there upright even under a parent that would shear it.
    """
    matrix = matrix_of(world_from_object)
    if ob.parent is None:
        ob.matrix_world = matrix
    elif _hung_on_object(ob):
        ob.matrix_parent_inverse = Matrix(np.linalg.inv(world_matrix(ob.parent)).tolist())
        ob.matrix_basis = matrix
    else:
        ob.matrix_world = matrix
        return
    ob.scale = (1.0, 1.0, 1.0)


def world_matrix(ob: Any) -> Array:
    """Where an object stands now, (4, 4).

    From the matrices of its own and its parents' location, rotation and scale, which are up to date
    at once; `matrix_world` waits for the next evaluation of the scene. It is taken where only that
    can tell: for constraints, and parents that are bones or vertices.
    """
    if ob.constraints or not (ob.parent is None or _hung_on_object(ob)):
        return np.array(ob.matrix_world, dtype=float)
    own = np.array(ob.matrix_basis, dtype=float)
    if ob.parent is None:
        return own
    return world_matrix(ob.parent) @ np.array(ob.matrix_parent_inverse, dtype=float) @ own


def pose_and_scale(ob: Any, mirror_axis: int = 2) -> tuple[Pose, Array]:
    """An object's pose and its scale (3,) along its own axes, always positive.

    A mirrored object has its axis `mirror_axis` turned round, along which its shape has to be its
    own mirror image: z (2) of all but cones, x (0) of all but prisms.
    Raises InvalidValue for a shear, or a scale of zero.
    """
    matrix = world_matrix(ob)
    columns = matrix[:3, :3]
    scale = np.linalg.norm(columns, axis=0)
    if (scale < 1e-9).any():
        raise InvalidValue(f"{ob.name}: a scale of zero leaves no shape; set its scale again")
    axes = columns / scale
    shear = float(np.abs(axes.T @ axes - np.eye(3)).max())
    if shear > SHEAR_TOLERANCE:
        raise InvalidValue(
            f"{ob.name}: sheared by {shear:.2g} (a turned object under a scaled parent); "
            "clear its parent or apply the parent's scale"
        )
    if np.linalg.det(axes) < 0:
        axes[:, mirror_axis] *= -1
    return Pose(axes, matrix[:3, 3]), scale


def _hung_on_object(ob: Any) -> bool:
    """Whether the parent is an object as a whole; a curve may carry its children along itself."""
    return ob.parent_type == "OBJECT" and ob.parent.type != "CURVE"
