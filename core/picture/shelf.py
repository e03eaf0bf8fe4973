# SPDX-License-Identifier: GPL-3.0-or-later
"""A cell's pictures, read when they are looked at: a name in, its pixels out, few kept."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable

from ..cell import Cell
from .pictures import Picture, read_picture

# a picture of 24 megapixels takes 72 MB
KEPT = 2


class PictureShelf:
    """The pictures of one cell. Reading raises PictureError, as `read_picture` does.

    `watch` is told the name of each picture that is looked at, for a sign of progress.
    """

    def __init__(self, cell: Cell, watch: Callable[[str], None] | None = None) -> None:
        self._cell, self._watch = cell, watch
        self._kept: OrderedDict[str, Picture] = OrderedDict()

    def read(self, name: str) -> Picture:
        """The pixels of a picture of the cell, (H, W, 3)."""
        if self._watch is not None:
            self._watch(name)
        if name not in self._kept:
            while len(self._kept) >= KEPT:
                self._kept.popitem(last=False)
            self._kept[name] = read_picture(self._cell.path_of(name), self._cell.camera.intrinsics)
        self._kept.move_to_end(name)
        return self._kept[name]

    def check_there(self, names: list[str]) -> None:
        """Raises PictureError for the first that is missing, before the first is searched."""
        for name in names:
            if not self._cell.path_of(name).is_file():
                read_picture(self._cell.path_of(name))
