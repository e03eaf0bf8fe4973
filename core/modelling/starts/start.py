# SPDX-License-Identifier: GPL-3.0-or-later
"""A sketch and what holds it in, objects near its picks out, for the exact fit to begin with."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from ...camera import Camera
from ...primitives import KINDS, Primitive
from ...sketch import Sketch
from ..holding import References
from .ball_start import ball_starts
from .box_start import box_starts
from .found import Starts
from .held import Held, held_by
from .mirrored import mirror_of, mirrored_starts
from .prism_start import prism_starts
from .roles import Picked, picked_roles, polygon_count
from .round_start import round_starts

StartsOf = Callable[[Camera, Sketch, Picked, Held, float], Starts]
STARTS: dict[str, StartsOf] = {
    "box": box_starts,
    "prism": prism_starts,
    "cylinder": round_starts,
    "cone": round_starts,
    "tube": round_starts,
    "sphere": ball_starts,
}


def start(
    camera: Camera,
    sketch: Sketch,
    references: References,
    things: Mapping[str, Primitive],
    pick_sigma_pixels: float = 1.0,
) -> Starts:
    """Objects near the picks of a sketch and near to what holds it, the likeliest first.

    `references` and `things`, by name, are what its `on` and relations may speak of, as they stand.
    Each start settles into its own valley under `fit_model`; of those that fit alike the picks
    can't tell.

    Raises PickError for picks that can't mean the object or are too few, naming object, pick and
    what is open; InvalidValue for a relation to what is not there; NoPose without a camera pose.
    """
    picked = picked_roles(sketch, camera)
    parameters = len(KINDS[sketch.kind].size_names)
    if sketch.kind == "prism":
        parameters = 1 + 2 * polygon_count(picked)
    held = held_by(sketch, parameters, references, things)
    mirror = mirror_of(sketch, held)
    if mirror is not None:
        return mirrored_starts(camera, sketch, picked, mirror, pick_sigma_pixels)
    return STARTS[sketch.kind](camera, sketch, picked, held, pick_sigma_pixels)


__all__ = ["Starts", "start"]
