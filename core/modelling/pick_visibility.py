# SPDX-License-Identifier: GPL-3.0-or-later
"""A solved object and its picks in, those that lie where the object hides itself out.

What can't be seen can't be picked: such a pick means another solution, or a slip.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..arrays import Array, Mask
from ..camera import Camera
from ..primitives import Primitive
from ..shape.curve_set import CurveSet
from ..shape.curves import curves_seen
from .pick_plan import PickPlan

SAMPLES = np.linspace(0.0, 1.0, 129)
# a face turned away by less than this sine may be seen for all that a pick can tell
GRAZING = 0.03
# a pick this many sigmas nearer to what is hidden than to what is seen lies there
SURE = 4.0


def hidden_picks(thing: Primitive, camera: Camera, plan: PickPlan) -> tuple[int, ...]:
    """The places in `plan` (points first, then curves) of picks on what `thing` itself hides.

    A corner is hidden where all faces beside it are turned away, a point of a rim where it lies
    nearer to the hidden part of the rim than to any part that is seen. Raises NoPose.
    """
    seen = curves_seen(thing, camera)
    hidden = [i for i, name in enumerate(plan.anchors) if _corner_hidden(thing, camera, name)]
    count = len(plan.anchors)
    if len(plan.curves):
        away = _behind(thing, camera, plan, seen)
        hidden += [count + int(i) for i in np.flatnonzero(away)]
    return tuple(hidden)


def hidden_warnings(thing: Primitive, camera: Camera, plan: PickPlan) -> tuple[str, ...]:
    """One line that names the picks on what the object hides, none where all can be seen."""
    names = [plan.labels[i] for i in hidden_picks(thing, camera, plan)]
    if not names:
        return ()
    own = f"{thing.name}: "
    listed = ", ".join(name.removeprefix(own) for name in names)
    what = "lies" if len(names) == 1 else "lie"
    return (
        f"{own}{listed} {what} where the solved {thing.kind} hides itself from the camera; check "
        "that each was picked on what it is named after",
    )


def _corner_hidden(thing: Primitive, camera: Camera, anchor: str) -> bool:
    faces = _faces_at(thing, anchor)
    if not faces:
        return False
    eye = thing.world_from_object.inverse().apply(camera.centre_world)
    away = float(np.linalg.norm(eye))
    return all(float((eye - point) @ normal) < -GRAZING * away for point, normal in faces)


def _faces_at(thing: Primitive, anchor: str) -> Sequence[tuple[Array, Array]]:
    """A point and the outward normal of each face that meets at a corner."""
    if thing.kind == "box":
        signs = np.array(
            [
                1.0 if "x+" in anchor else -1.0,
                1.0 if "y+" in anchor else -1.0,
                1.0 if anchor.endswith("top") else -1.0,
            ]
        )
        corner = signs * thing.half_extent
        return (
            [(corner, signs[i] * np.eye(3)[i]) for i in range(3)] if "centre" not in anchor else []
        )
    if thing.kind != "prism" or "centre" in anchor:
        return []
    end, i = (
        (anchor[:4], int(anchor[4:])) if anchor.startswith("base") else ("top", int(anchor[3:]))
    )
    polygon = thing.parameters[1:].reshape(-1, 2)
    level = (1.0 if end == "top" else -1.0) * thing.parameters[0] / 2
    corner = np.array([*polygon[i], level])
    before, after = polygon[i] - polygon[i - 1], polygon[(i + 1) % len(polygon)] - polygon[i]
    sides = [np.array([d[1], -d[0], 0.0]) / np.linalg.norm(d) for d in (before, after)]
    return [(corner, normal) for normal in (*sides, np.array([0.0, 0.0, np.sign(level)]))]


def _behind(thing: Primitive, camera: Camera, plan: PickPlan, seen: CurveSet) -> Mask:
    """Which picks on curves (L,) are nearer to hidden parts of them than to seen ones, surely."""
    nearest = {True: np.full(len(plan.curves), np.inf), False: np.full(len(plan.curves), np.inf)}
    for row, name in enumerate(seen.names):
        mine = np.array([name in names for names in plan.curves])
        if not mine.any():
            continue
        start, end = seen.ends[row]
        one = seen.chosen(np.array([row]))
        points = one.points((start + (end - start) * SAMPLES)[:, None])[:, 0]
        image = camera.project(thing.world_from_object.apply(points))
        distance = _to_polyline(plan.on_curves[mine], image)
        shown = bool(seen.visible[row])
        nearest[shown][mine] = np.minimum(nearest[shown][mine], distance)
    behind: Mask = nearest[True] > nearest[False] + SURE * plan.sigma_pixels
    return behind


def _to_polyline(pixels: Array, image: Array) -> Array:
    """Distances (N,) of pixels to a chain of image points; infinite where it is not imaged."""
    start, along = image[:-1], np.diff(image, axis=0)
    length = np.maximum((along**2).sum(axis=1), 1e-18)
    gap = pixels[:, None] - start
    share = np.clip((gap * along).sum(axis=2) / length, 0.0, 1.0)
    away = np.linalg.norm(gap - share[:, :, None] * along, axis=2)
    least: Array = np.where(np.isnan(away), np.inf, away).min(axis=1)
    return least
