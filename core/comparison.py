# SPDX-License-Identifier: GPL-3.0-or-later
"""Truth held against estimate: two cells of the same form in, errors beside their sigmas out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .arrays import Array
from .camera import Camera
from .cell import Cell
from .covariance import inverse_information
from .errors import InvalidValue
from .pose import Pose
from .primitives import Box, Primitive


@dataclass(frozen=True, eq=False)
class PoseError:
    """Of a camera: centre (3,) in world axes, metres, and rotation (3,) about the camera's axes.

    Sigmas are those the estimate states, None where it states none. `mahalanobis` is the error in
    stated sigmas over all six numbers; its square is chi-squared with 6 degrees of freedom. It is
    None where some direction is stated to be exact.
    """

    centre: Array
    centre_sigma: Array | None
    rotation: Array
    rotation_sigma: Array | None
    mahalanobis: float | None


@dataclass(frozen=True, eq=False)
class ObjectError:
    """Of an object: position (3,) in world axes, its sizes, and its axis' tilt in radians."""

    name: str
    kind: str
    position: Array
    position_sigma: Array | None
    sizes: Array
    true_sizes: Array
    size_sigma: Array | None
    tilt: float


@dataclass(frozen=True, eq=False)
class Comparison:
    """All errors of a cell, and the objects that only one of the two has."""

    pose: PoseError | None
    objects: tuple[ObjectError, ...]
    missing: tuple[str, ...]
    surplus: tuple[str, ...]


def compare_cells(truth: Cell, estimate: Cell) -> Comparison:
    """Hold an estimate against the truth; objects are matched by name.

    Raises InvalidValue when an object is of another kind than its namesake.
    """
    known = {thing.name: thing for thing in truth.objects}
    found = {thing.name: thing for thing in estimate.objects}
    pose = None
    if truth.camera.camera_from_world is not None and estimate.camera.camera_from_world is not None:
        pose = pose_error(truth.camera, estimate.camera)
    return Comparison(
        pose,
        tuple(object_error(known[name], thing) for name, thing in found.items() if name in known),
        tuple(name for name in known if name not in found),
        tuple(name for name in found if name not in known),
    )


def pose_error(truth: Camera, estimate: Camera) -> PoseError:
    """Estimate minus truth. Raises NoPose when a camera has none."""
    twist = _twist(estimate.pose @ truth.pose.inverse())
    information = None
    if estimate.covariance is not None:
        information = inverse_information(estimate.covariance)
    return PoseError(
        estimate.centre_world - truth.centre_world,
        estimate.centre_sigma(),
        twist[:3],
        estimate.rotation_sigma(),
        None if information is None else float(np.sqrt(twist @ information @ twist)),
    )


def object_error(truth: Primitive, estimate: Primitive) -> ObjectError:
    """Estimate minus truth; a box may have been seen with x and y exchanged."""
    if truth.kind != estimate.kind:
        raise InvalidValue(f"{truth.name}: a {truth.kind} in truth, a {estimate.kind} in the cell")
    order = _matching_sizes(truth, estimate)
    sigma, axis = estimate.size_sigma(), estimate.world_from_object.rotation[:, 2]
    upright = float(abs(axis @ truth.world_from_object.rotation[:, 2]))
    return ObjectError(
        truth.name,
        truth.kind,
        estimate.world_from_object.translation - truth.world_from_object.translation,
        estimate.position_sigma(),
        estimate.sizes[order] - truth.sizes,
        truth.sizes,
        None if sigma is None else sigma[order],
        float(np.arccos(np.clip(upright, -1, 1))),
    )


def _matching_sizes(truth: Primitive, estimate: Primitive) -> list[int]:
    if not isinstance(truth, Box):
        return list(range(len(truth.sizes)))
    turned = abs(
        estimate.world_from_object.rotation[:, 0] @ truth.world_from_object.rotation[:, 1]
    ) > abs(estimate.world_from_object.rotation[:, 0] @ truth.world_from_object.rotation[:, 0])
    return [1, 0, 2] if turned else [0, 1, 2]


def _twist(motion: Pose) -> Array:
    """The left perturbation that `motion` is, to first order in its rotation."""
    return np.concatenate([motion.rotation_vector(), motion.translation])
