# SPDX-License-Identifier: GPL-3.0-or-later
"""A cell to a MoveIt planning scene, `.scene`: the text that RViz loads for its motion planning.

An object is its name, its pose (x y z, then a quaternion x y z w), its shapes each with a pose and
a colour, and its subframes (moveit_core/planning_scene/src/planning_scene.cpp); a cylinder or cone
is radius, then length (geometric_shapes/src/shape_operations.cpp).
"""

from __future__ import annotations

import numpy as np

from ..cell import Cell
from ..pose import Pose
from ..primitives import Box, Cone, Cylinder, Primitive, Sphere
from ..rotation import quaternion_from_rotation
from ..shape.pieces import pieces_of
from ..shape.tessellation import Tessellation
from .identifiers import identifiers
from .number_text import numbers, rgba
from .written import Written


def moveit_scene(cell: Cell, name: str, folder: str) -> Written:
    """The planning scene called `name`; one file, nothing goes into `folder`."""
    lines = [name]
    names = identifiers([thing.name for thing in cell.objects])
    for thing, own in zip(cell.objects, names, strict=True):
        shapes = _shapes(thing)
        lines += [f"* {own}", *_pose(thing.world_from_object), str(len(shapes))]
        for shape, object_from_shape in shapes:
            lines += [*shape, *_pose(object_from_shape), rgba(thing.appearance)]
        # no subframes
        lines.append("0")
    moving = [thing.name for thing in cell.objects if thing.motion.kind != "static"]
    told = f"{', '.join(moving)}: stands fixed in a planning scene, which holds no joints"
    return Written("\n".join([*lines, "."]) + "\n", {}, (told,) if moving else ())


def _shapes(thing: Primitive) -> list[tuple[list[str], Pose]]:
    """The lines of each shape, and where it stands in the object's frame."""
    here = Pose.identity()
    if isinstance(thing, Box):
        return [(["box", numbers(thing.size)], here)]
    if isinstance(thing, Sphere):
        return [(["sphere", numbers([thing.radius])], here)]
    if isinstance(thing, Cylinder):
        return [(["cylinder", numbers([thing.radius, thing.height])], here)]
    if isinstance(thing, Cone) and thing.top_radius == 0:
        return [(["cone", numbers([thing.radius, thing.height])], here)]
    made = pieces_of(thing)
    meshes = [_mesh(shape) for shape in made.shapes]
    return [(meshes[number], pose) for number, pose in made.placed]


def _mesh(shape: Tessellation) -> list[str]:
    triangles = shape.triangles
    lines = ["mesh", f"{len(shape.vertices)} {len(triangles)}"]
    lines += [numbers(vertex) for vertex in shape.vertices]
    return lines + [f"{a} {b} {c}" for a, b, c in triangles.tolist()]


def _pose(pose: Pose) -> list[str]:
    w, x, y, z = quaternion_from_rotation(pose.rotation)
    return [numbers(pose.translation), numbers(np.array([x, y, z, w]))]
