# SPDX-License-Identifier: GPL-3.0-or-later
"""The picks of an object as handles: a pixel in, the handle there and the object it makes out."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...core.arrays import Array
from ...core.camera import Camera
from ...core.cell import Cell
from ...core.errors import InvalidValue, MonocellError
from ...core.length_unit import UNITS
from ...core.modelling.solve import solve_sketch
from ...core.picture.wireframe import wireframe
from ...core.primitives import Primitive
from ...core.sketch import Sketch
from ..modelling.editing import with_moved_pick
from .pick_session import Preview

Handle = tuple[str, int]


@dataclass(frozen=True, eq=False)
class Handles:
    """An object of a cell with its picks; `sigma` is how far off clicks are, in pixels, `unit`
    what sizes are told in."""

    cell: Cell
    thing: Primitive
    sigma: float
    unit: str = "mm"

    @staticmethod
    def of(cell: Cell, thing: Primitive, sigma: float, unit: str = "mm") -> Handles:
        """Raises InvalidValue for an object without picks."""
        handles = Handles(cell, thing, sigma, unit)
        if not handles.places:
            raise InvalidValue(f"{thing.name}: has no picks that could be moved")
        return handles

    @property
    def places(self) -> dict[Handle, Array]:
        """The pixels (2,) of the picture as it came, by role and number."""
        return picks_by_place(self.thing)

    def nearest(self, pixel: Array, reach: float) -> Handle | None:
        """The handle that is nearest to a pixel (2,), None where all are farther than `reach`."""
        places = self.places
        away = {handle: float(np.linalg.norm(at - pixel)) for handle, at in places.items()}
        best = min(away, key=lambda handle: away[handle])
        return best if away[best] <= reach else None

    def moved(self, handle: Handle, pixel: Array) -> Preview:
        """The object as it would be with a pick elsewhere, as lines of the undistorted view."""
        from ...core.picture.overlay import caption

        sketch = Sketch.of(with_moved_pick(self.thing, *handle, pixel))
        others = [thing for thing in self.cell.objects if thing is not self.thing]
        camera = self.cell.standing_camera()
        references = self.cell.placed_references
        try:
            thing = solve_sketch(camera, sketch, references, others, self.sigma).object
        except MonocellError as error:
            return Preview((), "", str(error).split(";")[0])
        return Preview(wireframe(thing, _pinhole(camera)), caption(thing, UNITS[self.unit]), "")


def picks_by_place(thing: Primitive) -> dict[Handle, Array]:
    """The picks of an object, pixels (2,) by role and number."""
    return {
        (role, i): np.array(pixel, dtype=float)
        for role, pixels in thing.picks.items()
        for i, pixel in enumerate(pixels)
        if pixel is not None
    }


def view_pixels(camera: Camera, thing: Primitive) -> Array:
    """The picks of an object, (N, 2) pixels of the undistorted view."""
    pixels = np.array(list(picks_by_place(thing).values())).reshape(-1, 2)
    return camera.intrinsics.undistorted().project(camera.intrinsics.rays(pixels))


def _pinhole(camera: Camera) -> Camera:
    return replace(camera, intrinsics=camera.intrinsics.undistorted())
