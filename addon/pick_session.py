# SPDX-License-Identifier: GPL-3.0-or-later
"""One object being picked: clicks and the cursor go in, lines and words to show come out."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..core.arrays import Array
from ..core.camera import Camera
from ..core.errors import MonocellError
from ..core.modelling.reverse_mapping import points_on_plane
from ..core.modelling.solve import solve_sketch
from ..core.picture.wireframe import Polyline, wireframe
from ..core.reference import ReferencePlane
from ..core.sketch import Sketch
from .pick_plan import PickPlan, picks_of

PREVIEW = "preview"


@dataclass(frozen=True, eq=False)
class Preview:
    """What to draw while picking, in undistorted pixels: lines, and words beside the cursor.

    `complaint` says why the picks with the cursor as the next can't be the object, empty if they
    can.
    """

    lines: tuple[Polyline, ...]
    words: str
    complaint: str


@dataclass(frozen=True, eq=False)
class PickSession:
    """A plan, the camera and plane it is for, and the pixels (2,) clicked so far, as picture."""

    plan: PickPlan
    camera: Camera
    plane: ReferencePlane
    pixels: tuple[Array, ...] = ()

    @property
    def complete(self) -> bool:
        """Whether all clicks that are needed have been made."""
        return len(self.pixels) >= self.plan.clicks

    @property
    def prompt(self) -> str:
        """What the next click is for."""
        if self.complete:
            return "another point of the top, or Enter"
        return self.plan.prompts[len(self.pixels)]

    def picked(self, pixel: Array) -> PickSession:
        """With one click more."""
        return replace(self, pixels=(*self.pixels, pixel))

    def taken_back(self) -> PickSession:
        """Without the last click."""
        return replace(self, pixels=self.pixels[:-1])

    def view_pixels(self) -> Array:
        """The clicks (N, 2) in the undistorted view."""
        return self._undistorted(np.array(self.pixels).reshape(-1, 2))

    def picks(self) -> dict[str, list[object]]:
        """The document's picks."""
        return picks_of(self.plan, self.camera, self.plane, self.pixels)

    def preview(self, cursor: Array | None) -> Preview:
        """The object as it would be with a click at the cursor (2,), a pixel of the picture."""
        if cursor is None:
            return Preview((), "outside the picture", "")
        after = self.picked(cursor)
        try:
            place = self._place(cursor)
            if len(after.pixels) < self.plan.foot_clicks:
                return Preview(after._chain(), place, "")
            return after._solved(place)
        except MonocellError as error:
            return Preview(after._chain(), "", _plain(error))

    def _solved(self, place: str) -> Preview:
        from ..core.picture.overlay import caption

        known = {} if self.complete else self.plan.flat
        sketch = Sketch(PREVIEW, self.plan.kind, self.plane.name, self.picks(), known)
        thing = solve_sketch(self.camera, sketch, [self.plane]).object
        lines = wireframe(thing, self._pinhole_camera())
        return Preview(lines, caption(thing) if self.complete else place, "")

    def _place(self, pixel: Array) -> str:
        """Where a click would hit the reference, in metres; nothing while the height is set."""
        if len(self.pixels) >= self.plan.foot_clicks:
            return ""
        # adding nought turns -0.000 into 0.000
        x, y, z = np.round(points_on_plane(self.camera, self.plane, pixel[None])[0], 3) + 0.0
        return f"x {x:.3f}   y {y:.3f}   z {z:.3f} m"

    def _chain(self) -> tuple[Polyline, ...]:
        pixels = self.view_pixels()
        return (Polyline(pixels, True),) if len(pixels) > 1 else ()

    def _pinhole_camera(self) -> Camera:
        return replace(self.camera, intrinsics=self.camera.intrinsics.undistorted())

    def _undistorted(self, pixels: Array) -> Array:
        intrinsics = self.camera.intrinsics
        return intrinsics.undistorted().project(intrinsics.rays(pixels))


def _plain(error: MonocellError) -> str:
    """The refusal without the name that stands for an object still without one."""
    return str(error).replace(f"{PREVIEW}: ", "").split(";")[0]
