# SPDX-License-Identifier: GPL-3.0-or-later
"""The whole of a work cell: camera, picture, ball sightings, references and objects."""

from __future__ import annotations

from collections.abc import Collection, Container, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from .bodies import rigid_bodies
from .camera import Camera
from .composite import Composite
from .errors import InvalidValue, NoPose
from .mount import Mount
from .primitives import KINDS, Primitive
from .reference import PendingReference, Reference
from .references.placed import reference_of_feature
from .relation import RELATIONS, Relation
from .shape.features import feature_names
from .sighting import Sighting
from .sketch import Sketch

Named = Mapping[str, Primitive | Sketch]


@dataclass(frozen=True, eq=False)
class Cell:
    """One cell document. Picture names are relative to `folder`, the document's place.

    `objects` are solved; `sketches` are picked only, and become objects when they are solved. A
    camera that rides on the robot has a `mount`; its `camera` stands as it stood for `picture`.

    `composites` group objects and sketches.

    Raises InvalidValue when two references or two objects share a name, an object is held by or
    hangs on something that is not there, or a sighting does not tell what its kind of camera needs.
    """

    camera: Camera
    picture: str | None = None
    sightings: tuple[Sighting, ...] = ()
    references: tuple[Reference | PendingReference, ...] = ()
    objects: tuple[Primitive, ...] = ()
    sketches: tuple[Sketch, ...] = ()
    folder: Path = Path()
    mount: Mount | None = None
    composites: tuple[Composite, ...] = ()

    def __post_init__(self) -> None:
        check_names(self.references, self.things, self.composites)
        check_sightings(self.sightings, self.mount)

    @property
    def things(self) -> tuple[Primitive | Sketch, ...]:
        """Objects, then sketches: the order in which a document lists them."""
        return (*self.objects, *self.sketches)

    @property
    def placed_references(self) -> tuple[Reference, ...]:
        """The references that have a place."""
        return tuple(r for r in self.references if not isinstance(r, PendingReference))

    def in_use(self) -> Cell:
        """The cell with those of its sightings only that are not switched off."""
        return replace(self, sightings=tuple(s for s in self.sightings if s.use))

    def path_of(self, picture: str) -> Path:
        """The file of a picture named in the document."""
        return self.folder / picture

    def with_camera(self, camera: Camera) -> Cell:
        return replace(self, camera=camera)

    def with_mount(self, mount: Mount) -> Cell:
        """The cell with its camera on that mount, standing where it stood for `picture`."""
        return replace(self, mount=mount, camera=mount.placed(self.camera))

    def standing_camera(self) -> Camera:
        """The camera where it took `picture`. Raises NoPose with what is missing."""
        if self.camera.camera_from_world is None and self.mount is not None:
            missing = "camera_from_flange" if self.mount.camera_from_flange is None else ""
            raise NoPose(
                "the camera rides on the flange, and mount."
                f"{missing or 'world_from_flange'} is missing: "
                + ("calibrate it" if missing else "give the flange's pose of the cell's picture")
            )
        self.camera.pose  # noqa: B018  a camera without pose is refused here
        return self.camera

    def with_objects(self, objects: Iterable[Primitive]) -> Cell:
        return replace(self, objects=tuple(objects))

    def reference(self, name: str) -> Reference:
        """The reference of that name, or the face, edge or axis of a solved object (`crate.top`).

        Raises InvalidValue for a name that is not there, or has no place yet.
        """
        for reference in self.references:
            if reference.name == name:
                if isinstance(reference, PendingReference):
                    raise InvalidValue(
                        f"{name}: has no place yet: resolve the references, and model the objects "
                        "they are made from"
                    )
                return reference
        return reference_of_feature(self.things, name, self.camera)


