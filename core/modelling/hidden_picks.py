# SPDX-License-Identifier: GPL-3.0-or-later
"""A solved object and its picks in, the picks that it would hide from the camera itself out."""

from __future__ import annotations

import numpy as np

from ..arrays import Array
from ..camera import Camera
from ..primitives import Primitive
from ..shape.anchors import anchors
from ..shape.curve_set import CurveSet
from ..shape.curves import curves_seen
from .pick_plan import PickPlan

SAMPLES = 64
# a corner and a curve's end that are nearer than this share of the object are one
SAME_SHARE = 1e-6
# a pick this much nearer (in pixels) to a visible part than to a hidden one may have meant it
DOUBT_PIXELS = 3.0


def hidden_picks(thing: Primitive, plan: PickPlan, camera: Camera) -> tuple[int, ...]:
    """The indices of picks, points first, that lie where the object hides its own edges.

    A pick within 3 px of a visible part of its curve is not counted: a hand can be that far off.
    """
    found = curves_seen(thing, camera)
    if not len(found):
        return ()
    corners = [i for i, hidden in enumerate(_hidden_corners(thing, plan, found)) if hidden]
    along = _hidden_along(thing, plan, found, camera)
    first = len(plan.anchors)
    return (*corners, *(first + i for i, hidden in enumerate(along) if hidden))


def _hidden_corners(thing: Primitive, plan: PickPlan, found: CurveSet) -> list[bool]:
    """A corner is hidden where all edges that meet there are; a centre or apex is not told."""
    if thing.kind not in ("box", "prism"):
        return [False] * len(plan.anchors)
    points, _ = anchors(thing.kind, thing.parameters, plan.anchors)
    ends = np.stack([found.points(found.ends[:, i]) for i in (0, 1)])
    near = SAME_SHARE * float(thing.half_extent.max())
    meets = (np.linalg.norm(points[:, None, None] - ends, axis=-1) < near).any(axis=1)
    return [bool(m.any() and not found.visible[m].any()) for m in meets]


def _hidden_along(thing: Primitive, plan: PickPlan, found: CurveSet, camera: Camera) -> list[bool]:
    if not plan.curves or found.visible.all():
        return [False] * len(plan.curves)
    shares = np.linspace(0, 1, SAMPLES)[:, None]
    t = found.ends[:, 0] + shares * (found.ends[:, 1] - found.ends[:, 0])
    flat = thing.world_from_object.apply(found.points(t).reshape(-1, 3))
    pixels = camera.project(flat).reshape(SAMPLES, len(found), 2)
    return [
        _hidden(pixel, pixels, [i for i, n in enumerate(found.names) if n in names], found)
        for pixel, names in zip(plan.on_curves, plan.curves, strict=True)
    ]


def _hidden(pixel: Array, samples: Array, rows: list[int], found: CurveSet) -> bool:
    away = np.linalg.norm(samples[:, rows] - pixel, axis=-1)
    away = np.where(np.isfinite(away), away, np.inf).min(axis=0)
    seen = found.visible[rows]
    to_seen = float(away[seen].min()) if seen.any() else np.inf
    return bool(not seen[int(away.argmin())] and to_seen > float(away.min()) + DOUBT_PIXELS)
