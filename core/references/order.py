# SPDX-License-Identifier: GPL-3.0-or-later
"""The references of a cell in, the order in which they are made from each other out."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from ..cell import Cell
from ..errors import DegenerateReference, InvalidValue
from ..primitive import Primitive

# references made from each other, one behind the other
DEEPEST = 400


def objects_behind(cell: Cell, name: str, *, unsolved: bool = False) -> tuple[str, ...]:
    """The names of the objects that a reference or feature hangs on, through other references.

    With `unsolved` only of those that are not solved yet. Raises InvalidValue for a name that
    nothing has, DegenerateReference for a circle.
    """
    trace = _Trace(cell, unsolved)
    trace.follow(name, ())
    return tuple(trace.objects)


def in_order(cell: Cell, wanted: Iterable[str]) -> list[str]:
    """The names of those references and all that they are made from, each after what it needs.

    `wanted` may also name features of objects. Raises what `objects_behind` raises.
    """
    trace = _Trace(cell, unsolved=False)
    for name in wanted:
        trace.follow(name, ())
    named = {reference.name for reference in cell.references}
    return [name for name in trace.done if name in named]


@dataclass(eq=False)
class _Trace:
    """A walk down to what names are made from: all names on the way, each after what it needs.

    With `unsolved` it stops at solved objects and does not count them.
    """

    cell: Cell
    unsolved: bool
    done: dict[str, None] = field(default_factory=dict)
    objects: dict[str, None] = field(default_factory=dict)

    def follow(self, name: str, trail: tuple[str, ...]) -> None:
        if name in self.done:
            return
        if name in trail:
            circle = " -> ".join((*trail[trail.index(name) :], name))
            raise DegenerateReference(
                f"{name}: it is made from itself ({circle}); break the circle"
            )
        if len(trail) == DEEPEST:
            raise DegenerateReference(
                f"{trail[0]}: it is made from more than {DEEPEST} others, one behind the other"
            )
        for needed in self._needs(name, trail):
            self.follow(needed, (*trail, name))
        self.done[name] = None

    def _needs(self, name: str, trail: tuple[str, ...]) -> tuple[str, ...]:
        reference = next((r for r in self.cell.references if r.name == name), None)
        if reference is not None:
            return reference.source.needs if reference.source else ()
        owner = next((t for t in self.cell.things if t.name == name.rpartition(".")[0]), None)
        if owner is None:
            raise InvalidValue(self._nothing_called(name, trail))
        if self.unsolved and isinstance(owner, Primitive):
            return ()
        self.objects[owner.name] = None
        # objects may hold each other both ways, but none may hold itself through a reference
        named = {reference.name for reference in self.cell.references}
        held = [name for r in owner.relations for name in (r.to, r.about) if name in named]
        return (*(() if owner.on is None else (owner.on,)), *(name for name in held if name))

    def _nothing_called(self, name: str, trail: tuple[str, ...]) -> str:
        user = f"{trail[-1]}: " if trail else ""
        listed = ", ".join(r.name for r in self.cell.references) or "none"
        objects = ", ".join(t.name for t in self.cell.things) or "none"
        return (
            f"{user}nothing is called {name!r}; references are {listed}; objects, whose features "
            f"are named like crate.top, are {objects}"
        )
