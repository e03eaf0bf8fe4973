# SPDX-License-Identifier: GPL-3.0-or-later
"""How far the surface of a modelled object may lie from where it is drawn, from its covariance."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np

from ...core.arrays import Array
from ...core.covariance import propagated
from ...core.errors import InvalidValue
from ...core.primitives import Box, Cylinder, Primitive
from ...core.rotation import hat

RIM_POINTS = 16


def uncertainty_margins(objects: Iterable[Primitive], sigmas: float = 3.0) -> Mapping[str, float]:
    """`surface_margin` of each object by its name, 0 where no covariance is known."""
    return {
        thing.name: 0.0 if thing.covariance is None else surface_margin(thing, sigmas)
        for thing in objects
    }


def surface_margin(thing: Primitive, sigmas: float = 3.0) -> float:
    """`sigmas` times the largest 1 sigma, in any direction, of any edge point of the object (m).

    A point at `r` from the object's centre moves by `rotation vector x r + translation + how the
    sizes move it`. What moves most of a box is a corner, of a cylinder a point of its rims.
    Raises InvalidValue for an object without covariance.
    """
    if thing.covariance is None:
        raise InvalidValue(f"{thing.name}: has no covariance to make a margin from")
    offsets, by_sizes = _edge_points(thing)
    turned = thing.world_from_object.rotate(offsets)
    moved = np.broadcast_to(np.eye(3), (len(turned), 3, 3))
    sized = thing.world_from_object.rotation @ by_sizes
    jacobian = np.concatenate([-hat(turned), moved, sized], axis=2)
    spread = np.linalg.eigvalsh(propagated(jacobian, thing.covariance))
    return sigmas * float(np.sqrt(max(0.0, spread.max())))


def _edge_points(thing: Primitive) -> tuple[Array, Array]:
    """Points (N, 3) in the object's frame, and their derivative by the sizes (N, 3, sizes)."""
    if isinstance(thing, Box):
        signs = np.array([[i >> axis & 1 for axis in range(3)] for i in range(8)]) * 2.0 - 1.0
        return signs * thing.half_extent, signs[:, :, None] * np.eye(3) / 2
    if isinstance(thing, Cylinder):
        angle = np.repeat(np.arange(RIM_POINTS) * 2 * np.pi / RIM_POINTS, 2)
        out = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
        up = np.zeros_like(out)
        up[:, 2] = np.tile([-0.5, 0.5], RIM_POINTS)
        return out * thing.radius + up * thing.height, np.stack([out, up], axis=2)
    raise InvalidValue(f"{thing.name}: the margin of a {thing.kind} is not known; give one by hand")
