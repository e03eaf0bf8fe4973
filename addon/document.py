# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene is the document: a Cell out of a scene, and a Cell or a calibration into it.

The scene's text holds camera, picture, sightings, references and what is picked but not solved;
the objects are Blender's objects. Each thing is written in one place, so they can't disagree.
"""

from __future__ import annotations

import json
from collections.abc import Collection
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import bpy

from ..core.cell import Cell
from ..core.document.cell_file import cell_from_document, document_from_cell
from ..core.document.json_text import dumped
from ..core.errors import PictureError
from ..core.reference import PendingReference, ReferencePlane, kind_of
from ..core.sighting import SphereSighting
from .renaming import renamed_composite, renamed_reference, renamed_thing, standing_alone
from .report import Report, dump_report, parse_report

FLOOR = ReferencePlane("floor", [0.0, 0.0, 0.0], [0.0, 0.0, 1.0])


def has_cell(scene: Any) -> bool:
    """Whether a cell was opened in this scene."""
    return bool(scene.monocell_cell.text)


def read_scene(scene: Any) -> Cell:
    """The whole cell: the scene's document with the objects as they stand in Blender now.

    What names an object that was renamed follows it; what names one that was deleted stays where
    it is without it. Raises InvalidValue when an object was edited out of its kind, or two share a
    name.
    """
    from ..core.orphans import without_lost_joints, without_lost_relations
    from ..scene.objects import is_modelled, name_when_built, read_object

    built = [ob for ob in scene.objects if is_modelled(ob)]
    objects = [read_object(ob) for ob in built]
    there = {thing.name for thing in objects}
    names = {
        old: thing.name
        for old, thing in zip(map(name_when_built, built), objects, strict=True)
        if old not in there
    }
    bare = bare_cell(scene)
    references = tuple(renamed_reference(reference, names) for reference in bare.references)
    everything = {*there, *(sketch.name for sketch in bare.sketches)}
    references = standing_alone(references, everything)
    objects, composites, _ = without_lost_joints(
        [renamed_thing(thing, names) for thing in objects],
        [renamed_composite(composite, names) for composite in bare.composites],
    )
    named = [reference.name for reference in references]
    objects, _ = without_lost_relations(objects, named, bare.sketches)
    return replace(bare, references=references, objects=objects, composites=composites)


def bare_cell(scene: Any) -> Cell:
    """The cell without its objects; cheap enough for panels, which draw often."""
    stored = scene.monocell_cell
    return _parsed(stored.text, stored.folder)


def stored_report(scene: Any) -> Report | None:
    """The last calibration, None before one."""
    return _parsed_report(scene.monocell_cell.report)


def write_scene(scene: Any, cell: Cell, report: Report | None = None) -> None:
    """Let the scene's document be that of `cell`; its objects are left to `show_objects`.

    A cell without a plane to stand things on gets the floor, z = 0. `report` is the calibration
    that the cell's camera came from, None for none.
    """
    if not any(isinstance(reference, ReferencePlane) for reference in cell.references):
        cell = replace(cell, references=(*cell.references, FLOOR))
    folder = cell.folder.resolve()
    stored = scene.monocell_cell
    stored.folder = str(folder)
    stored.text = dumped(document_from_cell(replace(cell, objects=()), folder))
    stored.report = "" if report is None else dump_report(report)
    _fill_sightings(stored, cell, report)
    _fill_references(stored, cell)


def show_objects(
    scene: Any, cell: Cell, names: Collection[str] | None = None
) -> tuple[str, ...]:
    """Build the objects of `cell`, or those of `names`, in place where they are there already.

    Returns a word on every object whose texture is missing: it has its colour alone.
    """
    from ..scene.objects import build_object
    from ..scene.textures import is_textured, paint

    collection, told = objects_collection(scene), []
    for thing in cell.objects:
        if names is not None and thing.name not in names:
            continue
        ob = build_object(thing, collection)
        if is_textured(thing):
            try:
                paint(ob.data, thing, cell.folder)
            except PictureError as error:
                told.append(f"{thing.name}: {error}")
    return tuple(told)


def objects_collection(scene: Any) -> Any:
    """Where the cell's objects are built; made, or linked again, where a user removed it."""
    stored = scene.monocell_cell
    if stored.collection is None:
        stored.collection = bpy.data.collections.new("Cell objects")
    if stored.collection not in scene.collection.children_recursive:
        scene.collection.children.link(stored.collection)
    return stored.collection


def _fill_sightings(stored: Any, cell: Cell, report: Report | None) -> None:
    stored.sightings.clear()
    for i, sighting in enumerate(cell.sightings):
        row = stored.sightings.add()
        row.index, row.picture = i, sighting.picture
        row.kind = "ball" if isinstance(sighting, SphereSighting) else "point"
        if report is not None:
            seen = report.sightings[i]
            row.status, row.reason = seen.status, seen.reason
            row.residual = "–" if seen.rms_pixels is None else f"{seen.rms_pixels:.2f}"
    stored.sighting_index = max(0, min(stored.sighting_index, len(cell.sightings) - 1))


def _fill_references(stored: Any, cell: Cell) -> None:
    fresh = not len(stored.references)
    stored.references.clear()
    for reference in cell.references:
        row = stored.references.add()
        row.name = reference.name
        row.kind = kind_of(reference)
        if isinstance(reference, PendingReference):
            row.place = "not worked out yet"
            continue
        plane = isinstance(reference, ReferencePlane)
        way = reference.normal if plane else reference.direction
        row.place = _where(reference.point) + (" ⟂ " if plane else " ∥ ") + _where(way)
    if fresh or stored.reference_index >= len(cell.references):
        planes = [i for i, r in enumerate(cell.references) if isinstance(r, ReferencePlane)]
        stored.reference_index = planes[0]


def _where(vector: Any) -> str:
    return "(" + ", ".join(f"{x:.3g}" for x in vector) + ")"


# the panels and the overlay ask with every redraw, and a text is the same cell every time
@lru_cache(maxsize=4)
def _parsed(text: str, folder: str) -> Cell:
    return cell_from_document(json.loads(text), Path(folder))


@lru_cache(maxsize=4)
def _parsed_report(text: str) -> Report | None:
    return parse_report(text)
