# SPDX-License-Identifier: GPL-3.0-or-later
"""All objects' picks in, how far each is from any tried solid and camera out, with derivatives.

The picks of all objects are evaluated at once: an edge is a segment and a rim an arc whatever it
belongs to, and NumPy then costs the same for one object as for ten.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, Mask
from ..camera import Camera
from ..pose import point_jacobian
from ..rotation import hat
from ..shape.anchors import anchors
from ..shape.curve_set import CurveSet
from ..shape.curves import curves
from .curve_distance import Feet, nearest_feet, nearest_samples
from .observed import Observe, Observed
from .pick_plan import PickPlan
from .solid import Solid

CIRCLE_SAMPLES = np.linspace(-np.pi, np.pi, 24, endpoint=False)
LONGEST_TURN = 0.2


def pick_observer(plans: Mapping[str, PickPlan]) -> Observe:
    """The function that evaluates these plans, of objects by name, for solids and a camera."""

    def observe(solids: Mapping[str, Solid], camera: Camera) -> Mapping[str, Observed]:
        return observe_picks(plans, solids, camera)

    return observe


def observe_picks(
    plans: Mapping[str, PickPlan], solids: Mapping[str, Solid], camera: Camera
) -> dict[str, Observed]:
    """What the picks say of `solids`, in the order of each plan: points (u and v), then curves.

    A pick on a curve that the solid does not show (the silhouettes of a cylinder seen end on) gives
    NaN.
    """
    named = [(name, plan) for name, plan in plans.items() if name in solids]
    points = _point_rows([(plan, solids[name]) for name, plan in named], camera)
    on_curves = _curve_rows([(plan, solids[name]) for name, plan in named], camera)
    result = {}
    for (name, plan), at, along in zip(named, points, on_curves, strict=True):
        parts = [np.concatenate(pair) for pair in zip(at, along, strict=True)]
        sigma = np.full(len(parts[0]), plan.sigma_pixels)
        result[name] = Observed(parts[0], parts[1], parts[2], sigma)
    return result


Rows = tuple[Array, Array, Array]


def _point_rows(planned: list[tuple[PickPlan, Solid]], camera: Camera) -> list[Rows]:
    found = [anchors(s.kind, s.parameters, plan.anchors) for plan, s in planned]
    counts = [len(plan.anchors) for plan, _ in planned]
    arms = [local @ s.rotation.T for (local, _), (_, s) in zip(found, planned, strict=True)]
    places = [arm + s.place for arm, (_, s) in zip(arms, planned, strict=True)]
    at_camera = camera.pose.apply(_stacked(places, 3))
    image, by_point = camera.intrinsics.project_with_jacobian(at_camera)
    by_world = by_point @ camera.pose.rotation
    by_camera = by_point @ point_jacobian(at_camera)
    rows: list[Rows] = []
    start = 0
    for (plan, solid), (_, by), arm, count in zip(planned, found, arms, counts, strict=True):
        part = slice(start, start + count)
        start += count
        moved = _moved_points(arm, solid.rotation @ by)
        rows.append(
            (
                (image[part] - plan.points).ravel(),
                (by_world[part] @ moved).reshape(2 * count, moved.shape[2]),
                by_camera[part].reshape(2 * count, 6),
            )
        )
    return rows


@dataclass(frozen=True, eq=False)
class _Candidates:
    """Curves in the world, one for every pick and curve it may lie on; `pick` counts over all."""

    pick: NDArray[np.intp]
    owner: NDArray[np.intp]
    row: NDArray[np.intp]
    origin: Array
    first: Array
    second: Array
    round: Mask

    def curve(self, t: Array) -> tuple[Array, Array]:
        """Points and tangents (..., N, 3) at parameters (..., N)."""
        f, g = np.where(self.round, np.cos(t), t), np.where(self.round, np.sin(t), 0.0)
        points = self.origin + f[..., None] * self.first + g[..., None] * self.second
        tangents = np.where(
            self.round[:, None],
            f[..., None] * self.second - g[..., None] * self.first,
            self.first,
        )
        return points, tangents


def _curve_rows(planned: list[tuple[PickPlan, Solid]], camera: Camera) -> list[Rows]:
    counts = [len(plan.curves) for plan, _ in planned]
    empty = [np.zeros(0), np.zeros((0, 6))]
    if not sum(counts):
        return [(empty[0], np.zeros((0, 6 + len(s.parameters))), empty[1]) for _, s in planned]
    eye = camera.centre_world
    sets = [
        curves(s.kind, s.parameters, s.eye(eye)) if n else None
        for n, (_, s) in zip(counts, planned, strict=True)
    ]
    found = _candidates(planned, sets)
    pixels = _stacked([plan.on_curves for plan, _ in planned])
    feet = _feet(found, pixels, camera)
    total = sum(counts)
    distances = np.full(total, np.nan)
    best = _nearest_of(found.pick, feet.distances, total)
    seen = best >= 0
    distances[seen] = feet.distances[best[seen]]
    rows: list[Rows] = []
    start = 0
    for (_, solid), curve_set, count in zip(planned, sets, counts, strict=True):
        part = best[start : start + count]
        residuals = distances[start : start + count]
        start += count
        by_object = np.full((count, 6 + len(solid.parameters)), np.nan)
        by_camera = np.full((count, 6), np.nan)
        ok = part >= 0
        if curve_set is not None and ok.any():
            chosen = part[ok]
            t = feet.parameters[chosen]
            on = curve_set.chosen(found.row[chosen])
            moved = _moved_points(on.points(t) @ solid.rotation.T, solid.rotation @ on.points_by(t))
            by_object[ok] = (feet.by_point[chosen][:, None, :] @ moved)[:, 0]
            by_camera[ok] = feet.by_twist[chosen]
        rows.append((residuals, by_object, by_camera))
    return rows


def _candidates(planned: list[tuple[PickPlan, Solid]], sets: list[CurveSet | None]) -> _Candidates:
    picks, owners, rows = [], [], []
    parts: list[tuple[Array, Array, Array, Mask]] = []
    pick = 0
    for owner, ((plan, solid), found) in enumerate(zip(planned, sets, strict=True)):
        index = {} if found is None else {n: i for i, n in reversed([*enumerate(found.names)])}
        mine = []
        for names in plan.curves:
            here = [index[name] for name in names if name in index]
            picks += [pick] * len(here)
            mine += here
            pick += 1
        owners += [owner] * len(mine)
        rows += mine
        if found is not None and mine:
            turn = solid.rotation.T
            parts.append(
                (
                    found.origin[mine] @ turn + solid.place,
                    found.first[mine] @ turn,
                    found.second[mine] @ turn,
                    found.round[mine],
                )
            )
    origin = _stacked([p[0] for p in parts], 3)
    first, second = _stacked([p[1] for p in parts], 3), _stacked([p[2] for p in parts], 3)
    turning = np.concatenate([p[3] for p in parts]) if parts else np.zeros(0, bool)
    return _Candidates(
        np.array(picks, dtype=np.intp),
        np.array(owners, dtype=np.intp),
        np.array(rows, dtype=np.intp),
        origin,
        first,
        second,
        turning,
    )


def _feet(found: _Candidates, pixels: Array, camera: Camera) -> Feet:
    at = pixels[found.pick]
    scene = camera.intrinsics, camera.pose
    starts = np.zeros(len(at))
    if found.round.any():
        circles = _part(found, found.round)
        starts[found.round] = nearest_samples(
            *scene, circles.curve, CIRCLE_SAMPLES, at[found.round]
        )
    longest = np.where(found.round, LONGEST_TURN, np.inf)
    return nearest_feet(*scene, found.curve, starts, at, longest)


def _part(found: _Candidates, rows: Mask) -> _Candidates:
    return _Candidates(
        found.pick[rows],
        found.owner[rows],
        found.row[rows],
        found.origin[rows],
        found.first[rows],
        found.second[rows],
        found.round[rows],
    )


def _nearest_of(pick: NDArray[np.intp], distances: Array, total: int) -> NDArray[np.intp]:
    """For every pick the candidate whose curve is nearest, -1 for none that is imaged."""
    best = np.full(total, -1, dtype=np.intp)
    away = np.where(np.isfinite(distances), np.abs(distances), np.inf)
    order = np.argsort(-away, kind="stable")
    order = order[np.isfinite(away[order])]
    # the nearest is written last
    best[pick[order]] = order
    return best


def _moved_points(arms: Array, by_parameters: Array) -> Array:
    """How world points move with the object's tangent, (N, 3, 6 + P), `arms` from its origin."""
    identity = np.broadcast_to(np.eye(3), (len(arms), 3, 3))
    return np.concatenate([-hat(arms), identity, by_parameters], axis=2)


def _stacked(parts: list[Array], width: int = 2) -> Array:
    """Rows below each other; of no part there are none."""
    return np.concatenate(parts) if parts else np.zeros((0, width))
