# SPDX-License-Identifier: GPL-3.0-or-later
"""Who moves with whom: objects and composites in, rigid bodies and the joints between them out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from .composite import Composite
from .errors import InvalidValue
from .motion import Motion
from .primitives import Primitive
from .sketch import Sketch

Things = Sequence[Primitive | Sketch]


@dataclass(frozen=True)
class Body:
    """Objects that move as one: `parts` are their indices, the joint's `owner` first.

    `motion` is what moves the body: nothing, itself, or the hinge or slider by which it hangs on
    the body number `parent`, in the frame of the object `owner`.
    """

    parts: tuple[int, ...]
    motion: Motion
    owner: int
    parent: int | None = None


def rigid_bodies(things: Things, composites: Sequence[Composite] = ()) -> tuple[Body, ...]:
    """Every object in one body; a body comes after the one that it hangs on.

    Fixed joints, and composites that move, join objects to one body. What is fixed to a static
    object is static.

    Raises InvalidValue, by the field's path (`objects[2].motion.to`), for a part or joint that
    names nothing, for joints in a circle, and for two joints of one body.
    """
    index = {thing.name: i for i, thing in enumerate(things)}
    _check_names(things, composites, index)
    bodies = [
        _body(things, composites, index, group)
        for group in _groups(things, composites, index).values()
    ]
    return _in_order(bodies, things, index)


def _check_names(things: Things, composites: Sequence[Composite], index: Mapping[str, int]) -> None:
    names = {name: f"objects[{i}]" for name, i in index.items()}
    groups: dict[str, str] = {}
    for i, composite in enumerate(composites):
        where = f"composites[{i}]"
        if composite.name in names:
            raise InvalidValue(
                f"{where}.name: {composite.name!r} is also {names[composite.name]}'s name"
            )
        names[composite.name] = where
        for j, part in enumerate(composite.parts):
            if part not in index:
                raise InvalidValue(f"{where}.parts[{j}]: {part!r} is the name of no object")
            if part in groups:
                raise InvalidValue(f"{where}.parts[{j}]: {part!r} is a part of {groups[part]}")
            groups[part] = where
        _check_joint(composite.motion, where, composite.parts, index)
        if composite.motion.kind != "static" and not _rigid_parts(composite, things, index):
            raise InvalidValue(
                f"{where}.motion: each part hangs on a joint of its own, so that nothing is left "
                "to move; call it static"
            )
    for i, thing in enumerate(things):
        _check_joint(thing.motion, f"objects[{i}]", (thing.name,), index)


def _check_joint(
    motion: Motion, where: str, own: tuple[str, ...], index: Mapping[str, int]
) -> None:
    if motion.to is None:
        return
    if motion.to not in index:
        raise InvalidValue(f"{where}.motion.to: {motion.to!r} is the name of no object")
    if motion.to in own:
        raise InvalidValue(f"{where}.motion.to: {motion.to!r} can't hang on itself")


def _groups(
    things: Things, composites: Sequence[Composite], index: Mapping[str, int]
) -> dict[int, list[int]]:
    """The objects in groups that fixed joints and moving composites hold together."""
    group = list(range(len(things)))

    def join(i: int, j: int) -> None:
        old, new = max(group[i], group[j]), min(group[i], group[j])
        group[:] = [new if g == old else g for g in group]

    for i, thing in enumerate(things):
        if thing.motion.joint == "fixed":
            join(i, index[thing.motion.to or ""])
    for composite in composites:
        rigid = _rigid_parts(composite, things, index)
        if composite.motion.kind == "static":
            continue
        for part in rigid[1:]:
            join(rigid[0], part)
        if composite.motion.joint == "fixed":
            join(rigid[0], index[composite.motion.to or ""])
    groups: dict[int, list[int]] = {}
    for i, g in enumerate(group):
        groups.setdefault(g, []).append(i)
    return groups


def _body(
    things: Things, composites: Sequence[Composite], index: Mapping[str, int], group: list[int]
) -> Body:
    joints = [(things[i].motion, i) for i in group if _hangs(things[i].motion)]
    covered: set[int] = set()
    for composite in composites:
        rigid = _rigid_parts(composite, things, index)
        if composite.motion.kind == "static" or rigid[0] not in group:
            continue
        covered |= set(rigid)
        if _hangs(composite.motion):
            joints.append((composite.motion, rigid[0]))
    if len(joints) > 1:
        one, other = (things[owner].name for _, owner in joints[:2])
        raise InvalidValue(
            f"objects[{joints[1][1]}].motion: {one!r} and {other!r} are one rigid body, and each "
            "has a joint of its own; leave one joint"
        )
    if joints:
        motion, owner = joints[0]
        return Body((owner, *(i for i in group if i != owner)), motion, owner)
    # what rides along on a fixed joint, or in a composite, does not say how the body moves
    own = [things[i].motion.kind for i in group if i not in covered]
    moves = "static" not in own and ("movable" in own or bool(covered))
    return Body(tuple(group), Motion("movable" if moves else "static"), group[0])


def _rigid_parts(composite: Composite, things: Things, index: Mapping[str, int]) -> list[int]:
    """The parts that do not hang on a hinge or slider of their own."""
    return [index[p] for p in composite.parts if not _hangs(things[index[p]].motion)]


def _hangs(motion: Motion) -> bool:
    return motion.joint in ("hinge", "slider")


def _in_order(bodies: list[Body], things: Things, index: Mapping[str, int]) -> tuple[Body, ...]:
    body_of = {part: i for i, body in enumerate(bodies) for part in body.parts}
    parents = [
        body_of[index[body.motion.to]] if body.motion.to is not None else None for body in bodies
    ]
    placed: dict[int, int] = {}
    waiting = list(range(len(bodies)))
    while waiting:
        ready = [i for i in waiting if parents[i] is None or parents[i] in placed]
        if not ready:
            named = ", ".join(things[bodies[i].owner].name for i in waiting[:4])
            raise InvalidValue(
                f"objects[{bodies[waiting[0]].owner}].motion.to: the joints of {named} hang on "
                "each other in a circle; one of them has to stand by itself"
            )
        # dictionaries keep their order: that of the numbers given here
        placed |= {i: len(placed) + n for n, i in enumerate(ready)}
        waiting = [i for i in waiting if i not in ready]
    return tuple(
        replace(bodies[i], parent=None if parent is None else placed[parent])
        for i, parent in ((i, parents[i]) for i in placed)
    )
