# SPDX-License-Identifier: GPL-3.0-or-later
"""What stays in the pictures of a fixed camera: a cell in, hints to what moved out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from ..ball.hints import FindHints
from ..cell import Cell
from ..errors import InvalidValue, PictureError, SphereNotFound
from ..picture.shelf import PictureShelf
from ..sighting import SphereSighting

T = TypeVar("T")
# the median of three forgets a ball that one of them shows; more than five tell little more
FEWEST, MOST = 3, 5
# all of them are in memory at once
MOST_BYTES = 150_000_000


@dataclass(frozen=True, eq=False)
class Scenery:
    """What whole pictures are held against; nothing where the camera moves or pictures are few."""

    hints: FindHints | None

    @staticmethod
    def of(cell: Cell, shelf: PictureShelf) -> Scenery:
        """From the pictures that are searched without a window, each with the ball elsewhere."""
        from ..ball.change import background_of

        balls = [s for s in cell.sightings if isinstance(s, SphereSighting) and s.window is None]
        names = list(dict.fromkeys(s.picture for s in balls))
        if cell.mount is not None or len(names) < FEWEST:
            return Scenery(None)
        lens = cell.camera.intrinsics
        count = min(len(names), MOST, MOST_BYTES // (3 * lens.width * lens.height))
        if count < FEWEST:
            return Scenery(None)
        spread = np.unique(np.linspace(0, len(names) - 1, count).round().astype(int))
        try:
            return Scenery(
                FindHints(background=background_of([shelf.read(names[i]) for i in spread]))
            )
        except PictureError:
            # the picture that can't be read is named when it is searched
            return Scenery(None)

    def hinted(self, find: Callable[..., T], sighting: SphereSighting) -> T:
        """Search where the picture changed first, then everywhere. Raises as `find` does."""
        if self.hints is not None and sighting.window is None:
            try:
                return find(hints=self.hints)
            except (InvalidValue, SphereNotFound):
                # nothing changed, or all of it: the pictures may not be of one place
                pass
        return find()
