# SPDX-License-Identifier: GPL-3.0-or-later
"""A cell in, the same cell with every reference worked out from its source and its error out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from ..arrays import Array, positive
from ..camera import Camera
from ..cell import Cell
from ..errors import InvalidValue
from ..reference import PendingReference, Reference, ReferencePlane, kind_of
from ..shape.features import FeatureKind
from .from_others import along_direction, facing_camera, feature_of, intersection, parallel
from .from_picks import through_picks, upright
from .from_points import through_points
from .order import in_order, objects_behind
from .placed import Lookup, Placed, Task, as_reference, placed_as_given, placed_feature
from .sources import Stated

PLACING: Mapping[str, Any] = {
    "points": through_points,
    "picks": through_picks,
    "feature": feature_of,
    "facing_camera": facing_camera,
    "upright": upright,
    "parallel": parallel,
    "intersection": intersection,
    "direction": along_direction,
}


@dataclass(frozen=True, eq=False)
class Resolution:
    """The cell with its references in place, what is doubtful, and residuals in metres by name.

    References of objects that are not solved yet are `PendingReference`s, named in `pending`.
    """

    cell: Cell
    warnings: tuple[str, ...]
    residuals: Mapping[str, Array]
    pending: tuple[str, ...]


def resolve_references(cell: Cell, pick_sigma_pixels: float = 1.0) -> tuple[Cell, tuple[str, ...]]:
    """The cell with every reference's place and covariance worked out anew, and the warnings.

    References of references and of objects come in the order in which they depend on each other. A
    reference without a source stays as it is; one that hangs on an object that is only picked yet
    becomes pending: resolve again when the object is solved (`order.objects_behind` tells which).

    Raises PickError, DegenerateReference and InvalidValue, naming the reference, for what can't be;
    NoPose where the camera's pose is needed and not known.
    """
    resolution = resolved(cell, pick_sigma_pixels)
    return resolution.cell, resolution.warnings


def resolved_reference(
    cell: Cell, name: str, pick_sigma_pixels: float = 1.0
) -> tuple[Reference, tuple[str, ...]]:
    """One reference, or face, edge or axis of an object, worked out anew, and the warnings.

    Only what it is made from is looked at. Raises as `resolve_references` does, and InvalidValue
    for a reference of an object that is only picked yet.
    """
    walk = _Walk(cell, positive(pick_sigma_pixels, "pick_sigma_pixels"))
    order = in_order(cell, [name])
    unsolved = objects_behind(cell, name, unsolved=True)
    if unsolved:
        raise InvalidValue(
            f"{name}: is made from {', '.join(unsolved)}, picked and not solved yet; "
            "model the cell first"
        )
    placed = [walk.place(one) for one in order]
    warnings = tuple(warning for one in placed for warning in one.warnings)
    reference = next((r for r in cell.references if r.name == name), None)
    if reference is None:
        return cell.reference(name), warnings
    return _in_place(reference, walk.place(name)), warnings


def resolved(cell: Cell, pick_sigma_pixels: float = 1.0) -> Resolution:
    """`resolve_references` with all that it found."""
    walk = _Walk(cell, positive(pick_sigma_pixels, "pick_sigma_pixels"))
    order = in_order(cell, [reference.name for reference in cell.references])
    waiting = tuple(name for name in order if objects_behind(cell, name, unsolved=True))
    placed = {name: walk.place(name) for name in order if name not in waiting}
    references = [
        _pending(reference)
        if reference.name in waiting
        else _in_place(reference, placed[reference.name])
        for reference in cell.references
    ]
    return Resolution(
        replace(cell, references=tuple(references)),
        tuple(warning for one in placed.values() for warning in one.warnings),
        {name: one.residuals for name, one in placed.items() if len(one.residuals)},
        waiting,
    )


@dataclass(eq=False)
class _Walk:
    """One pass through a cell: what is in place already is not placed twice."""

    cell: Cell
    pick_sigma_pixels: float
    done: dict[str, Placed] = field(default_factory=dict)

    def place(self, name: str, user: str = "") -> Placed:
        """The place of a reference or feature, for the reference `user`."""
        if name not in self.done:
            self.done[name] = self._placed(name, user)
        return self.done[name]

    def camera(self) -> Camera:
        return self.cell.standing_camera()

    def _placed(self, name: str, user: str) -> Placed:
        reference = next((r for r in self.cell.references if r.name == name), None)
        if reference is None:
            return self._feature(name, user)
        source = reference.source
        if source is None or isinstance(source, Stated):
            assert not isinstance(reference, PendingReference)
            return placed_as_given(reference)
        kind: FeatureKind = "plane" if kind_of(reference) == "plane" else "line"
        stated = reference.normal if isinstance(reference, ReferencePlane) else None
        task = Task(name, kind, stated, self._placer(name), self.camera, self.pick_sigma_pixels)
        return PLACING[source.way](task, source)

    def _placer(self, user: str) -> Lookup:
        return lambda name: self.place(name, user)

    def _feature(self, path: str, user: str) -> Placed:
        owner, _, name = path.rpartition(".")
        thing = next(thing for thing in self.cell.objects if thing.name == owner)
        try:
            return placed_feature(thing, name, self.cell.camera)
        except InvalidValue as error:
            raise InvalidValue(f"{user}: {error}" if user else str(error)) from None


def _pending(reference: Reference | PendingReference) -> PendingReference:
    if isinstance(reference, PendingReference):
        return reference
    assert reference.source is not None
    return PendingReference(reference.name, kind_of(reference), reference.source)


def _in_place(reference: Reference | PendingReference, placed: Placed) -> Reference:
    if reference.source is None:
        assert not isinstance(reference, PendingReference)
        return reference
    return as_reference(reference.name, placed, reference.source)
