# SPDX-License-Identifier: GPL-3.0-or-later
"""What holds an object in, how far any guess of it is from being held so out.

The same relations as `core.modelling.relation_rows`, for many guesses at once and without exact
derivatives: springs that bring a start near to where the exact equations take over.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...arrays import Array
from ...pose import Pose
from ...primitives import KINDS, Box, Primitive, Prism
from ...relation import Relation
from ...rotation import hat
from ...shape.features import Feature
from ...sketch import Sketch
from ..holding import PLACING, References, as_feature, holds_of
from .own_parts import OwnPart, own_part
from .seen import HEIGHT, TOP_RADIUS
from .trials import Trials

# a milliradian (or its length at the object) off its relations costs as much as 30 of a pick
STIFFNESS = 30.0
ROUND = ("cylinder", "cone", "tube")


@dataclass(frozen=True, eq=False)
class Grip:
    """One relation to a plane, line or point: its `name`, kind, the object's own feature if any."""

    name: str
    kind: str
    own: str | None
    to: Feature

    @property
    def flush(self) -> str | None:
        """The face that lies against a plane, if this says so."""
        if self.to.kind != "plane":
            return None
        if self.kind == "stands_on":
            return self.own or "base"
        return self.own if self.kind in ("leans_on", "touches") and self.own else None


@dataclass(frozen=True, eq=False)
class Held:
    """All that holds one object of a kind with `parameters` numbers.

    `others` are objects it is of the same size as, or the mirror image of, with the relation.
    """

    kind: str
    parameters: int
    grips: tuple[Grip, ...]
    others: tuple[tuple[Relation, Primitive, Feature | None], ...] = ()

    @property
    def standing(self) -> Grip | None:
        """The plane that the object stands on by its base or its top."""
        for grip in self.grips:
            if grip.flush in ("base", "top"):
                return grip
        return None

    def residuals(self, trials: Trials, origin: Array, focal: float) -> Array:
        """How far each guess is from being held, (M, R), stiffly, in pixels as seen."""
        if not self.grips:
            return np.zeros((len(trials), 0))
        away = np.linalg.norm(trials.place - origin, axis=1)[:, None]
        parts = []
        for grip in self.grips:
            metres, radians = _rows(self, grip, trials)
            parts += [metres / away, radians]
        return STIFFNESS * focal * np.concatenate(parts, axis=1)


def held_by(
    sketch: Sketch, parameters: int, references: References, things: Mapping[str, Primitive]
) -> Held:
    """What holds the object of a sketch.

    Raises InvalidValue for a name that is not there, and for what such a relation can't mean.
    """
    grips, others = [], []
    own = _any_of(sketch, parameters)
    for hold in holds_of(sketch, references, list(things)):
        relation = hold.relation
        # what means nothing is refused by the exact relation, in words
        hold.rows({**things, sketch.name: own}, references)
        if relation.kind in ("same_size", "symmetric"):
            about = None if hold.about is None else as_feature(hold.about, things, references)
            others.append((relation, things[hold.to.name], about))
            continue
        to = as_feature(hold.to, things, references)
        kind = "touches" if sketch.kind == "sphere" and relation.kind in PLACING else relation.kind
        grips.append(Grip(relation.to, kind, relation.own, to))
    return Held(sketch.kind, parameters, tuple(grips), tuple(others))


