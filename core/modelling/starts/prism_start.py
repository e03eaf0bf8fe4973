# SPDX-License-Identifier: GPL-3.0-or-later
"""A polygon picked round its corners and what is seen of its top in, prisms near them out."""

from __future__ import annotations

import numpy as np

from ...arrays import Array, Mask
from ...camera import Camera
from ...errors import PickError
from ...sketch import Sketch
from ..reverse_mapping import points_on_plane
from .base_corners import turn_of
from .corner_solids import corner_costs, descended_corners, grazing_base, has_scale, solved_corners
from .counts import refuse_too_few
from .found import Starts, known_parameters, plane_of, rivals, things_of
from .held import Held
from .orientations import orientations
from .roles import Picked, corner_plan, corners_seen, polygon_count
from .trials import Trials


def prism_starts(
    camera: Camera, sketch: Sketch, picked: Picked, held: Held, sigma_pixels: float
) -> Starts:
    """Prisms near the picks `base` (corners in order round it) and `top` (those above, in order).

    A corner may be null in one of the two where it is not seen. The corners stay in the order that
    they were picked in, or in the reverse of it where that goes clockwise seen from the top.

    Raises PickError, naming object and pick, for corners that can't be a prism.
    """
    _refuse_unseen(sketch, picked)
    known = known_parameters(sketch, held)
    if not has_scale(held, known):
        raise PickError(
            f"{sketch.name}: nothing tells how large it is: a prism that stands nowhere needs a "
            "known height"
        )
    if not len(picked["top"]) and 0 not in known:
        raise PickError(
            f"{sketch.name}: nothing tells its height; pick a corner of top, or give height"
        )
    refuse_too_few(sketch, picked, held, known)
    grazing = grazing_base(camera, picked, held)
    _refuse_triangle(camera, picked, held)
    turn, trials = _turned(camera, picked, held, known)
    _refuse_shape(sketch, trials.parameters[0], turn)
    plan = corner_plan("prism", picked, turn, sigma_pixels)
    seen = corners_seen(camera, plan, "prism", held.parameters)
    ended = descended_corners(trials, seen, held, known, 1) if len(trials) > 1 else trials
    possible = _possible(ended)
    ended = ended.chosen(possible) if possible.any() else trials.chosen(np.array([0]))
    cost = corner_costs(ended, seen, held)
    return Starts(things_of(sketch, rivals(ended, cost, sigma_pixels)), plan, grazing)


def _turned(
    camera: Camera, picked: Picked, held: Held, known: dict[int, float]
) -> tuple[float, Trials]:
    """Which way round the corners go, and the solved orientations, best first.

    Those that make no prism are left out, unless there is no other.
    """
    found = []
    for turn in (1.0, -1.0):
        plan = corner_plan("prism", picked, turn, 1.0)
        seen = corners_seen(camera, plan, "prism", held.parameters)
        solved = solved_corners(_orientations(held), seen, held, known)
        possible = _possible(solved)
        if possible.any():
            solved = solved.chosen(possible)
        cost = corner_costs(solved, seen, held)
        order = np.argsort(cost, kind="stable")
        found.append((not possible.any(), float(cost[order[0]]), turn, solved.chosen(order)))
    _, _, turn, trials = min(found, key=lambda f: f[:2])
    return turn, trials


def _orientations(held: Held) -> Array:
    """Standing it takes the plane's own frame: its polygon holds how it is turned."""
    standing = held.standing
    if standing is None:
        return orientations(held)
    frame = plane_of(standing).world_from_plane.rotation
    return (frame if standing.flush == "base" else frame @ np.diag([1.0, -1.0, -1.0]))[None]


def _possible(trials: Trials) -> Mask:
    """Which guesses (M,) are prisms at all."""
    return np.array(
        [
            p[0] > 0 and _doubled_area(p) > 0 and _crossing(p[1:].reshape(-1, 2)) is None
            for p in trials.parameters
        ],
        dtype=bool,
    )


def _refuse_unseen(sketch: Sketch, picked: Picked) -> None:
    seen = {place for role in ("base", "top") for place in picked[role].places}
    count = 1 + max(seen, default=-1)
    if count < 3:
        raise PickError(
            f"{sketch.name}: {count} corners make no prism; pick three or more, in order round the "
            "base"
        )
    for i in range(count):
        if i not in seen:
            raise PickError(
                f"{sketch.name}: neither base[{i}] nor top[{i}] is picked; a prism needs every "
                "corner once, below or above"
            )


def _refuse_triangle(camera: Camera, picked: Picked, held: Held) -> None:
    """Three corners of a base on one line, on the plane that it stands on."""
    standing, base = held.standing, picked["base"]
    if standing is None or polygon_count(picked) != 3 or len(base) != 3:
        return
    plane = plane_of(standing)
    points = points_on_plane(camera, plane, base.pixels, base.labels)
    turn_of(plane.world_from_plane.inverse().apply(points)[:, :2], base.labels)


def _refuse_shape(sketch: Sketch, parameters: Array, turn: float) -> None:
    count = (len(parameters) - 1) // 2
    polygon = parameters[1:].reshape(-1, 2)
    if turn < 0:
        polygon = polygon[::-1]
    crossing = _crossing(polygon)
    if crossing is not None:
        i, j = crossing
        raise PickError(
            f"{sketch.name}: the side from corner {i} to {(i + 1) % count} crosses that from {j} "
            f"to {(j + 1) % count}; pick the corners in order round the base"
        )
    if parameters[0] <= 0:
        raise PickError(
            f"{sketch.name}: the picks fit best with a height of {1e3 * parameters[0]:.1f} mm; "
            "check that top is above base, and the side the normal points to"
        )


def _crossing(polygon: Array) -> tuple[int, int] | None:
    """Two sides of a polygon (N, 2) that cross each other."""
    after = np.roll(polygon, -1, axis=0)
    count = len(polygon)
    for i in range(count):
        for j in range(i + 2, count):
            if (j + 1) % count != i and _cross(polygon[i], after[i], polygon[j], after[j]):
                return i, j
    return None


def _cross(a: Array, b: Array, c: Array, d: Array) -> bool:
    def side(p: Array, q: Array, r: Array) -> float:
        return float((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]))

    return side(a, b, c) * side(a, b, d) < 0 and side(c, d, a) * side(c, d, b) < 0


def _doubled_area(parameters: Array) -> float:
    polygon = parameters[1:].reshape(-1, 2)
    after = np.roll(polygon, -1, axis=0)
    return float((polygon[:, 0] * after[:, 1] - polygon[:, 1] * after[:, 0]).sum())
