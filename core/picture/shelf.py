# SPDX-License-Identifier: GPL-3.0-or-later
"""A cell's pictures, read when they are looked at: a name in, its pixels out, not all kept."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable

from ..cell import Cell
from .pictures import Picture, read_picture_told

# two pictures of 24 megapixels, or forty of 1280 x 960
MOST_BYTES = 150_000_000


class PictureShelf:
    """The pictures of one cell. Reading raises PictureError, as `read_picture` does.

    `watch` is told the name of each picture that is looked at, for a sign of progress.
    """

    def __init__(self, cell: Cell, watch: Callable[[str], None] | None = None) -> None:
        self._cell, self._watch = cell, watch
        self._kept: OrderedDict[str, Picture] = OrderedDict()
        self._told: dict[str, tuple[str, ...]] = {}

    def read(self, name: str) -> Picture:
        """The pixels of a picture of the cell, (H, W, 3)."""
        if self._watch is not None:
            self._watch(name)
        if name not in self._kept:
            path, lens = self._cell.path_of(name), self._cell.camera.intrinsics
            picture, self._told[name] = read_picture_told(path, lens)
            held = sum(one.nbytes for one in self._kept.values())
            while self._kept and held + picture.nbytes > MOST_BYTES:
                held -= self._kept.popitem(last=False)[1].nbytes
            self._kept[name] = picture
        self._kept.move_to_end(name)
        return self._kept[name]

    @property
    def told(self) -> tuple[str, ...]:
        """Words on rotation tags: those of the first picture that has one, and how many have."""
        tagged = [words for words in self._told.values() if words]
        more = f" ({len(tagged)} pictures have one)"
        return tuple(word + more * (len(tagged) > 1) for word in (tagged[0] if tagged else ()))

    def check_there(self, names: list[str]) -> None:
        """Raises PictureError for the first that is missing, before the first is searched."""
        for name in names:
            if not self._cell.path_of(name).is_file():
                read_picture_told(self._cell.path_of(name))
