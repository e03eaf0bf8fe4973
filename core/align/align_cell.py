# SPDX-License-Identifier: GPL-3.0-or-later
"""A cell with a rough model and its picture in, the cell with its objects aligned out."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace

from ..cell import Cell
from ..errors import InvalidValue
from ..modelling.following import followed
from ..picture.pictures import Picture
from ..primitives import Primitive
from ..references.sources import FeatureOf
from .align import REACH_PIXELS, Watch, align
from .result import Aligned, AlignedObject


def align_cell(
    cell: Cell,
    picture_bgr: Picture,
    names: Collection[str] | None = None,
    reach_pixels: float = REACH_PIXELS,
    watch: Watch | None = None,
) -> tuple[Cell, Aligned]:
    """Align the objects in `names` (None: all that are solved) on the cell's own picture.

    Objects that are not believed stay as they are, but for what keeps them on an object that was
    moved; the report says why. The cell's references are as they were: resolve them again. Raises
    what `align` raises, and InvalidValue for a cell without solved objects.
    """
    if not cell.objects:
        raise InvalidValue("the cell has no solved object to align: model it first")
    faces = _faces(cell)
    held = [_held_by_faces(thing, faces) for thing in cell.objects]
    camera, references = cell.standing_camera(), cell.placed_references
    aligned = align(held, camera, picture_bgr, references, names, reach_pixels, watch)
    given = {thing.name: thing for thing in cell.objects}
    moved = with_followers(
        cell, [_held_as(o.thing, given[name]) for name, o in aligned.objects.items() if o.believed]
    )
    told = _told(aligned.objects, moved.objects)
    return moved, Aligned(moved.objects, told, aligned.warnings)


def with_followers(cell: Cell, things: Iterable[Primitive]) -> Cell:
    """The cell with `things`, new or in place of their namesakes, and what stands on them.

    What stands on or hangs on an object goes with it, by as little as keeps its relations; all
    other objects are the same as before. The references stay as they were: resolve them again.
    Raises NotConverged for relations that contradict each other.
    """
    by_name = {thing.name: thing for thing in things}
    kept = [by_name.pop(thing.name, thing) for thing in cell.objects]
    given = (*kept, *by_name.values())
    faces = _faces(cell)
    held = [_held_by_faces(thing, faces) for thing in given]
    known = {reference.name: reference for reference in cell.placed_references}
    now = followed(cell.standing_camera(), known, held, ())
    pairs = zip(given, held, now, strict=True)
    return cell.with_objects(t if n is h else _held_as(n, t) for t, h, n in pairs)


def _faces(cell: Cell) -> dict[str, str]:
    """References that are a face, edge or axis of an object, and which: it may move."""
    return {
        reference.name: reference.source.of
        for reference in cell.references
        if isinstance(reference.source, FeatureOf)
    }


def _held_by_faces(thing: Primitive, faces: Mapping[str, str]) -> Primitive:
    """Held by the face itself, not by a reference that tells where the face was."""
    on = thing.on if thing.on is None else faces.get(thing.on, thing.on)
    relations = tuple(
        replace(
            relation,
            to=faces.get(relation.to, relation.to),
            about=relation.about and faces.get(relation.about, relation.about),
        )
        for relation in thing.relations
    )
    if (on, relations) == (thing.on, thing.relations):
        return thing
    return replace(thing, on=on, relations=relations)


def _held_as(thing: Primitive, given: Primitive) -> Primitive:
    """By the names that the document has."""
    return replace(thing, on=given.on, relations=given.relations)


def _told(
    found: Mapping[str, AlignedObject], things: tuple[Primitive, ...]
) -> dict[str, AlignedObject]:
    now = {thing.name: thing for thing in things}
    return {
        name: replace(
            one,
            thing=now[name],
            tried=None if one.tried is None else _held_as(one.tried, now[name]),
        )
        for name, one in found.items()
    }
