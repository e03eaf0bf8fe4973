# SPDX-License-Identifier: GPL-3.0-or-later
"""Truth held against estimate: two cells of the same form in, errors beside their sigmas out."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from .arrays import Array
from .camera import Camera
from .cell import Cell
from .covariance import inverse_information
from .errors import InvalidValue
from .pose import Pose
from .primitives import KINDS, Primitive, Prism
from .same_solid import corner_errors, retold


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
    """Of an object: position (3,) in world axes, its sizes, and its axis' tilt in radians.

    Sizes are in the order of the truth's `size_names`. `rotation` is the angle of the whole
    rotation that is off, None for what shows no turn about its axis. `corners` (2 N,) are the
    distances of a prism's corners from the true ones, None where their number is another.
    """

    name: str
    kind: str
    position: Array
    position_sigma: Array | None
    sizes: Array
    true_sizes: Array
    size_sigma: Array | None
    tilt: float
    tilt_sigma: float | None = None
    rotation: float | None = None
    rotation_sigma: float | None = None
    corners: Array | None = None

    @property
    def size_names(self) -> tuple[str, ...]:
        return KINDS[self.kind].size_names


@dataclass(frozen=True, eq=False)
class Comparison:
    """All errors of a cell, and the objects that only one of the two has."""

    pose: PoseError | None
    objects: tuple[ObjectError, ...]
    missing: tuple[str, ...]
    surplus: tuple[str, ...]
    warnings: tuple[str, ...] = ()


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
        tuple(_other_corners(known, found)),
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
    """Estimate minus truth, however the estimate's frame lies in the same solid.

    Raises InvalidValue for two kinds.
    """
    if truth.kind != estimate.kind:
        raise InvalidValue(f"{truth.name}: a {truth.kind} in truth, a {estimate.kind} in the cell")
    told, sigma = retold(truth, estimate), estimate.size_sigma()
    corners = None
    if isinstance(truth, Prism) and isinstance(estimate, Prism):
        corners = corner_errors(truth, estimate)
    tilt_sigma, rotation_sigma = _turn_sigmas(estimate, told.axes[:, 2])
    return ObjectError(
        truth.name,
        truth.kind,
        estimate.world_from_object.translation - truth.world_from_object.translation,
        estimate.position_sigma(),
        estimate.sizes[told.order] - truth.sizes,
        truth.sizes,
        None if sigma is None else sigma[told.order],
        told.tilt,
        tilt_sigma,
        told.rotation,
        None if told.rotation is None else rotation_sigma,
        corners,
    )


def _other_corners(known: Mapping[str, Primitive], found: Mapping[str, Primitive]) -> Iterator[str]:
    for name, thing in found.items():
        truth = known.get(name)
        if isinstance(thing, Prism) and isinstance(truth, Prism):
            counts = len(thing.polygon), len(truth.polygon)
            if counts[0] != counts[1]:
                yield f"{name}: has {counts[0]} corners, the true one {counts[1]}: not matched"


def _turn_sigmas(estimate: Primitive, axis: Array) -> tuple[float | None, float | None]:
    """1 sigma of the axis' tilt, and of the whole rotation, in radians."""
    if estimate.covariance is None:
        return None, None
    covariance = estimate.covariance[:3, :3]
    whole = float(np.trace(covariance))
    across = whole - float(axis @ covariance @ axis)
    return float(np.sqrt(max(0.0, across))), float(np.sqrt(whole))


def _twist(motion: Pose) -> Array:
    """The left perturbation that `motion` is, to first order in its rotation."""
    return np.concatenate([motion.rotation_vector(), motion.translation])
