# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene's cell into a file, which is its own document from then on."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ...core.cell import Cell
from ...core.document.cell_file import cell_from_document, document_from_cell, write_cell
from .document import read_scene, show_objects, store_cell, stored_report


def save_scene(scene: Any, path: Path) -> Cell:
    """Write the document whole or not at all; returns the cell that was written.

    Names of pictures and textures start at the file's folder from then on, so that the scene finds
    what its document finds. Raises DocumentError for a file that is none, and leaves all as it was.
    """
    cell, stored = read_scene(scene), scene.monocell_cell
    write_cell(cell, path)
    stored.path = str(path)
    if path.parent.resolve() == cell.folder.resolve():
        return cell
    moved = cell_from_document(document_from_cell(cell, path.parent), path.parent)
    shown = _renamed(cell, moved).get(stored.shown_picture, stored.shown_picture)
    store_cell(scene, moved, stored_report(scene))
    stored.shown_picture = shown
    # an object names its textures itself
    dressed = [t.name for t in moved.objects if t.appearance is not None and t.appearance.textures]
    if dressed:
        show_objects(scene, moved, dressed)
    return moved


def _renamed(old: Cell, new: Cell) -> dict[str, str]:
    """The new name of each picture by its old one."""
    pairs = [(a.picture, b.picture) for a, b in zip(old.sightings, new.sightings, strict=True)]
    if old.picture is not None and new.picture is not None:
        pairs.append((old.picture, new.picture))
    return dict(pairs)
