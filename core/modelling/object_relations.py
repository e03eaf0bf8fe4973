# SPDX-License-Identifier: GPL-3.0-or-later
"""Relations of one whole object to another, of the same size or its mirror image, as equations."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..arrays import Array
from ..errors import InvalidValue
from ..primitives import Primitive
from ..relation import Relation
from ..shape.features import Feature, feature
from .held_rows import RelationRows, across_of


def _same_size(
    relation: Relation, own: Primitive, to: Primitive, about: Feature | None
) -> RelationRows:
    if relation.own is None:
        if own.kind != to.kind or len(own.parameters) != len(to.parameters):
            raise InvalidValue(
                f"{own.name}: a {own.kind} can't be of the same size as {to.name}, a {to.kind}; "
                "name the size that they share in `own`"
            )
        names = None
    else:
        names = relation.own
        for thing in (own, to):
            if names not in thing.size_names:
                raise InvalidValue(
                    f"{thing.name}: a {thing.kind} has no size {names!r}; it has "
                    f"{', '.join(thing.size_names)}"
                )
    mine, other = _size_rows(own, names), _size_rows(to, names)
    return RelationRows(mine[:, 6:] @ own.parameters - other[:, 6:] @ to.parameters, mine, -other)


def _size_rows(thing: Primitive, name: str | None) -> Array:
    whole = np.eye(6 + len(thing.parameters))[6:]
    return whole if name is None else whole[[thing.size_names.index(name)]]


def _symmetric(
    relation: Relation, own: Primitive, to: Primitive, about: Feature | None
) -> RelationRows:
    """The middle and the axes are the other's, mirrored; the sizes are the same."""
    assert about is not None
    sizes = _same_size(Relation("same_size", relation.to), own, to, None)
    parts = [sizes, _mirrored_middle(own, to, about)]
    if own.kind != "sphere":
        parts.append(_mirrored_axis(own, to, about, "axis"))
    if own.kind == "box":
        parts.append(_mirrored_axis(own, to, about, "axis_x"))
    width = about.by_point.shape[1]
    return RelationRows(
        np.concatenate([p.values for p in parts]),
        np.vstack([p.by_own for p in parts]),
        np.vstack([p.by_to for p in parts]),
        np.vstack(
            [np.zeros((len(p.values), width)) if p.by_about is None else p.by_about for p in parts]
        ),
    )


def _mirrored_middle(own: Primitive, to: Primitive, about: Feature) -> RelationRows:
    middle, other, normal = feature(own, "centre"), feature(to, "centre"), about.direction
    mirror = np.eye(3) - 2 * np.outer(normal, normal)
    gap = other.point - about.point
    by_normal = -2 * (np.eye(3) * (normal @ gap) + np.outer(normal, gap))
    by_about = by_normal @ about.by_direction + 2 * np.outer(normal, normal) @ about.by_point
    return RelationRows(
        middle.point - about.point - mirror @ gap,
        middle.by_point,
        -mirror @ other.by_point,
        -by_about,
    )


def _mirrored_axis(own: Primitive, to: Primitive, about: Feature, name: str) -> RelationRows:
    axis, other, normal = feature(own, name), feature(to, name), about.direction
    mirror = np.eye(3) - 2 * np.outer(normal, normal)
    image = mirror @ other.direction
    same = 1.0 if axis.direction @ image > 0 else -1.0
    across = across_of(image)
    by_normal = -2 * (np.eye(3) * (normal @ other.direction) + np.outer(normal, other.direction))
    return RelationRows(
        across @ (axis.direction - same * image),
        across @ axis.by_direction,
        -same * across @ mirror @ other.by_direction,
        -same * across @ by_normal @ about.by_direction,
    )


ObjectRows = Callable[[Relation, Primitive, Primitive, Feature | None], RelationRows]
OBJECT_ROWS: dict[str, ObjectRows] = {"same_size": _same_size, "symmetric": _symmetric}
