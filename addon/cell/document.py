# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene is the document: a Cell out of a scene, and a Cell or a calibration into it.

The scene's text holds camera, picture, sightings, references, composites and what is picked but not
solved. The objects are Blender's objects: those in the text only keep it a whole document, since
others in it call them by name.
"""

from __future__ import annotations

import json
from collections.abc import Collection
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import bpy

from ...core.cell import Cell
from ...core.document.cell_file import cell_from_document, document_from_cell
from ...core.document.json_text import dumped
from ...core.errors import PictureError
from ...core.reference import PendingReference, ReferencePlane, kind_of
from ...core.sighting import SphereSighting
from ..camera.report import Report, dump_report, parse_report
from .modes import leave_modes

STAYS = "belongs to {} and was not changed; make it local first (Object > Relations > Make Local)"
FLOOR = ReferencePlane("floor", [0.0, 0.0, 0.0], [0.0, 0.0, 1.0])


def has_cell(scene: Any) -> bool:
    """Whether a cell was opened in this scene."""
    return bool(scene.monocell_cell.text)


def read_scene(scene: Any) -> Cell:
    """The whole cell: the scene's document with the objects as they stand in Blender now.

    What named an object that was renamed there names it by its new name; what named one that was
    deleted lets go of it.

    Raises InvalidValue when an object was edited out of its kind, or two share a name.
    """
    from ...core.links import (
        references_kept,
        with_new_names,
        without_lost_joints,
        without_lost_relations,
    )
    from ...scene.objects import built_name, is_modelled, read_object

    cell = bare_cell(scene)
    modelled = [ob for ob in scene.objects if is_modelled(ob)]
    objects = [read_object(ob) for ob in modelled]
    there = {thing.name for thing in objects}
    # a copy names its original's neighbours; only what is gone by its old name was renamed
    renamed = {
        built_name(ob): thing.name
        for ob, thing in zip(modelled, objects, strict=True)
        if built_name(ob) not in there
    }
    things, composites = with_new_names([*objects, *cell.sketches], cell.composites, renamed)
    things, composites, _ = without_lost_joints(things, composites)
    things, _ = without_lost_relations(things, {r.name for r in cell.references})
    names = {thing.name for thing in things}
    return replace(
        cell,
        references=references_kept(cell.references, renamed, names),
        objects=things[: len(objects)],
        sketches=things[len(objects) :],
        composites=composites,
    )


def doubts_of(scene: Any) -> tuple[str, ...]:
    """Words on what Blender shows of the objects and the document does not hold."""
    from ...scene.objects import is_modelled, left_out

    return tuple(told for ob in scene.objects if is_modelled(ob) for told in left_out(ob))


def bare_cell(scene: Any) -> Cell:
    """The cell with its objects as they were last written; cheap enough for panels."""
    stored = scene.monocell_cell
    return _parsed(stored.text, stored.folder)


def active_plane(scene: Any) -> ReferencePlane | None:
    """The list's active reference, None where it is a line or has no place yet."""
    references = bare_cell(scene).references
    index = scene.monocell_cell.reference_index
    active = references[index] if 0 <= index < len(references) else None
    return active if isinstance(active, ReferencePlane) else None


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
    leave_modes(scene)
    store_cell(scene, cell, report)


def store_cell(scene: Any, cell: Cell, report: Report | None) -> None:
    """The same for what changes no object: an edit of a mesh may go on."""
    folder = cell.folder.resolve()
    stored = scene.monocell_cell
    stored.folder = str(folder)
    stored.text = dumped(document_from_cell(cell, folder))
    stored.report = "" if report is None else dump_report(report)
    _fill_sightings(stored, cell, report)
    _fill_references(stored, cell)


def show_objects(scene: Any, cell: Cell, names: Collection[str] | None = None) -> tuple[str, ...]:
    """Build the objects of `cell`, or those of `names`, in place where they are there already.

    Returns a word on every object whose texture is missing, which has its colour alone, on
    every one that belongs to another file, which stays as it is there, and on every one that
    constraints hold.
    """
    from ...scene.objects import build_object, find_object, library_of
    from ...scene.textures import is_textured, paint

    leave_modes(scene)
    collection, told = objects_collection(scene), []
    for thing in cell.objects:
        if names is not None and thing.name not in names:
            continue
        there = find_object(thing.name, scene)
        library = None if there is None else library_of(there)
        if library is not None:
            told.append(f"{thing.name}: {STAYS.format(library)}")
            continue
        ob = build_object(thing, collection, scene)
        if any(not constraint.mute for constraint in ob.constraints):
            told.append(f"{thing.name}: stands where its constraints put it; mute or remove them")
        if is_textured(thing):
            try:
                made = paint(ob.data, thing, cell.folder)
            except PictureError as error:
                told.append(f"{thing.name}: {error}")
                continue
            # a .blend that is sent elsewhere still has them
            for image in made:
                if isinstance(image, bpy.types.Image):
                    image.pack()
    return tuple(told)


def objects_collection(scene: Any) -> Any:
    """Where the cell's objects are built; made, or linked again, where a user removed it.

    A scene that was made with the settings of another gets one of its own.
    """
    stored = scene.monocell_cell
    if stored.collection in list(scene.collection.children_recursive):
        return stored.collection
    others = (other for other in bpy.data.scenes if other != scene)
    if stored.collection is None or any(
        stored.collection in list(other.collection.children_recursive) for other in others
    ):
        stored.collection = bpy.data.collections.new("Cell objects")
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
