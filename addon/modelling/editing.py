# SPDX-License-Identifier: GPL-3.0-or-later
"""An edit of the model in, the cell with all that depends on it solved again out; no Blender."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass, replace

import numpy as np

from ...core.cell import Cell, feature_owner
from ...core.errors import InvalidValue
from ...core.modelling.solve import model
from ...core.motion import Motion
from ...core.pose import Pose
from ...core.primitives import Primitive
from ...core.reference import PendingReference, Reference, ReferencePlane
from ...core.references.resolve import resolve_references
from ...core.relation import Relation
from ...core.sketch import Sketch

# an object without picks that goes farther, in metres, is told of
TOLD_MOVE = 1e-5


@dataclass(frozen=True, eq=False)
class Edited:
    """The cell after an edit, the names of the objects that changed, and what is doubtful."""

    cell: Cell
    changed: tuple[str, ...]
    warnings: tuple[str, ...] = ()


def with_size(cell: Cell, name: str, size: str, metres: float | None, sigma: float) -> Edited:
    """With a size of an object typed, or with None left to its picks again.

    An object without picks takes the size as it stands: what it stands on keeps its base. Raises
    InvalidValue for a size that it has not or can't have, and what `model` raises.
    """
    thing = object_called(cell, name)
    if size not in thing.size_names:
        raise InvalidValue(
            f"{name}: a {thing.kind} has no size {size!r}; it has {', '.join(thing.size_names)}"
        )
    known = {key: value for key, value in thing.known.items() if key != size}
    if metres is not None:
        if metres <= 0 and (thing.kind, size, metres) != ("cone", "top_radius", 0):
            raise InvalidValue(
                f"{name}: {size} must be above zero, got {1e3 * metres:g} mm; type a length"
            )
        known[size] = metres
        # refuses what can't be before anything is solved
        sized = _resized(cell, thing, size, metres)
        if not thing.picks:
            return solved(_with(cell, replace(sized, known=known)), [name], sigma)
    return solved(_with(cell, replace(thing, known=known)), [name], sigma)


def with_relations(
    cell: Cell, name: str, relations: Iterable[Relation], sigma: float, *, on: str | None = None
) -> Edited:
    """With an object held by other relations, and standing `on` a reference or on none.

    One without picks moves as little as lets them hold.
    """
    thing = replace(object_called(cell, name), relations=tuple(relations), on=on)
    return solved(_with(cell, thing), [name], sigma, held=[name])


def with_motion(cell: Cell, name: str, motion: Motion) -> Edited:
    """With an object that moves otherwise; nothing is to be solved for that."""
    thing = replace(object_called(cell, name), motion=motion)
    return Edited(_with(cell, thing), (name,))


def with_pick(
    cell: Cell, name: str, role: str, index: int, pixel: Iterable[float], sigma: float
) -> Edited:
    """With one pick of an object elsewhere in the picture."""
    thing = with_moved_pick(object_called(cell, name), role, index, pixel)
    return solved(_with(cell, thing), [name], sigma)


def with_moved_pick(thing: Primitive, role: str, index: int, pixel: Iterable[float]) -> Primitive:
    """The object, not solved again yet, with a pick elsewhere.

    Raises InvalidValue for a pick that it has not.
    """
    pixels = list(thing.picks.get(role, ()))
    if not 0 <= index < len(pixels) or pixels[index] is None:
        raise InvalidValue(f"{thing.name}: has no pick {role}[{index}]")
    pixels[index] = [float(value) for value in pixel]
    return replace(thing, picks={**thing.picks, role: pixels})


def with_reference(cell: Cell, reference: Reference | PendingReference, sigma: float) -> Edited:
    """With one reference more, worked out. Raises InvalidValue for a name that is taken."""
    wider = replace(cell, references=(*cell.references, reference))
    placed, warnings = resolve_references(wider, sigma)
    return Edited(placed, (), warnings)


def without_reference(cell: Cell, name: str) -> Edited:
    """Without a reference. Raises InvalidValue while something is made from it, or held by it."""
    users = [r.name for r in cell.references if r.source is not None and name in r.source.needs]
    users += [thing.name for thing in cell.things if name in paths_of(thing)]
    if users:
        raise InvalidValue(f"{name}: is needed by {', '.join(users)}; let go of it there first")
    kept = tuple(r for r in cell.references if r.name != name)
    return Edited(replace(cell, references=kept), ())


def solved(cell: Cell, names: Collection[str], sigma: float, held: Collection[str] = ()) -> Edited:
    """Objects solved again from their picks, with all that they hold; the others stand still.

    Of those named, one without picks stays where it is unless it is one of `held` or hangs on
    another object. Raises what `model` raises.
    """
    moving = depending(cell, names)
    following = (moving - set(names)) | set(held)
    still = {thing.name: thing for thing in cell.objects if thing.name not in moving}
    # an object without picks that nothing holds is one that `model` leaves alone
    quiet = tuple(
        replace(t, picks={}, on=None, relations=()) if t.name in still else t for t in cell.objects
    )
    bare = _without_idle_sketches(replace(cell, objects=quiet))
    modelling = model(bare, sigma, held=following)
    after = {thing.name: thing for thing in modelling.cell.objects}
    objects = tuple(still.get(thing.name, after[thing.name]) for thing in cell.objects)
    references = modelling.cell.references
    done = replace(cell, references=references, objects=objects)
    warnings = [word for result in modelling.results for word in result.warnings]
    warnings += [
        f"{thing.name}: has no picks; what holds it moved it by {1e3 * far:.1f} mm"
        for thing in cell.objects
        if not thing.picks and (far := _apart(thing, after[thing.name])) > TOLD_MOVE
    ]
    return Edited(done, tuple(sorted(moving)), (*modelling.warnings, *warnings))


def depending(cell: Cell, names: Collection[str]) -> set[str]:
    """The objects of those names and all that is held by them, directly or through others."""
    named = {reference.name: reference for reference in cell.references}
    things = {thing.name for thing in cell.things}

    def holders(path: str, seen: frozenset[str] = frozenset()) -> set[str]:
        if path in named and path not in seen:
            source = named[path].source
            needs = () if source is None else source.needs
            return {name for need in needs for name in holders(need, seen | {path})}
        owner = path if path in things else feature_owner(path, things)
        return set() if owner is None else {owner}

    held_by = {t.name: {h for p in paths_of(t) for h in holders(p)} for t in cell.objects}
    found = set(names)
    while True:
        more = {name for name, by in held_by.items() if by & found} - found
        if not more:
            return found
        found |= more


def paths_of(thing: Primitive | Sketch) -> tuple[str, ...]:
    """All names that an object is held by."""
    relations = [p for r in thing.relations for p in (r.to, r.about) if p is not None]
    return (*(() if thing.on is None else (thing.on,)), *relations)


def object_called(cell: Cell, name: str) -> Primitive:
    """The solved object of that name. Raises InvalidValue without one."""
    for thing in cell.objects:
        if thing.name == name:
            return thing
    listed = ", ".join(thing.name for thing in cell.objects) or "none at all"
    raise InvalidValue(f"no solved object is called {name!r}; there is {listed}")


def _apart(one: Primitive, other: Primitive) -> float:
    """How far an object's centre went, metres."""
    place, now = one.world_from_object.translation, other.world_from_object.translation
    return float(np.linalg.norm(now - place))


