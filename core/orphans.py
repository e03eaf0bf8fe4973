# SPDX-License-Identifier: GPL-3.0-or-later
"""Names of what is gone: things that lost what held them in, the rest with a word on each out.

A document that names what is not there is refused. Where things go one by one, as in Blender or in
another program's glTF, what named them has to live on.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace

from .cell import feature_owner
from .composite import Composite
from .motion import Motion
from .primitives import Primitive
from .relation import RELATIONS, Relation
from .sketch import Sketch

STILL = Motion()


def without_lost_joints(
    things: Sequence[Primitive], composites: Sequence[Composite]
) -> tuple[tuple[Primitive, ...], tuple[Composite, ...], tuple[str, ...]]:
    """Joints to nothing become static, parts that are gone leave their composite; with warnings."""
    names, warnings = {thing.name for thing in things}, []
    kept = []
    for thing in things:
        lost = thing.motion.to is not None and thing.motion.to not in names
        if lost:
            warnings.append(_hung(thing.name, thing.motion))
        kept.append(replace(thing, motion=STILL) if lost else thing)
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
    things: Sequence[Primitive], references: Collection[str], others: Sequence[Sketch] = ()
) -> tuple[tuple[Primitive, ...], tuple[str, ...]]:
    """Objects without the relations whose other side is gone, and a warning for each of these.

    `references` are names of references; `others` are there as well as `things`.
    """
    names = {thing.name for thing in things} | {sketch.name for sketch in others}
    kept, warnings = [], []
    for thing in things:
        relations = tuple(r for r in thing.relations if _is_there(r, references, names))
        on = thing.on if thing.on is None or _leads(thing.on, references, names) else None
        lost = [r.to for r in thing.relations if r not in relations]
        lost += [thing.on] if thing.on is not None and on is None else []
        warnings += [f"{thing.name}: {name} held it, which is not there any more" for name in lost]
        kept.append(replace(thing, relations=relations, on=on) if lost else thing)
    return tuple(kept), tuple(warnings)


def _hung(name: str, motion: Motion) -> str:
    return f"{name}: it hangs on {motion.to}, which is not there; it is taken as static"


def _is_there(relation: Relation, references: Collection[str], names: Collection[str]) -> bool:
    about = relation.about is None or _leads(relation.about, references, names)
    if RELATIONS[relation.kind] == "object":
        return relation.to in names and about
    return _leads(relation.to, references, names) and about


def _leads(path: str, references: Collection[str], names: Collection[str]) -> bool:
    return path in references or feature_owner(path, set(names)) is not None
