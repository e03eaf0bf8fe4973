# SPDX-License-Identifier: GPL-3.0-or-later
"""A camera and what the operator picked in its picture in, metric objects out."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass, field, replace

from ..arrays import positive
from ..camera import Camera
from ..cell import Cell
from ..errors import DegenerateReference, InvalidValue
from ..primitives import Primitive
from ..reference import Reference
from ..references.resolve import resolve_references
from ..references.sources import FeatureOf
from ..sketch import Sketch
from .candidates import Chosen, choose
from .following import followed
from .holding import PLACING, References, holds_of, relations_of
from .model_fit import ModelFit, fit_model
from .modelled import Modelled, modelled
from .pick_equations import pick_observer

# wide enough for any hand and any noiseless test; beyond, squares overflow
LEAST_SIGMA, MOST_SIGMA = 1e-9, 1e4
# references made from objects move as these are solved together: so often they are made anew
JOINT_ROUNDS = 3
# what is told as 1 sigma may be three of them off, and hardly more
MOST_PULL = 3.5


def solve_sketch(
    camera: Camera,
    sketch: Sketch,
    references: Iterable[Reference] = (),
    things: Iterable[Primitive] = (),
    pick_sigma_pixels: float = 1.0,
) -> Modelled:
    """The object of one sketch, fitted to its picks in pixels and held by its relations.

    `references` and `things` are what its `on` and relations may name. `pick_sigma_pixels` is 1
    sigma of a pick in u and in v. The object's covariance joins pick noise, `camera.covariance` and
    the errors of what holds it.

    Raises PickError for picks that can't mean the object, naming object and pick; InvalidValue for
    an impossible pick noise or a relation that means nothing; NotConverged for relations that
    contradict each other; NoPose without a camera pose.
    """
    sigma = _checked_sigma(pick_sigma_pixels)
    named = {reference.name: reference for reference in references}
    chosen = choose(camera, sketch, named, {thing.name: thing for thing in things}, sigma)
    return modelled(chosen.fitted, chosen.plan, chosen.warnings)


@dataclass(frozen=True, eq=False)
class Modelling:
    """A cell with its objects solved, what is told of each, and doubts that are nobody's own.

    `results` are of all that was solved, in the order of the cell's objects.
    """

    cell: Cell
    results: tuple[Modelled, ...]
    warnings: tuple[str, ...]


def model(
    cell: Cell,
    pick_sigma_pixels: float = 1.0,
    *,
    joint: bool = False,
    held: Collection[str] = (),
    watch: Callable[[str], None] | None = None,
) -> Modelling:
    """Solve every sketch of a cell, and again every object that has picks.

    Each is solved after what it stands on or is held by; references made from objects follow them.
    `joint` then solves all of them once more as one problem: picks, relations, known sizes and the
    errors of camera and references, so that what is known of one improves the others. The cell
    keeps its calibrated camera: otherwise a second run would count the same picks twice.

    The objects come first, in their order, then the solved sketches. Objects without picks stay as
    they are, but for those that other objects hold: they follow. Those named in `held` follow what
    references hold them, too. `watch` is told each name as it is solved; what it raises ends the
    work.

    Raises what `solve_sketch` raises; the cell is then as it was.
    """
    work = _Work.of(cell, _checked_sigma(pick_sigma_pixels))
    while work.waiting:
        work.solve_level(watch)
    return work.finished(joint, held)


def model_cell(
    cell: Cell, pick_sigma_pixels: float = 1.0, *, joint: bool = False
) -> tuple[Cell, tuple[Modelled, ...]]:
    """`model` for those who want the cell and the results alone."""
    modelling = model(cell, pick_sigma_pixels, joint=joint)
    return modelling.cell, modelling.results


@dataclass(eq=False)
class _Work:
    """A cell being solved: what is done, and the sketches that wait for it."""

    cell: Cell
    sigma: float
    order: tuple[str, ...]
    waiting: dict[str, Sketch]
    chosen: dict[str, Chosen] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()

    @staticmethod
    def of(cell: Cell, sigma: float) -> _Work:
        sketches = {
            thing.name: thing if isinstance(thing, Sketch) else Sketch.of(thing)
            for thing in cell.things
            if isinstance(thing, Sketch) or thing.picks
        }
        still = tuple(thing for thing in cell.objects if not thing.picks)
        bare = replace(cell, objects=still, sketches=tuple(sketches.values()))
        return _Work(bare, sigma, tuple(thing.name for thing in cell.things), sketches)

    def solve_level(self, watch: Callable[[str], None] | None) -> None:
        """Solve all sketches whose holders stand; of a circle, one without those that wait."""
        self.cell, _ = resolve_references(self.cell, self.sigma)
        references = self.references()
        ready = [sketch for sketch in self.waiting.values() if self._stands(sketch, references)]
        ready = ready or [self._loosened(next(iter(self.waiting.values())), references)]
        camera, things = self.cell.standing_camera(), {t.name: t for t in self.cell.objects}
        solved = []
        for sketch in ready:
            if watch is not None:
                watch(sketch.name)
            chosen = choose(camera, sketch, references, things, self.sigma)
            whole = self.waiting.pop(sketch.name)
            thing = replace(chosen.fitted.thing, relations=whole.relations, on=whole.on)
            self.chosen[sketch.name] = replace(chosen, fitted=replace(chosen.fitted, thing=thing))
            solved.append(thing)
        self.cell = replace(
            self.cell,
            objects=(*self.cell.objects, *solved),
            sketches=tuple(self.waiting.values()),
        )

    def finished(self, joint: bool, held: Collection[str]) -> Modelling:
        """All objects fitted with what they share, in the order of the document."""
        fit = self._fit(joint=False)
        for _ in range(JOINT_ROUNDS if joint else 0):
            self._take(fit)
            fit = self._fit(joint=True)
        self._take(fit)
        self._follow(held)
        objects = {thing.name: thing for thing in self.cell.objects}
        ordered = tuple(objects[name] for name in self.order)
        results = [
            modelled(
                replace(fit.objects[name], thing=objects[name]),
                self.chosen[name].plan,
                self.chosen[name].warnings,
            )
            for name in self.order
            if name in self.chosen
        ]
        cell = replace(self.cell, objects=ordered, sketches=())
        return Modelling(cell, tuple(results), (*self.warnings, *_pulled(fit)))

    def _follow(self, held: Collection[str]) -> None:
        """What nobody picked and an object holds goes where that has gone."""
        if len(self.chosen) == len(self.cell.objects):
            return
        camera, own = self.cell.standing_camera(), self.cell.objects
        # a reference that is an object's face goes with the object
        things = [_by_feature(thing, self.cell) for thing in own]
        moved = followed(camera, self.references(), things, list(self.chosen), held)
        objects = [
            before if now is thing else replace(now, on=before.on, relations=before.relations)
            for before, thing, now in zip(own, things, moved, strict=True)
        ]
        self.cell, _ = resolve_references(self.cell.with_objects(objects), self.sigma)

    def references(self) -> dict[str, Reference]:
        """What stands, by name; a face of an object is taken from the object itself."""
        return {reference.name: reference for reference in self.cell.placed_references}

    def _fit(self, *, joint: bool) -> ModelFit:
        self.cell, self.warnings = resolve_references(self.cell, self.sigma)
        plans = {name: chosen.plan for name, chosen in self.chosen.items()}
        doubts = {n: chosen.doubt for n, chosen in self.chosen.items() if chosen.doubt is not None}
        things = [_by_feature(thing, self.cell) for thing in self.cell.objects]
        return fit_model(
            self.cell.standing_camera(),
            self.references(),
            things,
            pick_observer(plans),
            list(plans),
            joint=joint,
            doubts=doubts,
        )

    def _take(self, fit: ModelFit) -> None:
        """The fitted objects, named as their own relations name what holds them."""
        before = {thing.name: thing for thing in self.cell.objects}
        for name, fitted in fit.objects.items():
            own = before[name]
            before[name] = replace(fitted.thing, on=own.on, relations=own.relations)
        self.cell = replace(self.cell, objects=tuple(before.values()))

    def _stands(self, sketch: Sketch, references: References) -> bool:
        named = [t.name for t in self.cell.things]
        pending = {r.name for r in self.cell.references} - set(references)
        if any(path in pending for r in relations_of(sketch) for path in (r.to, r.about)):
            return False
        targets = [t for hold in holds_of(sketch, references, named) for t in hold.targets]
        return not any(t.is_object and t.name in self.waiting for t in targets)

    def _loosened(self, sketch: Sketch, references: References) -> Sketch:
        """The sketch without relations to what waits for it in turn; it must not stand on that."""
        relations = relations_of(sketch)
        kept = tuple(
            relation
            for relation in relations
            if self._stands(replace(sketch, on=None, relations=(relation,)), references)
        )
        lost = [r for r in relations if r not in kept and r.kind in PLACING]
        if lost:
            raise DegenerateReference(
                f"{sketch.name}: {lost[0].kind} {lost[0].to}, which is held by {sketch.name} in "
                "turn; let one of them stand on something else"
            )
        return replace(sketch, on=None, relations=kept)


def _pulled(fit: ModelFit) -> list[str]:
    """A word when the objects want camera or references elsewhere than these say they can be."""
    if fit.pull_sigmas <= MOST_PULL:
        return []
    return [
        f"the objects together pull camera and references by {fit.pull_sigmas:.1f} of their own "
        "sigmas: a known size, a relation or the calibration is wrong"
    ]


def _by_feature(thing: Primitive, cell: Cell) -> Primitive:
    """With references that are faces or axes of objects replaced by these: they move together."""
    feature_of = {
        reference.name: reference.source.of
        for reference in cell.references
        if isinstance(reference.source, FeatureOf)
    }
    if not feature_of:
        return thing
    relations = tuple(
        replace(
            relation,
            to=feature_of.get(relation.to, relation.to),
            about=feature_of.get(relation.about or "", relation.about),
        )
        for relation in thing.relations
    )
    on = None if thing.on is None else feature_of.get(thing.on, thing.on)
    return replace(thing, on=on, relations=relations)


def _checked_sigma(pick_sigma_pixels: float) -> float:
    sigma = positive(pick_sigma_pixels, "pick_sigma_pixels")
    if not LEAST_SIGMA <= sigma <= MOST_SIGMA:
        raise InvalidValue(
            f"pick_sigma_pixels: {sigma:g} px is no error of a hand; "
            f"give {LEAST_SIGMA:g} to {MOST_SIGMA:g}"
        )
    return sigma


__all__: Sequence[str] = ["Modelled", "model_cell", "solve_sketch"]
