# SPDX-License-Identifier: GPL-3.0-or-later
"""Alignment without Blender: a cell in, the cell on its picture's edges and what was found out."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from ..core.align.align_cell import align_cell
from ..core.align.result import AlignedObject
from ..core.cell import Cell
from ..core.errors import InvalidValue
from ..core.picture.pictures import read_picture
from ..core.references.resolve import resolve_references


def aligned(
    cell: Cell, names: Sequence[str] | None, watch: Callable[[str], None]
) -> tuple[Cell, Mapping[str, AlignedObject]]:
    """The cell with the named objects (None: all) aligned, and what was found of each, by name.

    Raises what `align_cell` raises, PictureError for a picture that can't be read, and InvalidValue
    for a cell without one.
    """
    if cell.picture is None:
        raise InvalidValue("the cell has no picture to align on: open one first")
    picture = read_picture(cell.path_of(cell.picture), cell.camera.intrinsics)
    moved, found = align_cell(cell, picture, names, watch=watch)
    return resolve_references(moved)[0], found.objects
