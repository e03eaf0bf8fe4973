# SPDX-License-Identifier: GPL-3.0-or-later
"""A solid and the name of a face, edge or axis in, the plane, line or point with derivatives out.

| kind | planes | lines | points |
|---|---|---|---|
| all but sphere | `base`, `top` (not of a cone that ends in a point) | `axis` | `centre` |
| box | `x-` `x+` `y-` `y+` | `axis_x`, `axis_y`; edges by their faces: `x+y-`, `x+top` | |
| prism | `side0` (corner 0 to corner 1), `side1`, ... | `edge0` (upright, at corner 0), ... | |
| sphere | | | `centre` |
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from itertools import product
from typing import Literal

import numpy as np

from ..arrays import Array
from ..errors import InvalidValue
from ..primitives import Box, Cone, Primitive, Prism, Sphere
from ..rotation import hat

FeatureKind = Literal["plane", "line", "point"]


@dataclass(frozen=True, eq=False)
class Feature:
    """A plane, line or point of an object, in the world.

    `point` (3,) is the middle of a face, a point of a line, or the point itself; `direction` (3,)
    a face's outward unit normal, a line's unit direction, and the object's z axis for a point.
    `by_point` and `by_direction` (3, 6 + P) are their derivatives by the object's tangent: rotation
    vector in world axes about the object's own origin, motion of the origin, then `parameters`.
    """

    kind: FeatureKind
    point: Array
    direction: Array
    by_point: Array
    by_direction: Array


@dataclass(frozen=True, eq=False)
class _Local:
    """A feature in the object's own frame, with its derivatives (3, P) by the parameters."""

    kind: FeatureKind
    point: Array
    direction: Array
    by_point: Array
    by_direction: Array


_Table = dict[str, Callable[[], _Local]]


def feature_names(thing: Primitive) -> tuple[str, ...]:
    """The names that `feature` knows for this object."""
    return tuple(_table(thing))


def feature(thing: Primitive, name: str) -> Feature:
    """The feature of that name, in the world.

    A prism's derivatives are by its raw parameters with the frame held: a moved corner does not
    move the origin here, as it does in `with_parameters`.

    Raises InvalidValue for a name that this object does not have, listing those it has.
    """
    table = _table(thing)
    if name not in table:
        raise InvalidValue(
            f"{thing.name}: a {thing.kind} has no feature {name!r}; it has {', '.join(table)}"
        )
    local, pose = table[name](), thing.world_from_object
    arm, direction = pose.rotate(local.point), pose.rotate(local.direction)
    by_point = [-hat(arm), np.eye(3), pose.rotation @ local.by_point]
    by_direction = [-hat(direction), np.zeros((3, 3)), pose.rotation @ local.by_direction]
    return Feature(
        local.kind, pose.apply(local.point), direction, np.hstack(by_point), np.hstack(by_direction)
    )


def _table(thing: Primitive) -> _Table:
    """What computes each feature; nothing is computed before it is asked for."""
    count = len(thing.parameters)
    if isinstance(thing, Sphere):
        return {"centre": partial(_held, "point", 2, count)}
    if isinstance(thing, Box):
        return _box_table(thing)
    height = thing.size_names.index("height")
    pointed = isinstance(thing, Cone) and thing.top_radius == 0
    table: _Table = {
        name: partial(_end, side, thing.parameters[height], height, count)
        for name, side in (("base", -1.0), ("top", 1.0))
        if not (pointed and name == "top")
    }
    table["axis"] = partial(_held, "line", 2, count)
    table["centre"] = partial(_held, "point", 2, count)
    if isinstance(thing, Prism):
        corners = range(len(thing.polygon))
        table |= {f"side{i}": partial(_prism_side, thing, i) for i in corners}
        table |= {f"edge{i}": partial(_prism_edge, thing, i) for i in corners}
    return table


def _box_table(box: Box) -> _Table:
    faces = {"base": (2, -1.0), "top": (2, 1.0)}
    faces |= {f"{axis}{sign}": (i, s) for i, axis in enumerate("xy") for sign, s in _SIGNS.items()}
    table: _Table = {name: partial(_box_part, box, "plane", (at,)) for name, at in faces.items()}
    pairs = [(f"x{s}", f"y{t}") for s, t in product(_SIGNS, _SIGNS)]
    pairs += [(f"{a}{s}", end) for a, s, end in product("xy", _SIGNS, ("base", "top"))]
    table |= {
        one + two: partial(_box_part, box, "line", (faces[one], faces[two])) for one, two in pairs
    }
    axes = {"axis_x": 0, "axis_y": 1, "axis": 2}
    table |= {name: partial(_held, "line", axis, 3) for name, axis in axes.items()}
    return table | {"centre": partial(_held, "point", 2, 3)}


_SIGNS = {"-": -1.0, "+": 1.0}


def _held(kind: FeatureKind, axis: int, count: int) -> _Local:
    """What stays in the object's frame whatever its sizes."""
    return _Local(kind, np.zeros(3), np.eye(3)[axis], np.zeros((3, count)), np.zeros((3, count)))


def _end(side: float, height: float, column: int, count: int) -> _Local:
    by_point = np.zeros((3, count))
    by_point[2, column] = side / 2
    z = np.array([0.0, 0.0, 1.0])
    return _Local("plane", side * height / 2 * z, side * z, by_point, np.zeros((3, count)))


def _box_part(box: Box, kind: FeatureKind, at: tuple[tuple[int, float], ...]) -> _Local:
    """A face, on one side (axis, sign), or an edge, between two; an edge runs along +axis."""
    point, by_point = np.zeros(3), np.zeros((3, 3))
    for axis, sign in at:
        point[axis] = sign * box.size[axis] / 2
        by_point[axis, axis] = sign / 2
    if kind == "plane":
        direction = at[0][1] * np.eye(3)[at[0][0]]
    else:
        direction = np.eye(3)[3 - at[0][0] - at[1][0]]
    return _Local(kind, point, direction, by_point, np.zeros((3, 3)))


def _prism_side(prism: Prism, i: int) -> _Local:
    j = (i + 1) % len(prism.polygon)
    along = prism.polygon[j] - prism.polygon[i]
    length = float(np.linalg.norm(along))
    # the polygon goes anticlockwise, so that outside lies to the right of the way along it
    turned = np.array([[0.0, 1.0], [-1.0, 0.0]])
    normal = turned @ along / length
    by_along = (np.eye(2) - np.outer(normal, normal)) @ turned / length
    by_point, by_direction = np.zeros((2, 3, len(prism.parameters)))
    for corner, sign in ((i, -1.0), (j, 1.0)):
        columns = slice(1 + 2 * corner, 3 + 2 * corner)
        by_point[:2, columns] = np.eye(2) / 2
        by_direction[:2, columns] = sign * by_along
    middle = (prism.polygon[i] + prism.polygon[j]) / 2
    return _Local("plane", np.append(middle, 0.0), np.append(normal, 0.0), by_point, by_direction)


def _prism_edge(prism: Prism, i: int) -> _Local:
    count = len(prism.parameters)
    by_point = np.zeros((3, count))
    by_point[:2, 1 + 2 * i : 3 + 2 * i] = np.eye(2)
    point = np.append(prism.polygon[i], 0.0)
    return _Local("line", point, np.array([0.0, 0.0, 1.0]), by_point, np.zeros((3, count)))
