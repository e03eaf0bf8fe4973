# SPDX-License-Identifier: GPL-3.0-or-later
"""Names as Blender has them now: a cell in whose parts name each other, one that agrees out.

In Blender anything is renamed or deleted at any time; what named it has to follow, or live on.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import fields, replace
from typing import Any

from ..core.cell import feature_owner
from ..core.composite import Composite
from ..core.motion import Motion
from ..core.primitives import Primitive
from ..core.reference import PendingReference, Reference
from ..core.references.sources import FeatureOf
from ..core.relation import Relation

AnyReference = Reference | PendingReference


def renamed_thing(thing: Primitive, names: Mapping[str, str]) -> Primitive:
    """An object with what holds it, and what it hangs on, by their names of now."""
    if not names:
        return thing
    on = None if thing.on is None else path_renamed(thing.on, names)
    relations = tuple(_relation(relation, names) for relation in thing.relations)
    return replace(thing, on=on, relations=relations, motion=_motion(thing.motion, names))


def renamed_reference(reference: AnyReference, names: Mapping[str, str]) -> AnyReference:
    """A reference with what it is made from by its name of now.

    One that is called like the face it is follows that face's name.
    """
    source: Any = reference.source
    if source is None or not names:
        return reference
    changed = {f.name: _value(getattr(source, f.name), names) for f in fields(source)}
    own = reference.name
    if isinstance(source, FeatureOf) and source.of == own:
        own = path_renamed(own, names)
    return replace(reference, name=own, source=replace(source, **changed))


def renamed_composite(composite: Composite, names: Mapping[str, str]) -> Composite:
    """A composite with its parts, and what it hangs on, by their names of now."""
    parts = tuple(names.get(part, part) for part in composite.parts)
    return replace(composite, parts=parts, motion=_motion(composite.motion, names))


def standing_alone(
    references: Collection[AnyReference], objects: Collection[str]
) -> tuple[AnyReference, ...]:
    """References whose source is gone stay where they are, as if they had been given there.

    Those that never had a place go with it. `objects` are the names of all things.
    """
    kept: list[AnyReference] = []
    names = {reference.name for reference in references}
    for reference in references:
        source = reference.source
        there = source is None or all(
            path in names or feature_owner(path, set(objects)) for path in source.needs
        )
        if there:
            kept.append(reference)
        elif not isinstance(reference, PendingReference):
            kept.append(replace(reference, source=None))
    return tuple(kept)


def path_renamed(path: str, names: Mapping[str, str]) -> str:
    """`crate.top` when the crate is called otherwise."""
    owner, dot, feature = path.rpartition(".")
    return f"{names[owner]}.{feature}" if dot and owner in names else path


def _value(value: Any, names: Mapping[str, str]) -> Any:
    if isinstance(value, str):
        return path_renamed(value, names)
    if isinstance(value, tuple):
        return tuple(_value(one, names) for one in value)
    return value


def _relation(relation: Relation, names: Mapping[str, str]) -> Relation:
    about = None if relation.about is None else path_renamed(relation.about, names)
    to = names.get(relation.to, path_renamed(relation.to, names))
    return replace(relation, to=to, about=about)


def _motion(motion: Motion, names: Mapping[str, str]) -> Motion:
    return motion if motion.to is None else replace(motion, to=names.get(motion.to, motion.to))