def _any_of(sketch: Sketch, parameters: int) -> Primitive:
    """Some object of the kind, at no special angle to anything."""
    pose = Pose.from_rotation_vector([0.31, -0.47, 0.59], [0.13, 0.17, 0.19])
    if sketch.kind == "box":
        return Box(sketch.name, pose, size=np.ones(3))
    if sketch.kind == "prism":
        count = max((parameters - 1) // 2, 3)
        angle = 2 * np.pi * np.arange(count) / count
        around = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        return Prism(sketch.name, pose, polygon=around, height=1.0)
    names = KINDS[sketch.kind].size_names
    sizes: dict[str, Any] = {name: 0.5 if name == "inner_radius" else 1.0 for name in names}
    return KINDS[sketch.kind](sketch.name, pose, **sizes)


Rows = tuple[Array, Array]


def _rows(held: Held, grip: Grip, trials: Trials) -> Rows:
    """What is off in metres (M, A) and in radians (M, B)."""
    return ROWS[grip.kind](held, grip, trials)


def _flush(held: Held, grip: Grip, trials: Trials) -> Rows:
    part = own_part(held.kind, held.parameters, grip.flush or "base")
    gaps = _gaps(trials.points(part.spans), grip.to)
    if part.direction is None:
        return gaps, _none(trials)
    return gaps, trials.rotation @ part.direction @ hat(grip.to.direction)


def _lies(held: Held, grip: Grip, trials: Trials) -> Rows:
    return np.stack(_ends(held, trials, grip.to), axis=1), _none(trials)


def _touches(held: Held, grip: Grip, trials: Trials) -> Rows:
    if grip.to.kind == "line":
        return _touches_line(trials, grip.to), _none(trials)
    if grip.own is not None:
        part = own_part(held.kind, held.parameters, grip.own)
        if part.sort == "plane":
            return _flush(held, grip, trials)
        gap = _gaps(trials.points(part.by[None]), grip.to)
        if part.direction is None:
            return gap, _none(trials)
        return gap, (trials.rotation @ part.direction @ grip.to.direction)[:, None]
    return _lowest(held, trials, grip.to)[:, None], _none(trials)


def _lowest(held: Held, trials: Trials, plane: Feature) -> Array:
    """How high the lowest point of each guess is over a plane, (M,)."""
    if held.kind == "sphere":
        return _gaps(trials.place[:, None], plane)[:, 0] - trials.parameters[:, 0]
    if held.kind in ROUND:
        lowest: Array = np.minimum(*_ends(held, trials, plane))
        return lowest
    ends = [own_part(held.kind, held.parameters, end).spans for end in ("base", "top")]
    low: Array = _gaps(trials.points(np.concatenate(ends)), plane).min(axis=1)
    return low


def _ends(held: Held, trials: Trials, plane: Feature) -> tuple[Array, Array]:
    """How high the lowest points of both rims are over a plane."""
    axis = trials.rotation[:, :, 2]
    along = axis @ plane.direction
    across = np.sqrt(np.maximum(1 - along**2, 0.0))
    middle = (trials.place - plane.point) @ plane.direction
    half = trials.parameters[:, HEIGHT[held.kind]] / 2 * along
    top = trials.parameters[:, TOP_RADIUS[held.kind]]
    return middle - half - trials.parameters[:, 0] * across, middle + half - top * across


def _touches_line(trials: Trials, line: Feature) -> Array:
    gap = trials.place - line.point
    if trials.parameters.shape[1] == 1:
        away = np.linalg.norm(np.cross(gap, line.direction), axis=1)
    else:
        normal = np.cross(trials.rotation[:, :, 2], line.direction)
        length = np.maximum(np.linalg.norm(normal, axis=1), 1e-9)
        away = np.abs((normal * gap).sum(axis=1)) / length
    beyond: Array = (away - trials.parameters[:, 0])[:, None]
    return beyond


def _parallel(held: Held, grip: Grip, trials: Trials) -> Rows:
    return _none(trials), trials.rotation @ _direction(held, grip) @ hat(grip.to.direction)


def _perpendicular(held: Held, grip: Grip, trials: Trials) -> Rows:
    along = trials.rotation @ _direction(held, grip) @ grip.to.direction
    return _none(trials), along[:, None]


def _centred(held: Held, grip: Grip, trials: Trials) -> Rows:
    part = own_part(held.kind, held.parameters, grip.own or "centre")
    gap = trials.points(part.by[None])[:, 0] - grip.to.point
    if grip.to.kind == "point":
        return gap, _none(trials)
    return gap @ hat(grip.to.direction), _none(trials)


def _gaps(points: Array, plane: Feature) -> Array:
    gaps: Array = (points - plane.point) @ plane.direction
    return gaps


def _direction(held: Held, grip: Grip) -> Array:
    part: OwnPart = own_part(held.kind, held.parameters, grip.own or "axis")
    return np.array([0.0, 0.0, 1.0]) if part.direction is None else part.direction


def _none(trials: Trials) -> Array:
    return np.zeros((len(trials), 0))


ROWS: dict[str, Callable[[Held, Grip, Trials], Rows]] = {
    "stands_on": _flush,
    "lies_on": _lies,
    "leans_on": _touches,
    "touches": _touches,
    "parallel": _parallel,
    "perpendicular": _perpendicular,
    "centred_on": _centred,
}
