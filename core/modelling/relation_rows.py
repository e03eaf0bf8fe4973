# SPDX-License-Identifier: GPL-3.0-or-later
"""A relation between two things in, the equations that hold when it is kept out.

Each equation is zero where the relation holds, and comes with its derivatives by the tangents of
both: objects as in `Primitive.covariance`, references by (rotation vector about their point, motion
of the point).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..arrays import Array
from ..errors import InvalidValue
from ..primitives import Primitive
from ..reference import ReferenceLine, ReferencePlane
from ..relation import Relation
from ..rotation import hat
from ..shape.features import Feature, feature
from .held_rows import RelationRows, across_of
from .object_relations import OBJECT_ROWS
from .support import lowest_points

Held = Primitive | ReferencePlane | ReferenceLine


def relation_rows(
    relation: Relation, own: Primitive, to: Feature | Primitive, about: Feature | None = None
) -> RelationRows:
    """The equations of a relation of `own` to a feature, or for a whole object to that.

    Raises InvalidValue for what such a relation can't mean, naming the object.
    """
    if isinstance(to, Primitive):
        return OBJECT_ROWS[relation.kind](relation, own, to, about)
    return FEATURE_ROWS[relation.kind](relation, own, to)


def reference_feature(reference: ReferencePlane | ReferenceLine) -> Feature:
    """A reference as a feature, its tangent the six of its covariance."""
    plane = isinstance(reference, ReferencePlane)
    direction = reference.normal if isinstance(reference, ReferencePlane) else reference.direction
    none = np.zeros((3, 3))
    return Feature(
        "plane" if plane else "line",
        reference.point,
        direction,
        np.hstack([none, np.eye(3)]),
        np.hstack([-hat(direction), none]),
    )


def _stands(relation: Relation, own: Primitive, to: Feature) -> RelationRows:
    if own.kind == "sphere":
        return _touches(relation, own, to)
    return _flush(relation, own, feature(own, relation.own or "base"), to)


def _lies(relation: Relation, own: Primitive, to: Feature) -> RelationRows:
    _need(own, relation, to, "plane")
    if own.kind not in ("cylinder", "cone", "tube"):
        raise InvalidValue(
            f"{own.name}: a {own.kind} does not lie on its side; let it stand on one of its faces "
            "(stands_on with own)"
        )
    points, by_points = lowest_points(own, -to.direction, both_ends=True)
    return _points_on_plane(points, by_points, to)


def _leans(relation: Relation, own: Primitive, to: Feature) -> RelationRows:
    if relation.own is None:
        return _touches(relation, own, to)
    return _flush(relation, own, feature(own, relation.own), to)


def _touches(relation: Relation, own: Primitive, to: Feature) -> RelationRows:
    if to.kind == "line":
        return _touches_line(relation, own, to)
    _need(own, relation, to, "plane")
    if relation.own is None:
        return _points_on_plane(*lowest_points(own, -to.direction, both_ends=False), to)
    part = feature(own, relation.own)
    if part.kind == "plane":
        return _flush(relation, own, part, to)
    rows = _points_on_plane(part.point[None], part.by_point[None], to)
    if part.kind == "point":
        return rows
    along = _stacked_rows(part, to, to.direction[None], 0.0)
    return RelationRows(
        np.append(rows.values, along.values),
        np.vstack([rows.by_own, along.by_own]),
        np.vstack([rows.by_to, along.by_to]),
    )


def _touches_line(relation: Relation, own: Primitive, to: Feature) -> RelationRows:
    """A ball's middle, or a cylinder's axis, is its radius away from the line."""
    if own.kind not in ("sphere", "cylinder", "tube"):
        raise InvalidValue(
            f"{own.name}: a {own.kind} touches a plane, and {relation.to} is a line; "
            "balls and cylinders touch lines"
        )
    middle = feature(own, "centre")
    gap = middle.point - to.point
    across = gap - to.direction * (gap @ to.direction)
    by_radius = np.zeros(middle.by_point.shape[1])
    by_radius[6] = 1.0
    if own.kind == "sphere":
        away = float(np.linalg.norm(across))
        out = across / max(away, 1e-12)
        by_own = out @ middle.by_point - by_radius
        by_to = -out @ to.by_point - (gap @ to.direction) * (out @ to.by_direction)
    else:
        axis = feature(own, "axis")
        normal = np.cross(axis.direction, to.direction)
        length = float(np.linalg.norm(normal))
        if length < 1e-9:
            raise InvalidValue(f"{own.name}: its axis is parallel to {relation.to}; say `parallel`")
        side = 1.0 if normal @ gap > 0 else -1.0
        out = side * normal / length
        away = float(out @ gap)
        # only the part of the gap across the common normal turns with it
        turn = side * (gap - out * away) / length
        by_own = out @ middle.by_point - by_radius
        by_own = by_own + turn @ (-hat(to.direction)) @ axis.by_direction
        by_to = -out @ to.by_point + turn @ hat(axis.direction) @ to.by_direction
    radius = float(own.parameters[0])
    return RelationRows(np.array([away - radius]), by_own[None], by_to[None])


def _parallel(relation: Relation, own: Primitive, to: Feature) -> RelationRows:
    axis = feature(own, relation.own or _default_axis(own, relation))
    same = 1.0 if axis.direction @ to.direction > 0 else -1.0
    return _stacked_rows(axis, to, across_of(to.direction), -same)


def _perpendicular(relation: Relation, own: Primitive, to: Feature) -> RelationRows:
    axis = feature(own, relation.own or _default_axis(own, relation))
    return RelationRows(
        np.array([axis.direction @ to.direction]),
        (to.direction @ axis.by_direction)[None],
        (axis.direction @ to.by_direction)[None],
    )


def _centred(relation: Relation, own: Primitive, to: Feature) -> RelationRows:
    middle = feature(own, relation.own or "centre")
    across = np.eye(3) if to.kind == "point" else across_of(to.direction)
    gap = middle.point - to.point
    along = 0.0 if to.kind == "point" else float(gap @ to.direction)
    return RelationRows(
        across @ gap,
        across @ middle.by_point,
        -across @ to.by_point - along * across @ to.by_direction,
    )


def _flush(relation: Relation, own: Primitive, face: Feature, to: Feature) -> RelationRows:
    """A face against a plane: its middle on the plane, its normal along the plane's."""
    _need(own, relation, to, "plane")
    if face.kind != "plane":
        raise InvalidValue(
            f"{own.name}: {relation.kind} {relation.to} with its {relation.own}, which is a "
            f"{face.kind}; only a face lies flush on a plane"
        )
    same = 1.0 if face.direction @ to.direction > 0 else -1.0
    turned = _stacked_rows(face, to, across_of(to.direction), -same)
    placed = _points_on_plane(face.point[None], face.by_point[None], to)
    return RelationRows(
        np.append(placed.values, turned.values),
        np.vstack([placed.by_own, turned.by_own]),
        np.vstack([placed.by_to, turned.by_to]),
    )