def _with(cell: Cell, thing: Primitive) -> Cell:
    return cell.with_objects(thing if t.name == thing.name else t for t in cell.objects)


def _without_idle_sketches(cell: Cell) -> Cell:
    """What is only picked so far is not solved by an edit of something else."""
    if not cell.sketches:
        return cell
    idle = {sketch.name for sketch in cell.sketches}
    used = {p.rpartition(".")[0] or p for t in cell.objects for p in paths_of(t)}
    sources = [r.source.needs for r in cell.references if r.source is not None]
    used |= {p.rpartition(".")[0] for needs in sources for p in needs}
    used |= {part for composite in cell.composites for part in composite.parts}
    return cell if idle & used else replace(cell, sketches=())


def _resized(cell: Cell, thing: Primitive, size: str, metres: float) -> Primitive:
    """The object of another size; what stands keeps its base where it is."""
    place = thing.size_names.index(size)
    parameters = thing.parameters.copy()
    grown = metres - float(parameters[place])
    parameters[place] = metres
    sized = replace(thing.with_parameters(parameters), covariance=None, by_camera=None)
    up = thing.size_names[-1]
    plane = None if thing.on is None or thing.relations else cell.reference(thing.on)
    if size != up or not isinstance(plane, ReferencePlane):
        return sized
    rise = plane.normal * grown * (1.0 if thing.kind == "sphere" else 0.5)
    pose = thing.world_from_object
    return replace(sized, world_from_object=Pose(pose.rotation, pose.translation + rise))
