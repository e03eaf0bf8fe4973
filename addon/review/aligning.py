# SPDX-License-Identifier: GPL-3.0-or-later
"""Alignment without Blender: a cell in, its objects on the picture's edges, or new ones, out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import count

from ...core.align.align_cell import align_cell, with_followers
from ...core.align.propose import Proposal, propose
from ...core.align.result import Aligned
from ...core.cell import Cell
from ...core.errors import InvalidValue
from ...core.picture.pictures import Picture, read_picture
from ...core.primitives import Primitive
from ...core.reference import ReferencePlane
from ...core.references.resolve import resolve_references


def aligned(
    cell: Cell, names: Sequence[str] | None, watch: Callable[[str], None]
) -> tuple[Cell, Aligned]:
    """The cell as it is, and what was found of each of the named objects (None: all).

    Raises what `align_cell` raises, PictureError for a picture that can't be read, and InvalidValue
    for a cell without one.
    """
    _, found = align_cell(cell, _picture(cell), names, watch=watch)
    return cell, found


def with_taken(cell: Cell, taken: Sequence[Primitive]) -> Cell:
    """The cell with those objects that were taken, new or in place, and all that hangs on them."""
    return resolve_references(with_followers(cell, taken))[0]


def proposed(cell: Cell, on: str, watch: Callable[[str], None]) -> tuple[Proposal, ...]:
    """Boxes and cylinders that may stand on the reference `on`, best first, by names that are free.

    Raises what `propose` raises, and InvalidValue for a line or a cell without a picture.
    """
    plane = cell.reference(on)
    if not isinstance(plane, ReferencePlane):
        raise InvalidValue(f"{on} is a line: things stand on a plane; choose one in the list")
    found = propose(cell.standing_camera(), _picture(cell), plane, cell.objects, watch)
    taken = {thing.name for thing in cell.things}
    free = (f"proposal {i}" for i in count(1) if f"proposal {i}" not in taken)
    return tuple(
        replace(one, thing=replace(one.thing, name=name))
        for one, name in zip(found, free, strict=False)
    )


def _picture(cell: Cell) -> Picture:
    if cell.picture is None:
        raise InvalidValue("the cell has no picture to look at: open one first")
    return read_picture(cell.path_of(cell.picture), cell.camera.intrinsics)