def _points_on_plane(points: Array, by_points: Array, to: Feature) -> RelationRows:
    gap = points - to.point
    return RelationRows(
        gap @ to.direction,
        to.direction @ by_points,
        gap @ to.by_direction - to.direction @ to.by_point,
    )


def _stacked_rows(own: Feature, to: Feature, across: Array, factor: float) -> RelationRows:
    """`across . (own direction + factor times the other's)`, each row of `across` (M, 3) held.

    With factor 0 the rows themselves turn with the other.
    """
    if factor == 0.0:
        return RelationRows(
            across @ own.direction, across @ own.by_direction, own.direction[None] @ to.by_direction
        )
    return RelationRows(
        across @ (own.direction + factor * to.direction),
        across @ own.by_direction,
        factor * across @ to.by_direction,
    )


def _default_axis(own: Primitive, relation: Relation) -> str:
    if own.kind == "sphere":
        raise InvalidValue(f"{own.name}: a sphere has no axis to be {relation.kind} to something")
    return "axis"


def _need(own: Primitive, relation: Relation, to: Feature, kind: str) -> None:
    if to.kind != kind:
        raise InvalidValue(
            f"{own.name}: {relation.kind} needs a {kind}, and {relation.to} is a {to.kind}"
        )


FEATURE_ROWS: dict[str, Callable[[Relation, Primitive, Feature], RelationRows]] = {
    "stands_on": _stands,
    "lies_on": _lies,
    "leans_on": _leans,
    "touches": _touches,
    "parallel": _parallel,
    "perpendicular": _perpendicular,
    "centred_on": _centred,
}
