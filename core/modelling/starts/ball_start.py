# SPDX-License-Identifier: GPL-3.0-or-later
"""Picks on a ball's outline in, balls near them out.

An outline gives the centre in radii, `C / r`, in closed form: a known radius, the plane it lies on
or the line it touches tells the radius.
"""

from __future__ import annotations

import numpy as np

from ...arrays import Array
from ...ball.sphere import sphere_from_rays
from ...camera import Camera
from ...errors import PickError, SphereNotFound
from ...sketch import Sketch
from .counts import refuse_too_few
from .found import Starts, known_parameters, rivals, things_of
from .held import Grip, Held
from .roles import Picked, round_plan, round_seen
from .seen import Seen
from .trials import Trials, best, costs, descended, distinct

# guesses of a radius that two picks leave open, in shares of the distance
RADII = (0.01, 0.03, 0.08, 0.2)
# a ball no nearer than this many radii is seen from outside
NEAREST = 1.001


def ball_starts(
    camera: Camera, sketch: Sketch, picked: Picked, held: Held, sigma_pixels: float
) -> Starts:
    """Balls near the picks `outline`: floating with a known radius, or held, the radius solved.

    Raises PickError for picks that are no outline, or for a ball of which nothing tells the size.
    """
    known = known_parameters(sketch, held)
    seen = round_seen(camera, picked, "sphere", 1)
    if 0 not in known and not held.grips:
        raise PickError(
            f"{sketch.name}: nothing tells how large it is: a ball that floats needs its radius, "
            "or say what it lies on or touches"
        )
    refuse_too_few(sketch, picked, held, known)
    guesses = _guesses(sketch, seen, held, known.get(0))

    def residuals(trials: Trials) -> Array:
        return np.concatenate(
            [seen.residuals(trials), held.residuals(trials, seen.origin, seen.focal)], axis=1
        )

    free = np.array([False] * 3 + [True] * 3 + [0 not in known])
    ended = descended(best(guesses, residuals, 6), residuals, free, 20)
    ended = ended.chosen(ended.parameters[:, 0] > 0)
    ended = distinct(best(ended, residuals, len(ended)))
    if not len(ended):
        raise PickError(
            f"{sketch.name}: no ball in front of the camera comes near these picks; check the side "
            "of what it touches, and its radius"
        )
    cost = costs(ended, residuals)
    plan = round_plan(picked, 1.0, sigma_pixels)
    return Starts(things_of(sketch, rivals(ended, cost, sigma_pixels)), plan)


def _guesses(sketch: Sketch, seen: Seen, held: Held, radius: float | None) -> Trials:
    if len(seen.outline) < 3:
        return _from_few(seen, held, radius)
    try:
        centre = sphere_from_rays(seen.outline, 1.0)
    except SphereNotFound as error:
        raise PickError(
            f"{sketch.name}: outline[0] to outline[{len(seen.outline) - 1}]: {error}"
        ) from None
    radii = [radius] if radius is not None else _radii(centre, seen, held)
    if not radii:
        raise PickError(
            f"{sketch.name}: seen so, no ball can touch {held.grips[0].name}; check its place and "
            "the side its normal points to"
        )
    size = np.array(radii)[:, None]
    return _balls(seen.origin + size * centre, size)


def _radii(centre: Array, seen: Seen, held: Held) -> list[float]:
    """Radii that bring a ball at `radius * centre` from the eye to what holds it."""
    found: list[float] = []
    for grip in held.grips:
        found += [r for r in _radii_of(grip, centre, seen.origin) if r > 0]
        if found:
            break
    return found


def _radii_of(grip: Grip, centre: Array, origin: Array) -> list[float]:
    gap = grip.to.point - origin
    if grip.to.kind == "plane" and grip.kind == "touches":
        rate = float(grip.to.direction @ centre) - 1
        return [float(grip.to.direction @ gap) / rate] if abs(rate) > 1e-12 else []
    if grip.to.kind == "point":
        return [float(gap @ centre / (centre @ centre))]
    across = np.eye(3) - np.outer(grip.to.direction, grip.to.direction)
    to, off = across @ centre, across @ gap
    if grip.kind == "centred_on":
        return [float(off @ to / (to @ to))]
    # |radius to - off| = radius
    a, b, c = float(to @ to) - 1, float(to @ off), float(off @ off)
    root = b * b - a * c
    if abs(a) < 1e-12 or root < 0:
        return [b / (a + 1.0)]
    return [(b + sign * float(np.sqrt(root))) / a for sign in (-1.0, 1.0)]


def _from_few(seen: Seen, held: Held, radius: float | None) -> Trials:
    """Balls about the middle of one or two picks, wherever what holds it puts them."""
    middle = seen.outline.mean(axis=0)
    middle = middle / np.linalg.norm(middle)
    spread = max(float(np.arccos(np.clip((seen.outline @ middle).min(), -1, 1))), 0.005)
    shares = RADII if len(seen.outline) < 2 else (spread, 1.5 * spread, 3 * spread)
    parts = []
    for share in shares:
        # an angle off the middle, so that a pick on one side alone leads to either
        for depth in _depths(seen, held, middle, radius, share):
            size = radius if radius is not None else share * depth
            for turn in (0.0, 2.1, 4.2):
                one = np.cross(middle, np.eye(3)[int(np.argmin(np.abs(middle)))])
                one = one / np.linalg.norm(one)
                aside = np.cos(turn) * one + np.sin(turn) * np.cross(middle, one)
                place = seen.origin + depth * middle + 0.5 * size * aside
                parts.append(_balls(place[None], np.array([[size]])))
    return Trials.joined(parts)


def _depths(
    seen: Seen, held: Held, middle: Array, radius: float | None, share: float
) -> list[float]:
    found = [radius / share] if radius is not None else []
    for grip in held.grips:
        found += [r / share for r in _radii_of(grip, middle / share, seen.origin) if r > 0]
    return found or [1.0]


def _balls(places: Array, radii: Array) -> Trials:
    return Trials(np.broadcast_to(np.eye(3), (len(places), 3, 3)).copy(), places, radii)
