# SPDX-License-Identifier: GPL-3.0-or-later
"""A cell with a rough model and its picture in, the cell with its objects aligned out."""

from __future__ import annotations

from collections.abc import Collection

from ..cell import Cell
from ..errors import InvalidValue
from ..picture.pictures import Picture
from .align import REACH_PIXELS, Watch, align
from .result import Aligned


def align_cell(
    cell: Cell,
    picture_bgr: Picture,
    names: Collection[str] | None = None,
    reach_pixels: float = REACH_PIXELS,
    watch: Watch | None = None,
) -> tuple[Cell, Aligned]:
    """Align the objects in `names` (None: all that are solved) on the cell's own picture.

    Objects that are not believed stay as they are; the report says why. Raises what `align` raises,
    and InvalidValue for a cell without solved objects.
    """
    if not cell.objects:
        raise InvalidValue("the cell has no solved object to align: model it first")
    aligned = align(
        cell.objects,
        cell.standing_camera(),
        picture_bgr,
        cell.placed_references,
        names,
        reach_pixels,
        watch,
    )
    return cell.with_objects(aligned.things), aligned
