# SPDX-License-Identifier: GPL-3.0-or-later
"""What holds each object: its relations with the names they speak of looked up.

A name is a reference of the cell (`table`), an object (`crate`), or a feature of one (`crate.top`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from ..errors import InvalidValue
from ..primitives import Primitive
from ..reference import ReferenceLine, ReferencePlane
from ..relation import RELATIONS, Relation
from ..shape.features import Feature, feature
from ..sketch import Sketch
from .held_rows import RelationRows
from .relation_rows import reference_feature, relation_rows

PLACING = ("stands_on", "lies_on", "leans_on", "touches")
References = Mapping[str, ReferencePlane | ReferenceLine]


@dataclass(frozen=True)
class Target:
    """What a relation speaks of: a `reference`, or an `object` and perhaps a feature of it."""

    name: str
    is_object: bool
    feature: str | None = None

    @property
    def key(self) -> tuple[str, str]:
        """What tells it from all others: its sort and its name."""
        return ("object" if self.is_object else "reference", self.name)


@dataclass(frozen=True)
class Hold:
    """One relation of one object, with its targets."""

    own: str
    relation: Relation
    to: Target
    about: Target | None = None

    def rows(self, things: Mapping[str, Primitive], references: References) -> RelationRows:
        """The equations as things stand."""
        about = None if self.about is None else as_feature(self.about, things, references)
        to: Feature | Primitive = (
            things[self.to.name]
            if self.relation.kind in ("same_size", "symmetric")
            else as_feature(self.to, things, references)
        )
        if about is not None and about.kind != "plane":
            raise InvalidValue(f"{self.own}: symmetric about a {about.kind}; name a plane")
        return relation_rows(self.relation, things[self.own], to, about)

    @property
    def targets(self) -> tuple[Target, ...]:
        return (self.to,) if self.about is None else (self.to, self.about)


def relations_of(thing: Primitive | Sketch) -> tuple[Relation, ...]:
    """All relations of an object: `on` says that it stands there, unless a relation says how."""
    if thing.on is None or any(r.to == thing.on and r.kind in PLACING for r in thing.relations):
        return thing.relations
    return (Relation("stands_on", thing.on), *thing.relations)


def holds_of(
    thing: Primitive | Sketch, references: References, objects: Sequence[str]
) -> tuple[Hold, ...]:
    """The relations of one object. Raises InvalidValue for a name that is not there."""
    holds = []
    for relation in relations_of(thing):
        about = None
        if relation.about is not None:
            about = find_target(thing.name, relation.about, references, objects)
        to = find_target(thing.name, relation.to, references, objects)
        if relation.kind in ("same_size", "symmetric"):
            if not to.is_object or to.feature is not None:
                raise InvalidValue(
                    f"{thing.name}: {relation.kind} to {relation.to!r}, which is no whole object"
                )
        elif to.is_object and to.feature is None:
            raise InvalidValue(
                f"{thing.name}: {relation.kind} {relation.to!r}: say which face or axis of it, as "
                f"in {relation.to}.top"
            )
        if to.is_object and to.name == thing.name:
            raise InvalidValue(f"{thing.name}: {relation.kind} {relation.to!r}, which is itself")
        _refuse_line(thing.name, relation, to, references)
        holds.append(Hold(thing.name, relation, to, about))
    return tuple(holds)


def _refuse_line(own: str, relation: Relation, to: Target, references: References) -> None:
    line = not to.is_object and isinstance(references[to.name], ReferenceLine)
    if line and RELATIONS[relation.kind] == "plane":
        raise InvalidValue(f"{own}: {relation.kind} needs a plane, and {relation.to} is a line")


def find_target(own: str, path: str, references: References, objects: Sequence[str]) -> Target:
    """What `path` names. Raises InvalidValue naming what there is."""
    if path in references:
        return Target(path, False)
    if path in objects:
        return Target(path, True)
    name, dot, part = path.rpartition(".")
    if dot and name in objects:
        return Target(name, True, part)
    known = ", ".join([*references, *(o for o in objects if o != own)]) or "nothing"
    raise InvalidValue(f"{own}: is held by {path!r}, which is not there; there is {known}")


def as_feature(target: Target, things: Mapping[str, Primitive], references: References) -> Feature:
    """The plane, line or point that a target is, as things stand; not of a whole object."""
    if not target.is_object:
        return reference_feature(references[target.name])
    assert target.feature is not None
    return feature(things[target.name], target.feature)
