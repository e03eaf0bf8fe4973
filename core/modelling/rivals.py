# SPDX-License-Identifier: GPL-3.0-or-later
"""The object taken and others that its picks fit as well in, how far off it may therefore be out.

Which of two is meant, no least squares can tell: a pick of the far circle may lie on its near or
its far side. What an object states of its own error then reaches to both.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..arrays import Array
from ..camera import Camera
from ..pose import Pose
from ..primitives import Primitive
from .pick_plan import PickPlan

# the likelier of two may still not be meant: the other stays within two sigma of what is stated
LEAST_SHARE = 0.25
ROUND_KINDS = ("cylinder", "cone", "tube")
AROUND = np.linspace(-np.pi, np.pi, 360, endpoint=False)


def far_picks(thing: Primitive, camera: Camera, plan: PickPlan) -> int:
    """How many picks of the top rim of a round solid that stands lie on the half facing away.

    A hand begins where a rim is in front of it. 0 for all others. Raises NoPose.
    """
    picked = [i for i, names in enumerate(plan.curves) if "top rim" in names]
    stands = thing.on is not None or any(r.kind == "stands_on" for r in thing.relations)
    if thing.kind not in ROUND_KINDS or not stands or not picked:
        return 0
    eye = thing.world_from_object.inverse().apply(camera.centre_world)
    angles = np.arctan2(eye[1], eye[0]) + AROUND
    radius = float(getattr(thing, "top_radius", thing.sizes[0]))
    level = np.full(len(angles), thing.half_extent[2])
    rim = np.column_stack([radius * np.cos(angles), radius * np.sin(angles), level])
    image = camera.project(thing.world_from_object.apply(rim))
    away = np.linalg.norm(plan.on_curves[picked][:, None] - image, axis=2)
    nearest = np.where(np.isnan(away), np.inf, away).argmin(axis=1)
    return int((np.abs(AROUND[nearest]) > np.pi / 2).sum())


def doubt(thing: Primitive, rivals: Sequence[tuple[Primitive, float]]) -> Array | None:
    """Motions (6 + P, K) of one sigma each by which an object may be one of its rivals, or None.

    `rivals` are objects with how much less than `thing` each fits, by chi squared. One of
    probability p adds p d d^T to the covariance, d the way to it: the second moment about what was
    taken.
    """
    if not rivals:
        return None
    ways = [np.sqrt(_share(worse)) * _way(thing, other) for other, worse in rivals]
    return np.stack(ways, axis=1)


def _share(worse: float) -> float:
    """The probability of a rival beside the one taken, by their likelihoods."""
    return max(float(1 / (1 + np.exp(np.clip(worse / 2, -50.0, 50.0)))), LEAST_SHARE)


def _way(one: Primitive, other: Primitive) -> Array:
    """The tangent (6 + P,) that takes one to the other; a turn that nobody sees is left out."""
    turn = _turn(one, other)
    moved = other.world_from_object.translation - one.world_from_object.translation
    return np.concatenate([turn, moved, other.parameters - one.parameters])


def _turn(one: Primitive, other: Primitive) -> Array:
    before, after = one.world_from_object.rotation, other.world_from_object.rotation
    if one.kind == "sphere":
        return np.zeros(3)
    if one.kind not in ROUND_KINDS:
        return Pose(after @ before.T, np.zeros(3)).rotation_vector()
    across = np.cross(before[:, 2], after[:, 2])
    sine, cosine = float(np.linalg.norm(across)), float(before[:, 2] @ after[:, 2])
    turned: Array = across * (np.arctan2(sine, cosine) / max(sine, 1e-12))
    return turned