def check_names(
    references: Sequence[Reference | PendingReference],
    things: Sequence[Primitive | Sketch],
    composites: Sequence[Composite] = (),
) -> None:
    """Raises InvalidValue for two of one name, and for a name that nothing is called by.

    Messages name the thing by its index, `objects[2].on`.
    """
    _refuse_twins("references", (reference.name for reference in references))
    _refuse_twins("objects", (thing.name for thing in things))
    known, named = {r.name for r in references}, {thing.name: thing for thing in things}
    for i, thing in enumerate(things):
        where = f"objects[{i}]"
        if thing.on is not None:
            _check_path(thing.on, f"{where}.on", thing.name, known, named)
        for j, relation in enumerate(thing.relations):
            _check_relation(relation, f"{where}.relations[{j}]", thing, known, named)
    rigid_bodies(things, composites)


def feature_owner(path: str, names: Container[str]) -> str | None:
    """The object that a feature path such as `crate.top` speaks of; None when there is none."""
    name, dot, feature = path.rpartition(".")
    return name if dot and feature and name in names else None


def _check_path(
    path: str, where: str, own: str, references: Collection[str], things: Named
) -> None:
    """Raises InvalidValue for what is no reference, and no feature of another object."""
    if path in references:
        return
    owner = feature_owner(path, things)
    if owner is None:
        listed = ", ".join(sorted(references)) or "none at all"
        if path in things:
            listed = f"an object of that name: say which of its features, such as {path}.top"
        told = f", and no object {path.rpartition('.')[0]!r}" if "." in path else ""
        raise InvalidValue(f"{where}: no reference is called {path!r}{told}; there is {listed}")
    if owner == own:
        raise InvalidValue(f"{where}: {path!r} is a feature of its own; name something else")
    _check_feature(things[owner], path.rpartition(".")[2], f"{where}: {path!r}")


def _check_relation(
    relation: Relation,
    where: str,
    own: Primitive | Sketch,
    references: Collection[str],
    things: Named,
) -> None:
    if RELATIONS[relation.kind] != "object":
        _check_path(relation.to, f"{where}.to", own.name, references, things)
    elif relation.to == own.name or relation.to not in things:
        told = "is the object itself" if relation.to == own.name else "is the name of no object"
        raise InvalidValue(f"{where}.to: {relation.to!r} {told}; name another object")
    if relation.about is not None:
        _check_path(relation.about, f"{where}.about", own.name, references, things)
    if relation.own is None:
        return
    sizes = KINDS[own.kind].size_names
    if relation.kind != "same_size":
        _check_feature(own, relation.own, f"{where}.own")
    elif relation.own not in sizes:
        raise InvalidValue(
            f"{where}.own: a {own.kind} has no size {relation.own!r}; it has {', '.join(sizes)}"
        )


def _check_feature(thing: Primitive | Sketch, name: str, where: str) -> None:
    # which features a sketch will have, a prism's sides above all, is not known yet
    if isinstance(thing, Primitive) and name not in feature_names(thing):
        raise InvalidValue(
            f"{where}: a {thing.kind} has no feature {name!r}; it has "
            f"{', '.join(feature_names(thing))}"
        )


def check_sightings(sightings: Sequence[Sighting], mount: Mount | None) -> None:
    """Raises InvalidValue for a sighting that tells too little, or the same thing twice."""
    for i, sighting in enumerate(sightings):
        where = f"sightings[{i}].world_from_flange"
        if mount is not None and sighting.world_from_flange is None:
            raise InvalidValue(f"{where}: is missing; the camera rides on the flange")
        told_twice = sighting.world_from_flange is not None and sighting.center_world is not None
        if mount is None and told_twice:
            raise InvalidValue(
                f"{where}: the camera is fixed, and center tells the place already; give one of "
                "the two, or the camera's mount"
            )


def _refuse_twins(field: str, names: Iterable[str]) -> None:
    seen: dict[str, int] = {}
    for i, name in enumerate(names):
        if name in seen:
            raise InvalidValue(f"{field}[{i}].name: {name!r} is also {field}[{seen[name]}]'s name")
        seen[name] = i
