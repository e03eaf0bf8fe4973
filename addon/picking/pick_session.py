# SPDX-License-Identifier: GPL-3.0-or-later
"""One object being picked: clicks, typed sizes and the cursor go in, lines and words come out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from ...core.arrays import Array
from ...core.camera import Camera
from ...core.errors import MonocellError
from ...core.length_unit import UNITS
from ...core.modelling.mapped_covariance import point_covariance_on_plane
from ...core.modelling.reverse_mapping import points_on_plane
from ...core.modelling.solve import solve_sketch
from ...core.picture.wireframe import Polyline, wireframe
from ...core.primitives import KINDS, Primitive
from ...core.reference import Reference, ReferencePlane
from ...core.sketch import Sketch
from ..lengths import length, place_unit
from .pick_plan import PickPlan, Stage, picks_of
from .typed_size import metres_of, with_sign

PREVIEW = "preview"
# an error from here on, in metres, has no digits to spare
FAR_SIGMA = 0.1


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
    """A plan, the camera and reference it is for, and what was clicked and typed so far.

    `taken` are a role and a pixel (2,) of the picture as it came each; `kept` tells that the last
    click left its stage open for more, `closed` the stages that were closed by hand. `things` are
    what the reference may belong to. `typed` are texts by the name of the size, `sized` the size
    that the keys go to, empty for the one that the mouse sets; `unit` is that of numbers without.
    """

    plan: PickPlan
    camera: Camera
    reference: Reference | None
    things: tuple[Primitive, ...] = ()
    taken: tuple[tuple[str, Array], ...] = ()
    kept: bool = False
    closed: tuple[str, ...] = ()
    typed: Mapping[str, str] = field(default_factory=dict)
    sized: str = ""
    sigma: float = 1.0
    unit: str = "mm"

    @property
    def stage(self) -> Stage | None:
        """What the next click is for; None when all that is needed has been clicked."""
        if self.kept and self.taken:
            last = self.plan.stage_of(self.taken[-1][0])
            if last is not None and self._count(last) < last.most:
                return last
        return next((stage for stage in self.plan.stages if self._wanted(stage)), None)

    @property
    def complete(self) -> bool:
        """Whether all that is needed has been clicked or typed."""
        return self.stage is None

    @property
    def prompt(self) -> str:
        """What the next click is for."""
        stage = self.stage
        if stage is None:
            return "click or Enter: done"
        count = self._count(stage)
        return stage.prompts[count] if count < len(stage.prompts) else stage.more

    @property
    def known(self) -> dict[str, float]:
        """The sizes that were typed, metres, and those that the plan knows."""
        values = {name: metres_of(text, self.unit) for name, text in self.typed.items()}
        typed = {name: value for name, value in values.items() if value is not None}
        return {**self.plan.known, **typed}

    @property
    def size_now(self) -> str:
        """The size that keys go to."""
        if self.sized:
            return self.sized
        names = self.sizes
        stage = self.stage
        if stage is None or not stage.sets:
            return names[-1] if stage is None else names[0]
        return stage.sets[min(max(self._count(stage) - 1, 0), len(stage.sets) - 1)]

    @property
    def sizes(self) -> tuple[str, ...]:
        """The sizes that can be typed."""
        return tuple(n for n in KINDS[self.plan.kind].size_names if n not in self.plan.known)

    @property
    def typed_words(self) -> str:
        """What was typed, with a mark where the next key goes; empty before anything was."""
        shown = []
        for name in self.sizes:
            text = self.typed.get(name, "")
            if text or name == self.sized:
                unit = "" if text.endswith(("m", "c")) else f" {self.unit}"
                mark = "|" if name == self.size_now else ""
                shown.append(f"{name.replace('_', ' ')} = {text}{mark}{unit}")
        return "   ".join(shown)

    def picked(self, pixel: Array, *, more: bool = False) -> PickSession:
        """With one click more; with `more` its stage stays open for another."""
        role = (self.stage or self.plan.stages[-1]).role
        return replace(self, taken=(*self.taken, (role, pixel)), kept=more, sized="")

    def taken_back(self) -> PickSession:
        """Without the last click."""
        if not self.taken:
            return self
        role = self.taken[-1][0]
        closed = tuple(name for name in self.closed if name != role)
        return replace(self, taken=self.taken[:-1], kept=False, closed=closed)

    def closes(self, pixel: Array | None, reach: float) -> bool:
        """Whether a stage that takes any number ends here: at its first pick, or by Enter (None).

        `reach` in pixels.
        """
        stage = self.stage
        if stage is None or not stage.closing or self._count(stage) < len(stage.prompts):
            return False
        if pixel is None:
            return True
        first = next(taken for role, taken in self.taken if role == stage.role)
        return float(np.linalg.norm(first - pixel)) <= reach

    def with_closed(self) -> PickSession:
        """With the stage of now closed."""
        stage = self.stage
        return self if stage is None else replace(self, closed=(*self.closed, stage.role))

    def with_key(self, sign: str) -> PickSession:
        """With a sign typed at the end of the size of now."""
        name = self.size_now
        text = with_sign(self.typed.get(name, ""), sign)
        return replace(self, typed={**self.typed, name: text}, sized=name) if text else self

    def without_key(self) -> PickSession:
        """Without the last typed sign."""
        name = self.sized
        text = self.typed.get(name, "")[:-1]
        rest = {key: value for key, value in self.typed.items() if key != name}
        return replace(
            self, typed={**rest, name: text} if text else rest, sized=name if text else ""
        )

    def next_size(self) -> PickSession:
        """With the keys going to the next size, going round."""
        names = self.sizes
        return replace(self, sized=names[(names.index(self.size_now) + 1) % len(names)])

    def replanned(self, plan: PickPlan) -> PickSession:
        """Picked another way: what both ways know stays."""
        taken = tuple(pick for pick in self.taken if plan.stage_of(pick[0]) is not None)
        typed = {n: t for n, t in self.typed.items() if n not in plan.known}
        return replace(self, plan=plan, taken=taken, typed=typed, sized="", kept=False)

    def view_pixels(self) -> Array:
        """The clicks (N, 2) in the undistorted view."""
        return self._undistorted(np.array([pixel for _, pixel in self.taken]).reshape(-1, 2))

    def picks(self) -> dict[str, list[object]]:
        """The document's picks."""
        return picks_of(self.plan, self.camera, self.reference, self.taken)

    def solved(self) -> Primitive:
        """The object as picked and typed so far. Raises PickError where that is too little."""
        on, relations = self.plan.holding(self.reference)
        sketch = Sketch(PREVIEW, self.plan.kind, on, self.picks(), self.known, relations=relations)
        return self._solve(sketch)

    def preview(self, cursor: Array | None) -> Preview:
        """The object as it would be with a click at the cursor (2,), a pixel of the picture."""
        if cursor is None:
            return Preview((), "outside the picture", "")
        if self.complete:
            return self._told(self, "")
        after = self.picked(cursor, more=self.kept)
        try:
            place = self._place(cursor)
        except MonocellError as error:
            return Preview(after._chain(), "", _plain(error))
        return self._told(after, place)

    def _told(self, after: PickSession, place: str) -> Preview:
        from ...core.picture.overlay import caption

        first = after.plan.stages[0]
        if after._count(first) < len(first.prompts):
            return Preview(after._chain(), place, "")
        stage = after.stage
        if stage is not None and (stage == first or not after._count(stage)):
            # too little is there yet for more than the first stage
            return after._flat(place, "")
        try:
            thing = after.solved()
            return Preview(after._lines(thing), place or caption(thing, UNITS[self.unit]), "")
        except MonocellError as error:
            # while picks are still missing, what they can't tell yet is no complaint
            return after._flat(place, _plain(error) if after.complete else "")

    def _flat(self, place: str, complaint: str) -> Preview:
        """What the first stage says alone; its refusal counts where nothing else is refused."""
        if self.plan.flat is None:
            return Preview(self._chain(), place, complaint)
        kind, known = self.plan.flat
        first = self.plan.stages[0].role
        picks = {first: [pixel.tolist() for role, pixel in self.taken if role == first]}
        on, relations = self.plan.holding(self.reference)
        try:
            thing = self._solve(Sketch(PREVIEW, kind, on, picks, known, relations=relations))
        except MonocellError as error:
            return Preview(self._chain(), place, complaint or _plain(error))
        return Preview(self._lines(thing), place, complaint)

    def _solve(self, sketch: Sketch) -> Primitive:
        references = [] if self.reference is None else [self.reference]
        modelled = solve_sketch(self.camera, sketch, references, self.things, self.sigma)
        return modelled.object

    def _count(self, stage: Stage) -> int:
        return sum(role == stage.role for role, _ in self.taken)

    def _wanted(self, stage: Stage) -> bool:
        count = self._count(stage)
        if stage.closing and stage.role not in self.closed:
            return True
        told = bool(stage.sets) and stage != self.plan.stages[0]
        if told and all(name in self.known for name in stage.sets):
            return False
        return count < len(stage.prompts)

    def _place(self, pixel: Array) -> str:
        """Where a click would hit the reference, in metres, and how surely; else nothing."""
        stage = self.stage
        on_it = stage is not None and stage.role in ("base", "rim") and self.plan.held == "stands"
        return self.place(pixel) if on_it else ""

    def place(self, pixel: Array) -> str:
        """Where a pixel (2,) hits the reference, in the user's unit, and how surely."""
        if not isinstance(self.reference, ReferencePlane):
            return ""
        point = points_on_plane(self.camera, self.reference, pixel[None])[0]
        covariance = point_covariance_on_plane(
            self.camera, self.reference, pixel[None], self.sigma
        )[0]
        worst = float(np.sqrt(max(np.linalg.eigvalsh(covariance)[-1], 0.0)))
        world = place_unit(self.unit)
        x, y, z = (UNITS[world].number(value, finer=-1) for value in point)
        told = length(worst, self.unit, finer=0 if worst < FAR_SIGMA else -1)
        return f"x {x}   y {y}   z {z} {world}   ± {told}"

    def _lines(self, thing: Primitive) -> tuple[Polyline, ...]:
        return wireframe(thing, self._pinhole_camera())

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
