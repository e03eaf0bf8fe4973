# SPDX-License-Identifier: GPL-3.0-or-later
"""How far the surface of a modelled object may lie from where it is drawn, from its covariance."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np

from ...core.arrays import Array
from ...core.covariance import propagated
from ...core.errors import InvalidValue
from ...core.primitives import Box, Cone, Cylinder, Primitive, Prism, Sphere, Tube
from ...core.rotation import hat

RIM_POINTS, BALL_POINTS = 16, 200


def uncertainty_margins(objects: Iterable[Primitive], sigmas: float = 3.0) -> Mapping[str, float]:
    """`surface_margin` of each object by its name, 0 where no covariance is known."""
    return {
        thing.name: 0.0 if thing.covariance is None else surface_margin(thing, sigmas)
        for thing in objects
    }


def surface_margin(thing: Primitive, sigmas: float = 3.0) -> float:
    """`sigmas` times the largest 1 sigma, in any direction, of any edge point of the object (m).

    A point at `r` from the object's origin moves by `rotation vector x r + translation + how the
    sizes move it`. What moves most of a box or prism is a corner, of what is round a point of its
    rims; a turn that leaves the surface where it was (about its own axis) counts for nothing.
    Raises InvalidValue for an object without covariance.
    """
    if thing.covariance is None:
        raise InvalidValue(f"{thing.name}: has no covariance to make a margin from")
    offsets, by_sizes = _edge_points(thing)
    rotation = thing.world_from_object.rotation
    turned = thing.world_from_object.rotate(offsets)
    moved = np.broadcast_to(np.eye(3), (len(turned), 3, 3))
    by_turning = -hat(turned) @ _felt(thing, rotation[:, 2])
    jacobian = np.concatenate([by_turning, moved, rotation @ by_sizes], axis=2)
    spread = np.linalg.eigvalsh(propagated(jacobian, thing.covariance))
    return sigmas * float(np.sqrt(max(0.0, spread.max())))


def _felt(thing: Primitive, axis: Array) -> Array:
    """The part (3, 3) of a rotation vector that moves the surface, and not only along itself."""
    if isinstance(thing, Sphere):
        return np.zeros((3, 3))
    if isinstance(thing, Cylinder | Cone | Tube):
        return np.eye(3) - np.outer(axis, axis)
    return np.eye(3)


def _edge_points(thing: Primitive) -> tuple[Array, Array]:
    """Points (N, 3) in the object's frame, and their derivative by the parameters (N, 3, P)."""
    if isinstance(thing, Box):
        signs = np.array([[i >> axis & 1 for axis in range(3)] for i in range(8)]) * 2.0 - 1.0
        return signs * thing.half_extent, signs[:, :, None] * np.eye(3) / 2
    if isinstance(thing, Prism):
        return _prism_corners(thing)
    if isinstance(thing, Sphere):
        out = _directions()
        return out * thing.radius, out[:, :, None]
    rims = {
        "cylinder": (("radius", -0.5), ("radius", 0.5)),
        "cone": (("radius", -0.5), ("top_radius", 0.5)),
        "tube": (
            ("radius", -0.5),
            ("radius", 0.5),
            ("inner_radius", -0.5),
            ("inner_radius", 0.5),
        ),
    }
    if thing.kind not in rims:
        raise InvalidValue(f"{thing.name}: the margin of a {thing.kind} is not known")
    found = [_rim(thing, name, side) for name, side in rims[thing.kind]]
    return np.concatenate([p for p, _ in found]), np.concatenate([by for _, by in found])


def _rim(thing: Primitive, radius_name: str, side: float) -> tuple[Array, Array]:
    """Points of the rim at `side` times the height."""
    names, sizes = list(thing.size_names), thing.sizes
    angle = np.arange(RIM_POINTS) * 2 * np.pi / RIM_POINTS
    out = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    up = np.tile([0.0, 0.0, side], (RIM_POINTS, 1))
    derivative = np.zeros((RIM_POINTS, 3, len(names)))
    derivative[:, :, names.index(radius_name)] = out
    derivative[:, :, names.index("height")] = up
    points = out * sizes[names.index(radius_name)] + up * sizes[names.index("height")]
    return points, derivative


def _prism_corners(prism: Prism) -> tuple[Array, Array]:
    """All corners; a corner's own parameters move it, the frame being held."""
    count = len(prism.polygon)
    points, derivative = [], np.zeros((2 * count, 3, 1 + 2 * count))
    for k, side in enumerate((-0.5, 0.5)):
        points.append(np.column_stack([prism.polygon, np.full(count, side * prism.height)]))
        for i in range(count):
            derivative[k * count + i, 2, 0] = side
            derivative[k * count + i, [0, 1], [1 + 2 * i, 2 + 2 * i]] = 1.0
    return np.concatenate(points), derivative


def _directions() -> Array:
    """Unit vectors (N, 3) spread evenly over the ball (Fibonacci lattice)."""
    i = np.arange(BALL_POINTS) + 0.5
    height, turn = 1 - 2 * i / BALL_POINTS, np.pi * (1 + 5**0.5) * i
    level = np.sqrt(1 - height**2)
    return np.stack([level * np.cos(turn), level * np.sin(turn), height], axis=1)
