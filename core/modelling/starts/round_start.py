# SPDX-License-Identifier: GPL-3.0-or-later
"""Picks on the rims and sides of a cylinder, cone or tube in, solids near them out."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from ...arrays import Array
from ...camera import Camera
from ...errors import PickError
from ...reference import ReferencePlane
from ...sketch import Sketch
from ..reverse_mapping import grazing_warnings, points_on_plane
from .counts import refuse_too_few
from .found import Starts, known_parameters, plane_of, rivals, sketch_sizes, things_of
from .held import Grip, Held
from .leaning_round import round_places
from .roles import Picked, round_plan, round_seen
from .seen import HEIGHT, Seen
from .standing_round import StandingRays, cones_on, cylinders_on
from .trials import Trials, best, costs, descended, distinct

# of all guesses so many are descended, in so many steps
STANDING_DESCENTS, CLOSED_FORM_DESCENTS, STANDING_STEPS = 24, 6, 10
DESCENTS, STEPS, LAST_DESCENTS, LAST_STEPS = 24, 6, 6, 20
WALL, THINNEST = 0.75, 0.97
# an end whose axis is nearer than this (a sine) to square to the sight is seen edge-on
EDGE_ON, TILTS = 0.25, (-0.15, -0.06, 0.06, 0.15)
# fits that beat all possible ones by this factor, and this many squared pixels, mean a slip
CLEARLY, NOISE = 4.0, 100.0

Misfit = Callable[[Trials], Array]


def round_starts(
    camera: Camera, sketch: Sketch, picked: Picked, held: Held, sigma_pixels: float
) -> Starts:
    """Solids near the picks `rim` (on the base circle), `top` (on the other) and `sides`.

    A cone that ends in a point has `apex` instead of `top`, a tube `hole` on its inner rim at the
    end that faces the camera.

    Raises PickError, naming object and pick, for picks that can't be such a solid.
    """
    known = known_parameters(sketch, held)
    if sketch.kind == "cone" and len(picked["apex"]):
        known[1] = 0.0
    _refuse_open_height(sketch, picked, held, known)
    refuse_too_few(sketch, picked, held, known)
    seen = round_seen(camera, picked, sketch.kind, held.parameters)

    def misfit(trials: Trials) -> Array:
        return np.concatenate(
            [seen.residuals(trials), held.residuals(trials, seen.origin, seen.focal)], axis=1
        )

    standing = held.standing
    if standing is not None:
        ended = _standing(camera, picked, held, standing, seen, known, misfit)
    else:
        ended = _elsewhere(sketch, seen, held, known, misfit)
    ended = _real(sketch, ended, misfit)
    cost = costs(ended, misfit)
    near = rivals(ended, cost, sigma_pixels)
    if standing is None:
        near = _tilted_too(near, seen, held)
    plan = round_plan(picked, float(seen.facing(near)[0]), sigma_pixels)
    pointed = {"top_radius": 0.0} if known.get(1) == 0.0 and sketch.kind == "cone" else {}
    return Starts(things_of(sketch, near, pointed), plan, _grazing(camera, picked, standing))


def _standing(
    camera: Camera,
    picked: Picked,
    held: Held,
    standing: Grip,
    seen: Seen,
    known: Mapping[int, float],
    misfit: Misfit,
) -> Trials:
    """From closed-form guesses in the plane that it stands on."""
    plane = plane_of(standing)
    on_base = standing.flush == "base"
    rays = _standing_rays(camera, picked, plane, seen, on_base)
    shapes = _shapes(rays, seen, plane, known, on_base)
    if not len(shapes):
        return _nothing(held)
    guesses = _placed(plane, shapes, on_base)
    free = np.array([False] * 3 + [True] * 3 + [i not in known for i in range(held.parameters)])
    closed_form = held.kind != "cone" and len(rays.near) >= 3
    descents = CLOSED_FORM_DESCENTS if closed_form else STANDING_DESCENTS
    return descended(best(guesses, misfit, descents), misfit, free, STANDING_STEPS)


def _elsewhere(
    sketch: Sketch, seen: Seen, held: Held, known: Mapping[int, float], misfit: Misfit
) -> Trials:
    """From a ladder of depths and directions."""
    if not (len(seen.rim) or len(seen.top) or len(seen.points)):
        raise PickError(
            f"{sketch.name}: its sides alone do not tell where it ends; pick points of rim or top"
        )
    if not held.grips and not known:
        raise PickError(
            f"{sketch.name}: nothing tells how large it is: a {sketch.kind} that floats needs a "
            "known size, or a relation"
        )
    guesses = round_places(seen, held, known)
    free = np.array(
        [True, True, False, True, True, True, *(i not in known for i in range(held.parameters))]
    )
    rough = descended(best(guesses, misfit, DESCENTS), misfit, free, STEPS)
    rough = distinct(best(_upright(rough, sketch.kind), misfit, DESCENTS))
    return descended(best(rough, misfit, LAST_DESCENTS), misfit, free, LAST_STEPS)


def _real(sketch: Sketch, ended: Trials, misfit: Misfit) -> Trials:
    """The different ends that can be, best first. Raises PickError where none can."""
    ended = distinct(best(_upright(ended, sketch.kind), misfit, len(ended)))
    if not len(ended):
        raise PickError(
            f"{sketch.name}: no {sketch.kind} in front of the camera comes near these picks"
        )
    # a cone may end in a point
    least = np.array([0.0 if n == "top_radius" else 1e-12 for n in sketch_sizes(sketch)])
    possible = (ended.parameters >= least).all(axis=1)
    cost = costs(ended, misfit)
    if not possible.any() or cost[possible].min() > CLEARLY * cost[0] + NOISE:
        sizes = ", ".join(
            f"{name} {1e3 * value:.1f} mm"
            for name, value in zip(sketch_sizes(sketch), ended.parameters[0], strict=True)
        )
        raise PickError(
            f"{sketch.name}: the picks fit best with {sizes}; check that top is above rim, and the "
            "side the normal points to"
        )
    return ended.chosen(possible)


def _tilted_too(near: Trials, seen: Seen, held: Held) -> Trials:
    """Where an end is seen edge-on its image folds: the exact fit is begun on both sides, too."""
    axis, sight = near.rotation[0, :, 2], near.place[0] - seen.origin
    sight = sight / np.linalg.norm(sight)
    if abs(float(axis @ sight)) > EDGE_ON or any(g.kind == "parallel" for g in held.grips):
        return near
    about = near.rotation[0].T @ np.cross(axis, sight)
    steps = np.zeros((len(TILTS), 6 + held.parameters))
    steps[:, :3] = np.outer(TILTS, about)
    tilted = near.chosen(np.zeros(len(TILTS), dtype=int)).moved(steps)
    return Trials.joined([near, tilted])


def _upright(trials: Trials, kind: str) -> Trials:
    """A circle of negative radius is the same circle; a tube's wall stays a wall."""
    parameters = trials.parameters.copy()
    parameters[:, 0] = np.abs(parameters[:, 0])
    if kind == "tube":
        parameters[:, 1] = np.minimum(np.abs(parameters[:, 1]), THINNEST * parameters[:, 0])
    return Trials(trials.rotation, trials.place, parameters)


