# SPDX-License-Identifier: GPL-3.0-or-later
"""Names that things call each other by, kept true when others are renamed or go.

A document that names what is not there is refused. Where things are renamed and go one by one, as
in Blender or in another program's glTF, what named them has to follow, or to let go.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import fields, replace
from typing import Any, TypeVar

from .cell import feature_owner
from .composite import Composite
from .motion import Motion
from .primitives import Primitive
from .reference import PendingReference, Reference
from .relation import RELATIONS, Relation
from .sketch import Sketch

Thing = TypeVar("Thing", Primitive, Sketch, Primitive | Sketch)
AnyReference = Reference | PendingReference
STILL = Motion()


def with_new_names(
    things: Sequence[Thing], composites: Sequence[Composite], names: Mapping[str, str]
) -> tuple[tuple[Thing, ...], tuple[Composite, ...]]:
    """Relations, joints and parts that named an object by its old name; `names` old to new.

    The names of the things themselves are not touched.
    """
    if not names:
        return tuple(things), tuple(composites)
    followed = [
        _changed(
            thing,
            on=None if thing.on is None else _followed(thing.on, names),
            relations=tuple(_relation_followed(r, names) for r in thing.relations),
            motion=_joint_followed(thing.motion, names),
        )
        for thing in things
    ]
    groups = [
        Composite(c.name, tuple(names.get(p, p) for p in c.parts), _joint_followed(c.motion, names))
        for c in composites
    ]
    return tuple(followed), tuple(groups)


def without_lost_joints(
    things: Sequence[Thing], composites: Sequence[Composite]
) -> tuple[tuple[Thing, ...], tuple[Composite, ...], tuple[str, ...]]:
    """Joints to nothing become static, parts that are gone leave their composite; with warnings."""
    names, warnings = {thing.name for thing in things}, []
    kept: list[Thing] = []
    for thing in things:
        lost = thing.motion.to is not None and thing.motion.to not in names
        if lost:
            warnings.append(_hung(thing.name, thing.motion))
        kept.append(_changed(thing, motion=STILL) if lost else thing)
    groups = []
    for composite in composites:
        gone = [part for part in composite.parts if part not in names]
        if gone:
            warnings.append(f"{composite.name}: its parts {', '.join(gone)} are not there")
        parts = tuple(part for part in composite.parts if part in names)
        motion = composite.motion
        if motion.to is not None and motion.to not in names:
            warnings.append(_hung(composite.name, motion))
            motion = STILL
        if parts:
            groups.append(Composite(composite.name, parts, motion))
    return tuple(kept), tuple(groups), tuple(warnings)


def without_lost_relations(
    things: Sequence[Thing], references: Collection[str]
) -> tuple[tuple[Thing, ...], tuple[str, ...]]:
    """Things without the relations whose other side is gone, and a warning for each of these.

    `references` are the names of the references that are there.
    """
    names = {thing.name for thing in things}
    kept: list[Thing] = []
    warnings = []
    for thing in things:
        relations = tuple(r for r in thing.relations if _is_there(r, references, names))
        on = thing.on if thing.on is None or _leads(thing.on, references, names) else None
        lost = [r.to for r in thing.relations if r not in relations]
        lost += [thing.on] if thing.on is not None and on is None else []
        warnings += [f"{thing.name}: {name} held it, which is not there any more" for name in lost]
        kept.append(_changed(thing, relations=relations, on=on) if lost else thing)
    return tuple(kept), tuple(warnings)


def references_kept(
    references: Sequence[AnyReference], names: Mapping[str, str], there: Collection[str]
) -> tuple[AnyReference, ...]:
    """References made from objects: renamed ones followed, and where one is gone the place kept.

    `names` are old to new; `there` are the names of the objects that are there now.
    """
    known = {reference.name for reference in references}
    return tuple(_source_kept(reference, names, known, there) for reference in references)


def _source_kept(
    reference: AnyReference,
    names: Mapping[str, str],
    known: Collection[str],
    there: Collection[str],
) -> AnyReference:
    source = reference.source
    if source is None or not source.needs:
        return reference
    moved = {
        field.name: _names_followed(getattr(source, field.name), names) for field in fields(source)
    }
    source = replace(source, **moved)
    lost = not all(_leads(name, known, there) for name in source.needs)
    if lost and not isinstance(reference, PendingReference):
        return replace(reference, source=None)
    return replace(reference, source=source)


def _names_followed(value: Any, names: Mapping[str, str]) -> Any:
    if isinstance(value, str):
        return _followed(value, names)
    if isinstance(value, tuple):
        return tuple(_names_followed(v, names) for v in value)
    return value


def _changed(thing: Thing, **changes: Any) -> Thing:
    return replace(thing, **changes)


def _followed(path: str, names: Mapping[str, str]) -> str:
    owner = feature_owner(path, names)
    return path if owner is None else f"{names[owner]}.{path.rpartition('.')[2]}"


def _relation_followed(relation: Relation, names: Mapping[str, str]) -> Relation:
    if RELATIONS[relation.kind] == "object":
        to = names.get(relation.to, relation.to)
    else:
        to = _followed(relation.to, names)
    about = None if relation.about is None else _followed(relation.about, names)
    return replace(relation, to=to, about=about)


def _joint_followed(motion: Motion, names: Mapping[str, str]) -> Motion:
    to = motion.to
    return motion if to is None or to not in names else replace(motion, to=names[to])


def _hung(name: str, motion: Motion) -> str:
    return f"{name}: it hangs on {motion.to}, which is not there; it is taken as static"


def _is_there(relation: Relation, references: Collection[str], names: Collection[str]) -> bool:
    about = relation.about is None or _leads(relation.about, references, names)
    if RELATIONS[relation.kind] == "object":
        return relation.to in names and about
    return _leads(relation.to, references, names) and about


def _leads(path: str, references: Collection[str], names: Collection[str]) -> bool:
    return path in references or feature_owner(path, names) is not None
