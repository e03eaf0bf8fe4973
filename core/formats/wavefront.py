# SPDX-License-Identifier: GPL-3.0-or-later
"""Solids that a format has no shape for: mesh files beside it, and where its pieces stand."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from ..pose import Pose
from ..primitives import Box, Cylinder, Primitive, Sphere
from ..shape.pieces import pieces_of
from ..shape.tessellation import Tessellation, tessellated
from .number_text import numbers

EXACT = (Box, Cylinder, Sphere)


@dataclass(frozen=True)
class SolidFiles:
    """The files of one solid by name: `visual` to look at, `pieces` (name, object_from_piece).

    The pieces are convex, and together never smaller than the solid.
    """

    visual: str
    pieces: tuple[tuple[str, Pose], ...]
    files: Mapping[str, str]


def solid_files(thing: Primitive, name: str, folder: str) -> SolidFiles:
    """The mesh files of a cone, tube or prism called `name`, in `folder` beside the document."""
    made = pieces_of(thing)
    names = [f"{folder}/{name}_piece{number}.obj" for number in range(len(made.shapes))]
    files = dict(zip(names, map(obj_text, made.shapes), strict=True))
    # no piece of another object is called so
    visual = f"{folder}/{name}_visual.obj"
    placed = tuple((names[number], pose) for number, pose in made.placed)
    return SolidFiles(visual, placed, {visual: obj_text(tessellated(thing))} | files)


def obj_text(shape: Tessellation) -> str:
    """The triangles as Wavefront OBJ, metres, z up."""
    lines = ["# metres, z up"]
    lines += [f"v {numbers(vertex)}" for vertex in shape.vertices]
    lines += [f"f {a} {b} {c}" for a, b, c in (shape.triangles + 1).tolist()]
    return "\n".join(lines) + "\n"
