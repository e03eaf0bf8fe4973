# SPDX-License-Identifier: GPL-3.0-or-later
"""Corners of a box or prism picked in any number in, the guesses that fit them best out.

For a given orientation a corner is linear in the place and the sizes, and so is its ray's miss: all
orientations that what holds the object allows are solved at once, and the best few descended.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

import numpy as np

from ...arrays import Array
from ...camera import Camera
from ..held_rows import across_of
from ..reverse_mapping import grazing_warnings, points_on_plane
from .found import plane_of
from .held import Grip, Held
from .own_parts import own_part
from .roles import Picked
from .seen import Seen
from .trials import Trials, best, costs, descended, distinct

# what holds the object weighs so much more than what is seen of it
HOLD_WEIGHT, FREE_WEIGHT = 100.0, 1e-3
# of the solved orientations so many are descended
DESCENTS, STEPS = 8, 12
RIDGE = 1e-12


def solved_corners(rotations: Array, seen: Seen, held: Held, known: Mapping[int, float]) -> Trials:
    """The guesses (M,) whose place and parameters fit the rays best, one for each orientation.

    `known` are parameters by their index. Sizes may come out negative.
    """
    place_and_shape, right = _equations(rotations, seen, held)
    rest = [i for i in range(place_and_shape.shape[2]) if i - 3 not in known]
    for i, value in known.items():
        right = right - place_and_shape[:, :, 3 + i] * value
    matrix = place_and_shape[:, :, rest]
    turned = np.swapaxes(matrix, 1, 2)
    normal = turned @ matrix
    diagonal = np.arange(len(rest))
    normal[:, diagonal, diagonal] *= 1 + RIDGE
    normal[:, diagonal, diagonal] += RIDGE
    solution = np.linalg.solve(normal, turned @ right[:, :, None])[:, :, 0]
    full = np.zeros((len(rotations), place_and_shape.shape[2]))
    full[:, rest] = solution
    for i, value in known.items():
        full[:, 3 + i] = value
    return Trials(rotations, seen.origin + full[:, :3], full[:, 3:])


def descended_corners(
    trials: Trials, seen: Seen, held: Held, known: Mapping[int, float], sizes: int
) -> Trials:
    """The best of the solved guesses after a descent; only those whose `sizes` are positive."""
    residuals = partial(_residuals, seen=seen, held=held)
    real = trials.chosen((trials.parameters[:, :sizes] > 0).all(axis=1))
    chosen = best(real, residuals, 4 * DESCENTS)
    chosen = _apart(chosen, DESCENTS)
    free = np.ones(6 + held.parameters, dtype=bool)
    free[[6 + i for i in known]] = False
    ended = descended(chosen, residuals, free, STEPS)
    ended = ended.chosen((ended.parameters[:, :sizes] > 0).all(axis=1))
    return distinct(best(ended, residuals, DESCENTS), polygon=held.kind == "prism")


def corner_costs(trials: Trials, seen: Seen, held: Held) -> Array:
    """The sum of squared residuals (M,) of guesses, in squared pixels."""
    return costs(trials, partial(_residuals, seen=seen, held=held))


def has_scale(held: Held, known: Mapping[int, float]) -> bool:
    """Whether anything tells metres: a known size, or a place that the object is held to."""
    return bool(known) or any(_held_points(grip, held) for grip in held.grips)


def grazing_base(camera: Camera, picked: Picked, held: Held) -> tuple[str, ...]:
    """Doubts about base corners on the plane that an object stands on.

    Raises PickError for one above its horizon.
    """
    standing, base = held.standing, picked["base"]
    if standing is None or standing.flush != "base" or not len(base):
        return ()
    points_on_plane(camera, plane_of(standing), base.pixels, base.labels)
    return tuple(grazing_warnings(camera, plane_of(standing), base.pixels, base.labels))


def _residuals(trials: Trials, seen: Seen, held: Held) -> Array:
    return np.concatenate(
        [seen.residuals(trials), held.residuals(trials, seen.origin, seen.focal)], axis=1
    )


def _apart(trials: Trials, count: int) -> Trials:
    """The first guesses that are turned away from each other, so that each is another valley."""
    kept: list[int] = []
    for i in range(len(trials)):
        turns = [np.trace(trials.rotation[i].T @ trials.rotation[j]) for j in kept]
        # the trace of a turn by 25 degrees
        if all(turn < 1 + 2 * 0.906 for turn in turns):
            kept.append(i)
        if len(kept) == count:
            break
    return trials.chosen(np.array(kept, dtype=int))


def _equations(rotations: Array, seen: Seen, held: Held) -> tuple[Array, Array]:
    """The matrix (M, N, 3 + P) on (place from the origin, parameters), and what it should give."""
    count = len(rotations)
    across = np.array([across_of(ray) for ray in seen.points])
    by = np.einsum("kci,mij,kjp->mkcp", across, rotations, seen.by, optimize=True)
    shape = by.reshape(count, -1, held.parameters)
    place = np.broadcast_to(across.reshape(-1, 3), (count, shape.shape[1], 3))
    left = [np.concatenate([place, shape], axis=2)]
    right = [np.zeros((count, shape.shape[1]))]
    for grip in held.grips:
        for directions, points in _held_points(grip, held):
            rows = np.einsum("ci,mij,kjp->mkcp", directions, rotations, points, optimize=True)
            rows = rows.reshape(count, -1, held.parameters)
            if grip.kind in ("leans_on", "touches") and grip.own is None:
                rows = -np.abs(np.einsum("i,mij->mj", grip.to.direction, rotations))[:, None] / 2
            where = np.broadcast_to(
                np.tile(directions, (len(points), 1)), (count, rows.shape[1], 3)
            )
            level = np.tile(directions @ (grip.to.point - seen.origin), len(points))
            left.append(HOLD_WEIGHT * np.concatenate([where, rows], axis=2))
            right.append(HOLD_WEIGHT * np.broadcast_to(level, (count, rows.shape[1])))
    if held.kind == "prism":
        # its place may move against its polygon; any will do
        still = np.swapaxes(rotations, 1, 2)[:, :2]
        left.append(FREE_WEIGHT * np.concatenate([still, np.zeros((count, 2, held.parameters))], 2))
        right.append(np.zeros((count, 2)))
    return np.concatenate(left, axis=1), np.concatenate(right, axis=1)


def _held_points(grip: Grip, held: Held) -> list[tuple[Array, Array]]:
    """Directions (C, 3) along which own points (K, 3, P) are at the level of what holds them."""
    to = grip.to
    if grip.kind in ("parallel", "perpendicular"):
        return []
    if grip.kind == "centred_on":
        part = own_part(held.kind, held.parameters, grip.own or "centre")
        return [(np.eye(3) if to.kind == "point" else across_of(to.direction), part.by[None])]
    if to.kind == "line":
        return []
    if grip.flush is not None or grip.own is not None:
        return [(to.direction[None], own_part(held.kind, held.parameters, _own(grip)).spans)]
    # the lowest corner of a box is linear in its sizes; which corner of a prism it is, is not known
    middle = np.zeros((1, 3, held.parameters))
    return [(to.direction[None], middle)] if held.kind == "box" else []


def _own(grip: Grip) -> str:
    return grip.flush or grip.own or "base"
