# SPDX-License-Identifier: GPL-3.0-or-later
"""A solid's kind, its parameters and an eye point in, its edges and exact silhouettes out."""

from __future__ import annotations

from collections.abc import Callable

from ..arrays import Array
from ..camera import Camera
from ..primitives import Primitive
from .curve_set import CurveSet
from .flat_solids import box_curves, prism_curves
from .round_solids import cone_curves, cylinder_curves, sphere_curves, tube_curves

CURVES: dict[str, Callable[[Array, Array], CurveSet]] = {
    "box": box_curves,
    "cylinder": cylinder_curves,
    "sphere": sphere_curves,
    "cone": cone_curves,
    "tube": tube_curves,
    "prism": prism_curves,
}


def curves(kind: str, parameters: Array, eye: Array) -> CurveSet:
    """All curves of a solid with `parameters` (P,), seen from `eye` (3,), in its own frame."""
    return CURVES[kind](parameters, eye)


def curves_seen(thing: Primitive, camera: Camera) -> CurveSet:
    """The curves of an object as a camera sees them, in the object's frame. Raises NoPose."""
    eye = thing.world_from_object.inverse().apply(camera.centre_world)
    return curves(thing.kind, thing.parameters, eye)
