# SPDX-License-Identifier: GPL-3.0-or-later
"""The list of sightings, edited: a scene and what changes in, its document changed."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from ..core.cell import Cell
from ..core.errors import InvalidValue, PictureError
from ..core.sighting import Sighting
from .document import bare_cell, stored_report, write_scene


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


def rename_pictures(scene: Any, folder: Path) -> int:
    """Name the pictures that are missing by files of the same name in `folder`. Returns how many.

    Raises PictureError when none is missing, or for the first that is not there either.
    """
    cell = bare_cell(scene)
    named = [s.picture for s in cell.sightings] + ([cell.picture] if cell.picture else [])
    missing = {name for name in named if not cell.path_of(name).is_file()}
    if not missing:
        raise PictureError("no picture of this cell is missing")
    for name in sorted(missing):
        if not (folder / Path(name).name).is_file():
            raise PictureError(f"{folder / Path(name).name}: there is no such picture either")
    # the document's names start there from now on: its old folder may be gone
    moved = replace(cell, folder=folder.resolve())
    new = {
        name: Path(name).name if name in missing else named_from(moved, name, cell.folder)
        for name in named
    }
    sightings = tuple(replace(s, picture=new.get(s.picture, s.picture)) for s in cell.sightings)
    picture = new.get(cell.picture, cell.picture) if cell.picture else None
    write_scene(scene, replace(moved, sightings=sightings, picture=picture), stored_report(scene))
    stored = scene.monocell_cell
    stored.shown_picture = new.get(stored.shown_picture, stored.shown_picture)
    return len(missing)


def _write(scene: Any, sightings: Iterable[Sighting], kept: Iterable[int | None]) -> None:
    cell, report = bare_cell(scene), stored_report(scene)
    changed = replace(cell, sightings=tuple(sightings))
    write_scene(scene, changed, None if report is None else report.arranged(list(kept)))
