# SPDX-License-Identifier: GPL-3.0-or-later
"""An object and a direction in, its farthest points that way out, with their derivatives.

As the object turns its farthest point wanders over the surface, at right angles to the direction:
how far it reaches changes as if the point were fixed to the object (envelope theorem).
"""

from __future__ import annotations

import numpy as np

from ..arrays import Array
from ..primitives import Primitive
from ..rotation import hat
from ..shape.anchors import anchor_names, anchors
from ..shape.curve_set import CurveSet
from ..shape.curves import curves


def lowest_points(
    thing: Primitive, direction_world: Array, *, both_ends: bool
) -> tuple[Array, Array]:
    """The point (1, 3) farthest along a direction, or with `both_ends` that of each rim, (2, 3).

    In the world, with derivatives (1 or 2, 3, 6 + P) by the object's tangent.
    """
    pose, parameters = thing.world_from_object, thing.parameters
    down = pose.rotation.T @ direction_world
    local, by = _farthest(thing.kind, parameters, down, both_ends)
    arms = pose.rotate(local)
    identity = np.broadcast_to(np.eye(3), (len(arms), 3, 3))
    return pose.apply(local), np.concatenate([-hat(arms), identity, pose.rotation @ by], axis=2)


def _farthest(kind: str, parameters: Array, down: Array, both_ends: bool) -> tuple[Array, Array]:
    if kind == "sphere":
        return (parameters[0] * down)[None], down[None, :, None]
    if kind in ("box", "prism"):
        names = [n for n in anchor_names(kind, len(parameters)) if not n.endswith("centre")]
        points, by = anchors(kind, parameters, names)
        most = int(np.argmax(points @ down))
        return points[[most]], by[[most]]
    ends = _rim_points(kind, parameters, down)
    if both_ends:
        return ends
    most = int(np.argmax(ends[0] @ down))
    return ends[0][[most]], ends[1][[most]]


def _rim_points(kind: str, parameters: Array, down: Array) -> tuple[Array, Array]:
    """The farthest point of the base and of the top rim; a cone's apex is its top rim."""
    rims = _rims(kind, parameters)
    turn = float(np.arctan2(down[1], down[0]))
    at = np.full(len(rims), turn)
    points, by = rims.points(at), rims.points_by(at)
    if len(rims) == 2:
        return points, by
    apex, by_apex = anchors(kind, parameters, ["top centre"])
    return np.concatenate([points, apex]), np.concatenate([by, by_apex])


def _rims(kind: str, parameters: Array) -> CurveSet:
    """Both outer rims, whatever the eye: each begins with an arc of its own."""
    seen = curves(kind, parameters, np.array([10.0, 0.0, 0.0]) * float(np.abs(parameters).max()))
    rows = [seen.names.index(name) for name in ("base rim", "top rim") if name in seen.names]
    return seen.chosen(np.array(rows))
