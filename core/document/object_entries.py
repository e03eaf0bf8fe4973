# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects, solved or only picked: nouns to JSON values and back, strictly read."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import Array, positive
from ..errors import DocumentError
from ..primitives import KINDS, Box, Picks, Primitive, Prism
from ..sketch import Sketch
from .appearance_entries import appearance_entry, appearance_from_fields, check_faces
from .fields import Fields, items, keyed, shown, vector
from .motion_entries import motion_entry, optional_motion, relation_entry, relation_from_entry
from .pose_entries import Entry, named, pose_entry, pose_from_entry

# what every object may have; a solved one may have a covariance, too
COMMON = ("on", "relations", "known", "picks", "appearance", "motion")
ERROR = ("covariance", "by_camera")


def object_entry(thing: Primitive | Sketch, *, with_picks: bool = True) -> Entry:
    """An object, solved or only picked; without picks as it travels in a glTF's extras."""
    entry: Entry = {"name": thing.name, "kind": thing.kind}
    if thing.on is not None:
        entry["on"] = thing.on
    if thing.relations:
        entry["relations"] = [relation_entry(relation) for relation in thing.relations]
    if isinstance(thing, Primitive):
        entry |= _shape_entry(thing)
        entry["world_from_object"] = pose_entry(thing.world_from_object)
        if thing.covariance is not None:
            entry["covariance"] = thing.covariance.tolist()
        if thing.by_camera is not None:
            entry["by_camera"] = thing.by_camera.tolist()
    if thing.known:
        entry["known"] = dict(thing.known)
    # a sketch is nothing without its picks, even while there are none yet
    if with_picks and (thing.picks or isinstance(thing, Sketch)):
        entry["picks"] = {role: _plain(pixels) for role, pixels in thing.picks.items()}
    if thing.appearance is not None:
        entry["appearance"] = appearance_entry(thing.appearance)
    if thing.motion.kind != "static":
        entry["motion"] = motion_entry(thing.motion)
    return entry


def object_from_entry(entry: Any, where: str = "object") -> Primitive:
    """A solved object; raises DocumentError for one that has only picks."""
    thing = thing_from_entry(entry, where)
    if isinstance(thing, Sketch):
        raise DocumentError(
            f"{where}.world_from_object: is missing, so the object has no place yet"
        )
    return thing


def thing_from_entry(entry: Any, where: str) -> Primitive | Sketch:
    """An object, or a sketch where `world_from_object` is absent."""
    kind = entry.get("kind") if isinstance(entry, dict) else None
    if isinstance(entry, dict) and not (isinstance(kind, str) and kind in KINDS):
        got = f"{shown(kind)} is none of {', '.join(KINDS)}" if "kind" in entry else "is missing"
        raise DocumentError(f"{where}.kind: {got}")
    if isinstance(entry, dict) and "world_from_object" not in entry:
        return _sketched(keyed(entry, where, ("name", "kind", "picks"), COMMON))
    required = ("name", "kind", "world_from_object", *_shape_keys(str(kind)))
    thing = _solved(keyed(entry, where, required, (*COMMON, *ERROR)))
    check_faces(thing, where)
    return thing


def _sketched(fields: Fields) -> Sketch:
    with named(fields.where):
        return Sketch(kind=fields.text("kind"), **_common(fields))


def _solved(fields: Fields) -> Primitive:
    kind = KINDS[fields.text("kind")]
    pose = pose_from_entry(fields.raw("world_from_object"), fields.path("world_from_object"))
    shape = _shape(fields, kind)
    rows = 6 + len(kind.size_names) + (shape["polygon"].size if "polygon" in shape else 0)
    with named(fields.where):
        return kind(
            world_from_object=pose,
            covariance=_matrix(fields, "covariance", rows, rows),
            by_camera=_matrix(fields, "by_camera", rows, 6),
            **_common(fields),
            **shape,
        )


def _common(fields: Fields) -> dict[str, Any]:
    """What a solved object and a sketch share, by the names of their fields."""
    relations = fields.items("relations")
    where = fields.path("relations")
    return {
        "name": fields.text("name"),
        "on": fields.text("on") if fields.has("on") else None,
        "picks": _picks(fields),
        "known": _known(fields),
        "appearance": appearance_from_fields(fields),
        "relations": tuple(
            relation_from_entry(entry, f"{where}[{i}]") for i, entry in enumerate(relations)
        ),
        "motion": optional_motion(fields),
    }


def _shape_keys(kind: str) -> tuple[str, ...]:
    """The keys that hold a kind's sizes; a box has its three in one, a prism its polygon too."""
    if kind not in KINDS:
        return ()
    if KINDS[kind] is Box:
        return ("size",)
    names = KINDS[kind].size_names
    return ("polygon", *names) if KINDS[kind] is Prism else names


def _shape_entry(thing: Primitive) -> Entry:
    if isinstance(thing, Box):
        return {"size": thing.size.tolist()}
    entry: Entry = dict(zip(thing.size_names, thing.sizes.tolist(), strict=True))
    if isinstance(thing, Prism):
        entry = {"polygon": thing.polygon.tolist()} | entry
    return entry


def _shape(fields: Fields, kind: type[Primitive]) -> dict[str, Any]:
    if kind is Box:
        return {"size": fields.vector("size", 3)}
    shape: dict[str, Any] = {name: fields.number(name) for name in kind.size_names}
    if kind is Prism:
        where, corners = fields.path("polygon"), fields.items("polygon")
        rows = [vector(corner, f"{where}[{i}]", 2) for i, corner in enumerate(corners)]
        if len(rows) < 3:
            raise DocumentError(f"{where}: expected 3 corners or more, got {len(rows)}")
        shape["polygon"] = np.array(rows)
    return shape


def _matrix(fields: Fields, key: str, rows: int, columns: int) -> Array | None:
    return fields.matrix(key, rows, columns) if fields.has(key) else None


def _known(fields: Fields) -> dict[str, float]:
    if not fields.has("known"):
        return {}
    kind = KINDS[fields.text("kind")]
    known = keyed(fields.raw("known"), fields.path("known"), (), kind.size_names)
    return {
        name: _known_size(kind.kind, name, known) for name in kind.size_names if known.has(name)
    }


def _known_size(kind: str, name: str, known: Fields) -> float:
    value = known.number(name)
    # a cone that is known to end in a point
    return (
        value
        if (kind, name, value) == ("cone", "top_radius", 0)
        else positive(value, known.path(name))
    )


def _picks(fields: Fields) -> Picks:
    """A role to a list of pixels; null stands for a corner that is not seen."""
    if not fields.has("picks"):
        return {}
    where, value = fields.path("picks"), fields.raw("picks")
    if not isinstance(value, dict):
        raise DocumentError(f"{where}: expected an object {{...}}, got {shown(value)}")
    return {role: _pixels(listed, f"{where}.{role}") for role, listed in value.items()}


def _pixels(value: Any, where: str) -> list[list[float] | None]:
    listed = items(value, where)
    return [
        None if pixel is None else vector(pixel, f"{where}[{i}]", 2).tolist()
        for i, pixel in enumerate(listed)
    ]


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return value.tolist()
    return [_plain(v) for v in value] if isinstance(value, list | tuple) else value
