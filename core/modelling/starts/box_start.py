# SPDX-License-Identifier: GPL-3.0-or-later
"""Corners of a box picked in any number, seen ones only, in; boxes that come near them out."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ...arrays import Array
from ...camera import Camera
from ...errors import PickError
from ...primitives import Box
from ...reference import ReferencePlane
from ...sketch import Sketch
from ..picks import RolePicks
from ..reverse_mapping import grazing_warnings, points_on_plane
from .base_corners import refuse_crossing, top_heights, turn_of
from .corner_solids import corner_costs, descended_corners, grazing_base, has_scale, solved_corners
from .counts import refuse_too_few
from .found import Starts, known_parameters, plane_of, rivals, things_of
from .held import Grip, Held
from .orientations import orientations
from .roles import Picked, corner_plan, corners_seen
from .trials import Trials

FREE_TURNS = 18


def box_starts(
    camera: Camera, sketch: Sketch, picked: Picked, held: Held, sigma_pixels: float
) -> Starts:
    """Boxes near the picks `base` (corners in order round it) and `top` (those above, in order).

    Corners that are not seen are null. x runs from base[0] to base[1], z from base to top. With
    three base corners on a plane the answer is direct; otherwise all turns that what holds the box
    leaves open are tried.

    Raises PickError, naming object and pick, for corners that can't be a box.
    """
    for role in ("base", "top"):
        if any(place > 3 for place in picked[role].places):
            raise PickError(
                f"{sketch.name}: {role}[{picked[role].places[-1]}] is a fifth corner; a box has "
                "four round its base"
            )
    refuse_too_few(sketch, picked, held, known_parameters(sketch, held))
    standing = held.standing
    if standing is not None and standing.flush == "base" and len(picked["base"]) >= 3:
        return _from_base(camera, sketch, picked, held, standing, sigma_pixels)
    return _from_any(camera, sketch, picked, held, sigma_pixels)


def _from_base(
    camera: Camera, sketch: Sketch, picked: Picked, held: Held, standing: Grip, sigma: float
) -> Starts:
    """The rectangle through the mapped base corners, and the median height of the top picks."""
    base, plane = picked["base"], plane_of(standing)
    points = points_on_plane(camera, plane, base.pixels, base.labels)
    corners = plane.world_from_plane.inverse().apply(points)[:, :2]
    turn = turn_of(corners, base.labels)
    corners = _all_four(corners, base)
    one, other = (
        corners[1] - corners[0] + corners[2] - corners[3],
        corners[2] - corners[1] + corners[3] - corners[0],
    )
    quarter = -turn * np.pi / 2
    yaws = np.arctan2(one[1], one[0]), np.arctan2(other[1], other[0]) + quarter
    yaw = float(np.angle(np.exp(1j * yaws[0]) + np.exp(1j * yaws[1])))
    known = known_parameters(sketch, held)
    height = known.get(2) or _height(camera, sketch, plane, corners, picked["top"])
    sizes = np.array([np.linalg.norm(one) / 2, np.linalg.norm(other) / 2, height])
    for i, value in known.items():
        sizes[i] = value
    trials = _standing(plane, corners.mean(axis=0), yaw, sizes)
    warnings = grazing_warnings(camera, plane, base.pixels, base.labels)
    plan = corner_plan("box", picked, turn, sigma)
    return Starts(things_of(sketch, trials), plan, tuple(warnings))


def _all_four(corners: Array, base: RolePicks) -> Array:
    """The corners of the base in its order (4, 2), one that was not seen by the diagonal."""
    found = np.full((4, 2), np.nan)
    found[list(base.places)] = corners
    for i in range(4):
        if np.isnan(found[i, 0]):
            found[i] = found[i - 1] + found[(i + 1) % 4] - found[i - 2]
    return found


def _height(
    camera: Camera, sketch: Sketch, plane: ReferencePlane, corners: Array, top: RolePicks
) -> float:
    if not len(top):
        raise PickError(
            f"{sketch.name}: nothing tells its height; pick a corner of top, or give size_z"
        )
    return float(np.median(top_heights(camera, plane, corners, top)))


def _standing(plane: ReferencePlane, middle: Array, yaw: float, sizes: Array) -> Trials:
    cosine, sine = np.cos(yaw), np.sin(yaw)
    turned = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    frame = plane.world_from_plane
    place = frame.apply([*middle, sizes[2] / 2])
    return Trials((frame.rotation @ turned)[None], place[None], sizes[None])


def _from_any(camera: Camera, sketch: Sketch, picked: Picked, held: Held, sigma: float) -> Starts:
    known = known_parameters(sketch, held)
    if not has_scale(held, known):
        raise PickError(
            f"{sketch.name}: nothing tells how large it is: a box that stands nowhere needs a "
            "known size"
        )
    _refuse_one_end(sketch, picked, held, known)
    grazing = grazing_base(camera, picked, held)
    for role in ("base", "top"):
        refuse_crossing(picked[role])
    turns = FREE_TURNS if not held.grips else 2 * FREE_TURNS
    rotations = orientations(held, turns)
    found: list[tuple[float, float, Trials, Array]] = []
    guessed: list[tuple[float, Trials]] = []
    for turn in (1.0, -1.0):
        plan = corner_plan("box", picked, turn, sigma)
        seen = corners_seen(camera, plan, "box", 3)
        solved = solved_corners(rotations, seen, held, known)
        all_costs = corner_costs(solved, seen, held)
        guessed.append((float(all_costs.min()), solved.chosen(np.array([all_costs.argmin()]))))
        trials = descended_corners(solved, seen, held, known, 3)
        if len(trials):
            cost = corner_costs(trials, seen, held)
            found.append((float(cost[0]), turn, trials, cost))
    if not found:
        _refuse_negative(sketch, min(guessed, key=lambda g: g[0])[1])
    _, turn, trials, cost = min(found, key=lambda f: f[0])
    plan = corner_plan("box", picked, turn, sigma)
    return Starts(things_of(sketch, rivals(trials, cost, sigma)), plan, grazing)


def _refuse_one_end(sketch: Sketch, picked: Picked, held: Held, known: Mapping[int, float]) -> None:
    """A top alone above the plane may be small and near to it, or large and far."""
    stands = len(held.grips) == 1 and held.grips[0].flush in ("base", "top")
    if not stands or held.others or known:
        return
    other = "top" if held.grips[0].flush == "base" else "base"
    if len(picked[other]) and not len(picked[str(held.grips[0].flush)]):
        raise PickError(
            f"{sketch.name}: no corner of its {held.grips[0].flush} is picked, so that it may be "
            f"small and near to {held.grips[0].name} or large and far; pick one, or give a size"
        )


def _refuse_negative(sketch: Sketch, trials: Trials) -> None:
    sizes = trials.parameters[0]
    worst = int(np.argmin(sizes))
    if not np.isfinite(sizes).all() or sizes[worst] > 0:
        raise PickError(f"{sketch.name}: no box in front of the camera comes near these picks")
    raise PickError(
        f"{sketch.name}: the picks fit best with a {Box.size_names[worst]} of "
        f"{1e3 * sizes[worst]:.1f} mm; check that top is above base, and the side the normal "
        "points to"
    )