def _standing_rays(
    camera: Camera, picked: Picked, plane: ReferencePlane, seen: Seen, on_base: bool
) -> StandingRays:
    near, far = ("rim", seen.top) if on_base else ("top", seen.rim)
    plane_from_world = plane.world_from_plane.inverse()
    points = points_on_plane(camera, plane, picked[near].pixels, picked[near].labels)

    return StandingRays(
        plane_from_world.apply(camera.centre_world),
        plane_from_world.apply(points)[:, :2],
        plane_from_world.rotate(far),
        plane_from_world.rotate(seen.sides),
        plane_from_world.rotate(seen.points),
    )


def _shapes(
    rays: StandingRays,
    seen: Seen,
    plane: ReferencePlane,
    known: Mapping[int, float],
    on_base: bool,
) -> Array:
    """Guesses (M, 2 + P): x and y in the plane's frame, then the parameters."""
    typed = {"height": known[HEIGHT[seen.kind]]} if HEIGHT[seen.kind] in known else {}
    if seen.kind == "cone":
        near, far = (0, 1) if on_base else (1, 0)
        typed |= {name: known[i] for name, i in (("near", near), ("far", far)) if i in known}
        shapes = np.array(list(cones_on(rays, typed))).reshape(-1, 5)
        return shapes if on_base else shapes[:, [0, 1, 3, 2, 4]]
    if 0 in known:
        typed["radius"] = known[0]
    shapes = np.array(list(cylinders_on(rays, typed))).reshape(-1, 4)
    if seen.kind == "cylinder":
        return shapes
    return np.insert(shapes, 3, _inner(shapes, rays, seen, plane, known), axis=1)


def _inner(
    shapes: Array, rays: StandingRays, seen: Seen, plane: ReferencePlane, known: Mapping[int, float]
) -> Array:
    """A tube's inner radius (M,) where the rays of the hole pierce the far end."""
    if 1 in known or not len(seen.hole):
        return np.full(len(shapes), known.get(1, 0.0)) if 1 in known else WALL * shapes[:, 2]
    hole = plane.world_from_plane.inverse().rotate(seen.hole)
    with np.errstate(divide="ignore", invalid="ignore"):
        depth = (shapes[:, 3] - rays.origin[2])[:, None] / hole[:, 2]
    points = rays.origin[:2] + depth[:, :, None] * hole[:, :2]
    away = np.linalg.norm(points - shapes[:, None, :2], axis=2)
    inner: Array = np.minimum(np.median(away, axis=1), 0.95 * shapes[:, 2])
    return inner


def _placed(plane: ReferencePlane, shapes: Array, on_base: bool) -> Trials:
    frame = plane.world_from_plane
    # hanging from the plane, its z points the other way
    turn = frame.rotation @ np.diag([1.0, 1.0, 1.0] if on_base else [1.0, -1.0, -1.0])
    middles = np.column_stack([shapes[:, :2], shapes[:, -1] / 2])
    rotation = np.broadcast_to(turn, (len(shapes), 3, 3)).copy()
    return Trials(rotation, frame.apply(middles), shapes[:, 2:])


def _nothing(held: Held) -> Trials:
    return Trials(np.zeros((0, 3, 3)), np.zeros((0, 3)), np.zeros((0, held.parameters)))


def _refuse_open_height(
    sketch: Sketch, picked: Picked, held: Held, known: Mapping[int, float]
) -> None:
    """A rim and sides do not end anywhere."""
    far = "rim" if held.standing is not None and held.standing.flush == "top" else "top"
    seen = len(picked[far]) + len(picked.get("apex", ())) + len(picked.get("hole", ()))
    if not seen and HEIGHT[sketch.kind] not in known:
        raise PickError(
            f"{sketch.name}: nothing tells its height; pick a point of {far}, or give height"
        )


def _grazing(camera: Camera, picked: Picked, standing: Grip | None) -> tuple[str, ...]:
    if standing is None:
        return ()
    near = picked["rim" if standing.flush == "base" else "top"]
    return tuple(grazing_warnings(camera, plane_of(standing), near.pixels, near.labels))
