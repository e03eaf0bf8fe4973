# SPDX-License-Identifier: GPL-3.0-or-later
"""An object that is the mirror image of a solved one in, where that image stands out.

The relation alone tells place and sizes, so that any picks, even one, will do. What is open is how
its own axes point along the image's: that is chosen by the picks.
"""

from __future__ import annotations

import numpy as np

from ...arrays import Array
from ...camera import Camera
from ...primitives import Primitive
from ...shape.features import Feature
from ...sketch import Sketch
from ..pick_plan import PickPlan
from .found import Starts, things_of
from .held import Held
from .roles import Picked, corner_plan, corners_seen, round_plan, round_seen
from .seen import Seen
from .trials import Trials, costs

# half turns of the object in its own frame that leave its axes where they are, but for their sign
HALF_TURNS = tuple(np.diag(d) for d in ([1.0, 1, 1], [-1.0, -1, 1], [1.0, -1, -1], [-1.0, 1, -1]))


def mirror_of(sketch: Sketch, held: Held) -> tuple[Primitive, Feature] | None:
    """The object that a sketch is the mirror image of, and the plane; None for a prism."""
    for relation, other, about in held.others:
        fits = other.kind == sketch.kind and other.kind != "prism"
        if relation.kind == "symmetric" and about is not None and fits:
            return other, about
    return None


def mirrored_starts(
    camera: Camera,
    sketch: Sketch,
    picked: Picked,
    mirror: tuple[Primitive, Feature],
    sigma_pixels: float,
) -> Starts:
    """The image of the other object, its axes as the picks of this one say."""
    other, about = mirror
    guesses = _images(other, about)
    found: list[tuple[float, int, PickPlan]] = []
    for plan, seen in _readings(camera, sketch, picked, other, guesses, sigma_pixels):
        cost = costs(guesses, seen.residuals) if plan.labels else np.zeros(len(guesses))
        best = int(np.argmin(cost))
        found.append((float(cost[best]), best, plan))
    _, best, plan = min(found, key=lambda f: f[:2])
    return Starts(things_of(sketch, guesses.chosen(np.array([best]))), plan)


def _readings(
    camera: Camera,
    sketch: Sketch,
    picked: Picked,
    other: Primitive,
    guesses: Trials,
    sigma_pixels: float,
) -> list[tuple[PickPlan, Seen]]:
    """What the picks may mean: corners round a base go one way or the other."""
    if sketch.kind == "box":
        plans = [corner_plan("box", picked, turn, sigma_pixels) for turn in (1.0, -1.0)]
        return [(plan, corners_seen(camera, plan, "box", 3)) for plan in plans]
    seen = round_seen(camera, picked, sketch.kind, len(other.parameters))
    facing = float(seen.facing(guesses)[0])
    return [(round_plan(picked, facing, sigma_pixels), seen)]


def _images(other: Primitive, about: Feature) -> Trials:
    normal, pose = about.direction, other.world_from_object
    mirror = np.eye(3) - 2 * np.outer(normal, normal)
    place: Array = about.point + mirror @ (pose.translation - about.point)
    # a mirrored frame is left-handed: its y is turned back, which no solid of ours can tell
    frame = mirror @ pose.rotation @ np.diag([1.0, -1.0, 1.0])
    rotations = np.array([frame @ turn for turn in HALF_TURNS])
    count = len(HALF_TURNS)
    return Trials(rotations, np.tile(place, (count, 1)), np.tile(other.parameters, (count, 1)))
