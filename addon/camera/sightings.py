# SPDX-License-Identifier: GPL-3.0-or-later
"""The list of sightings, edited: a scene and what changes in, its document changed."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path, PurePath
from typing import Any

from ...core.cell import Cell
from ...core.errors import InvalidValue, PictureError
from ...core.sighting import Sighting
from ..cell.document import bare_cell, stored_report, write_scene


def add_sightings(scene: Any, sightings: Iterable[Sighting], folder: Path | None = None) -> int:
    """Add sightings at the list's end, the first of them active. Returns how many.

    Relative picture names start at `folder`, or at the document's where none is given. Raises
    PictureError for a picture that is not there, InvalidValue for what the cell can't hold.
    """
    cell = bare_cell(scene)
    new = tuple(replace(one, picture=named_from(cell, one.picture, folder)) for one in sightings)
    for sighting in new:
        if not cell.path_of(sighting.picture).is_file():
            raise PictureError(f"{cell.path_of(sighting.picture)}: there is no such picture")
    old = list(range(len(cell.sightings)))
    _write(scene, (*cell.sightings, *new), [*old, *[None] * len(new)])
    scene.monocell_cell.sighting_index = len(old)
    return len(new)


def remove_sighting(scene: Any, index: int) -> Sighting:
    """Take one out; the next becomes active."""
    sightings = bare_cell(scene).sightings
    if not 0 <= index < len(sightings):
        raise InvalidValue(f"there is no sighting number {index + 1}; there are {len(sightings)}")
    kept = [i for i in range(len(sightings)) if i != index]
    _write(scene, [sightings[i] for i in kept], kept)
    scene.monocell_cell.sighting_index = max(0, min(index, len(kept) - 1))
    return sightings[index]


def edit_sighting(scene: Any, index: int, **changes: Any) -> None:
    """Change fields of one sighting; what is known of the others stays, and of it what still holds.

    Raises InvalidValue, also for a field that only balls have.
    """
    sightings = list(bare_cell(scene).sightings)
    for name in changes:
        if not hasattr(sightings[index], name):
            raise InvalidValue(
                f"sighting {index + 1} is a clicked point and has no {name}: choose a ball's"
            )
    sightings[index] = replace(sightings[index], **changes)
    moved = set(changes) - {"use"}
    _write(scene, sightings, [None if moved and i == index else i for i in range(len(sightings))])


def place_sightings(scene: Any, places: Sequence[Sighting]) -> None:
    """Give all sightings new places and radii, in their order. Raises InvalidValue."""
    old = bare_cell(scene).sightings
    if len(old) != len(places):
        raise InvalidValue(
            f"{len(places)} positions for {len(old)} sightings: give one for each, in their order"
        )
    new = [
        replace(
            before,
            center_world=given.center_world,
            world_from_flange=given.world_from_flange,
        )
        for before, given in zip(old, places, strict=True)
    ]
    # where the balls are in the pictures has not changed
    _write(scene, new, range(len(new)))


def named_from(cell: Cell, picture: str, folder: Path | None = None) -> str:
    """A picture's name as the document writes it: relative to its folder where that can be."""
    path = (folder or cell.folder) / picture
    try:
        return Path(os.path.relpath(path.resolve(), cell.folder.resolve())).as_posix()
    except ValueError:
        # another drive
        return str(path.resolve())


def missing_pictures(cell: Cell) -> tuple[str, ...]:
    """The names of the pictures that are not there. Raises PictureError when none is missing."""
    named = {s.picture for s in cell.sightings} | ({cell.picture} if cell.picture else set())
    missing = tuple(sorted(name for name in named if not cell.path_of(name).is_file()))
    if not missing:
        raise PictureError("no picture of this cell is missing")
    return missing


def found_pictures(
    cell: Cell, missing: Sequence[str], folder: Path, watch: Callable[[str], None]
) -> dict[str, Path]:
    """Files of the missing pictures' names in `folder` or below it; `watch` is told each.

    It asks nothing of Blender. Raises PictureError when none is there, and for one that is not of
    the camera's size.
    """
    from ...core.picture.pictures import read_picture

    there = {name: path for name in missing if (path := _found_in(folder, name)) is not None}
    if not there:
        raise PictureError(f"{folder / Path(missing[0]).name}: there is no such picture either")
    for path in there.values():
        watch(f"reading {path.name}")
        read_picture(path, cell.camera.intrinsics)
    return there


def rename_pictures(scene: Any, folder: Path, there: Mapping[str, Path]) -> None:
    """Let the document's names start at `folder` from now on: its old one may be gone."""
    cell = bare_cell(scene)
    moved = replace(cell, folder=folder.resolve())

    def new(name: str) -> str:
        return named_from(moved, str(there.get(name, name)), cell.folder)

    sightings = tuple(replace(s, picture=new(s.picture)) for s in cell.sightings)
    picture = new(cell.picture) if cell.picture else None
    stored, report = scene.monocell_cell, stored_report(scene)
    shown = new(stored.shown_picture) if stored.shown_picture else ""
    write_scene(scene, replace(moved, sightings=sightings, picture=picture), report)
    stored.shown_picture = shown


def _found_in(folder: Path, name: str) -> Path | None:
    """Where a folder has a picture: by the end of its old path, or by its own name alone."""
    parts = PurePath(name).parts
    places = (folder.joinpath(*parts[i:]) for i in range(len(parts)) if parts[i] != "..")
    return next((path for path in places if path.is_file()), None)


def _write(scene: Any, sightings: Iterable[Sighting], kept: Iterable[int | None]) -> None:
    cell, report = bare_cell(scene), stored_report(scene)
    changed = replace(cell, sightings=tuple(sightings))
    write_scene(scene, changed, None if report is None else report.arranged(list(kept)))
