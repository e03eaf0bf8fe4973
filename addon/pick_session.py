# SPDX-License-Identifier: GPL-3.0-or-later
"""One object being picked: clicks and the cursor go in, lines and words to show come out."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..core.arrays import Array
from ..core.camera import Camera
from ..core.errors import MonocellError
from ..core.modelling.mapped_covariance import point_covariance_on_plane
from ..core.modelling.reverse_mapping import points_on_plane
from ..core.modelling.solve import solve_sketch
from ..core.picture.wireframe import Polyline, wireframe
from ..core.reference import ReferencePlane
from ..core.sketch import Sketch
from .pick_plan import PickPlan, PickStep

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
    """A plan, the camera and plane it is for, and the pixels (2,) clicked in each step so far.

    `stage` is the step that the next click belongs to; `sigma_pixels` how far off clicks are.
    """

    plan: PickPlan
    camera: Camera
    plane: ReferencePlane
    sigma_pixels: float = 1.0
    pixels: tuple[tuple[Array, ...], ...] = ()
    stage: int = 0

    def __post_init__(self) -> None:
        if not self.pixels:
            object.__setattr__(self, "pixels", ((),) * len(self.plan.steps))

    @property
    def step(self) -> PickStep:
        """The step that the next click belongs to."""
        return self.plan.steps[self.stage]

    @property
    def complete(self) -> bool:
        """Whether all clicks that are needed have been made."""
        steps = zip(self.plan.steps, self.pixels, strict=True)
        return all(len(clicked) >= step.least for step, clicked in steps)

    @property
    def full(self) -> bool:
        """Whether nothing more can be clicked."""
        return self.complete and len(self.pixels[self.stage]) == self.step.most

    @property
    def open(self) -> bool:
        """Whether the step takes any number of clicks and has enough: Enter goes on to the next."""
        enough = len(self.pixels[self.stage]) >= self.step.least
        return enough and self.stage + 1 < len(self.plan.steps)

    @property
    def prompt(self) -> str:
        """What the next click is for."""
        return self.step.prompt(len(self.pixels[self.stage]))

    def picked(self, pixel: Array) -> PickSession:
        """With one click more; a step that has all it can take gives way to the next."""
        clicked = (*self.pixels[self.stage], pixel)
        pixels = (*self.pixels[: self.stage], clicked, *self.pixels[self.stage + 1 :])
        after = replace(self, pixels=pixels)
        return after.advanced() if after.open and len(clicked) == self.step.most else after

    def advanced(self) -> PickSession:
        """At the next step."""
        return replace(self, stage=self.stage + 1)

    def taken_back(self) -> PickSession:
        """Without the last click."""
        stages = [i for i, clicked in enumerate(self.pixels) if clicked]
        if not stages:
            return self
        last = stages[-1]
        pixels = (*self.pixels[:last], self.pixels[last][:-1], *self.pixels[last + 1 :])
        return replace(self, pixels=pixels, stage=last)

    def view_pixels(self) -> Array:
        """The clicks (N, 2) in the undistorted view."""
        clicked = [pixel for pixels in self.pixels for pixel in pixels]
        return self._undistorted(np.array(clicked).reshape(-1, 2))

    def picks(self) -> dict[str, list[object]]:
        """The document's picks."""
        return self.plan.picks(self.camera, self.plane, self.pixels)

    def preview(self, cursor: Array | None) -> Preview:
        """The object as it would be with a click at the cursor (2,), a pixel of the picture."""
        if cursor is None:
            return Preview((), "outside the picture", "")
        after = self.picked(cursor)
        try:
            place = self.place(cursor) if self.step.on_reference else ""
            if not after._solvable():
                return Preview(after._chain(), place, "")
            return after._solved(place)
        except MonocellError as error:
            return Preview(after._chain(), "", _plain(error))

    def place(self, pixel: Array) -> str:
        """Where a pixel (2,) hits the reference, in metres, and how surely."""
        # adding nought turns -0.000 into 0.000
        x, y, z = np.round(points_on_plane(self.camera, self.plane, pixel[None])[0], 3) + 0.0
        covariance = point_covariance_on_plane(
            self.camera, self.plane, pixel[None], self.sigma_pixels
        )[0]
        worst = 1e3 * float(np.sqrt(max(np.linalg.eigvalsh(covariance)[-1], 0.0)))
        return f"x {x:.3f}   y {y:.3f}   z {z:.3f} m   ± {worst:.{1 if worst < 100 else 0}f} mm"

    def _solvable(self) -> bool:
        """Whether the foot is there, and sizes stand in for what is not."""
        steps = list(zip(self.plan.steps, self.pixels, strict=True))
        foot = all(len(clicked) >= step.least for step, clicked in steps if step.on_reference)
        begun = any(len(clicked) for step, clicked in steps if not step.on_reference)
        return self.complete or (foot and not begun and bool(self.plan.flat))

    def _solved(self, place: str) -> Preview:
        from ..core.picture.overlay import caption

        known = {} if self.complete else self.plan.flat
        sketch = Sketch(PREVIEW, self.plan.kind, self.plane.name, self.picks(), known)
        thing = solve_sketch(self.camera, sketch, [self.plane]).object
        lines = wireframe(thing, self._pinhole_camera())
        return Preview(lines, caption(thing) if self.complete else place, "")

    def _chain(self) -> tuple[Polyline, ...]:
        """Lines from click to click, a part of the object each."""
        parts = [self._undistorted(np.array(p).reshape(-1, 2)) for p in self.pixels]
        return tuple(Polyline(part, True) for part in parts if len(part) > 1)

    def _pinhole_camera(self) -> Camera:
        return replace(self.camera, intrinsics=self.camera.intrinsics.undistorted())

    def _undistorted(self, pixels: Array) -> Array:
        intrinsics = self.camera.intrinsics
        return intrinsics.undistorted().project(intrinsics.rays(pixels))


def _plain(error: MonocellError) -> str:
    """The refusal without the name that stands for an object still without one."""
    return str(error).replace(f"{PREVIEW}: ", "").split(";")[0]
