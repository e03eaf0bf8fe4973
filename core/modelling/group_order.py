# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects and their relations in, the groups that are solved together, in order, out."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from graphlib import TopologicalSorter

from .holding import Hold


def in_order(names: Sequence[str], holds: Iterable[Hold]) -> list[list[tuple[str, ...]]]:
    """Objects in groups that hold each other, and the groups in levels: each after what holds it.

    The groups of one level have nothing to do with each other.
    """
    held_by = _held_by(names, holds)
    reach = {name: _reached(name, held_by) for name in names}
    groups: dict[str, tuple[str, ...]] = {}
    for name in names:
        mutual = tuple(o for o in names if o == name or (o in reach[name] and name in reach[o]))
        groups[name] = mutual
    before: dict[tuple[str, ...], set[tuple[str, ...]]] = {groups[n]: set() for n in names}
    for name in names:
        before[groups[name]] |= {groups[o] for o in held_by[name]} - {groups[name]}
    levels, sorter = [], TopologicalSorter(before)
    sorter.prepare()
    while sorter.is_active():
        ready = sorter.get_ready()
        levels.append([group for group in dict.fromkeys(groups.values()) if group in ready])
        sorter.done(*ready)
    return levels


def together(names: Sequence[str], holds: Iterable[Hold]) -> list[tuple[str, ...]]:
    """The objects that hang together by relations, whichever way, in one group each."""
    linked: dict[str, set[str]] = {name: set() for name in names}
    for own, others in _held_by(names, holds).items():
        for other in others:
            linked[own].add(other)
            linked[other].add(own)
    groups: list[tuple[str, ...]] = []
    seen: set[str] = set()
    for name in names:
        if name not in seen:
            found = _reached(name, linked) | {name}
            seen |= found
            groups.append(tuple(o for o in names if o in found))
    return groups


def _held_by(names: Sequence[str], holds: Iterable[Hold]) -> dict[str, set[str]]:
    known = set(names)
    held: dict[str, set[str]] = {name: set() for name in names}
    for hold in holds:
        if hold.own in known:
            held[hold.own] |= {t.name for t in hold.targets if t.is_object and t.name in known}
    return held


def _reached(name: str, edges: Mapping[str, set[str]]) -> set[str]:
    found: set[str] = set()
    waiting = list(edges[name])
    while waiting:
        here = waiting.pop()
        if here not in found:
            found.add(here)
            waiting += edges[here]
    return found
