# SPDX-License-Identifier: GPL-3.0-or-later
"""Reference planes and lines, and where they come from: nouns to JSON values and back."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from ..arrays import Array
from ..errors import DocumentError
from ..reference import PendingReference, Reference, ReferenceLine, ReferencePlane, kind_of
from ..references.sources import (
    WAYS,
    AlongDirection,
    FacingCamera,
    FeatureOf,
    Intersection,
    Parallel,
    PickedPoints,
    Source,
    Stated,
    ThroughPoints,
    Upright,
)
from .fields import Fields, items, keyed, number, shown, text, vector
from .pose_entries import Entry, named

# the key that holds a direction, and all keys of the place
DIRECTION = {"plane": "normal", "line": "direction"}
ERROR = ("covariance", "by_camera")
# keys that a source must have, and those it may have
KEYS: Mapping[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "stated": ((), ("sigma", "tilt_sigma")),
    "points": (("points",), ("sigma",)),
    "picks": (("pixels", "heights", "above"), ()),
    "feature": (("of",), ()),
    "facing_camera": (("axis",), ()),
    "upright": (("pixels", "on"), ()),
    "parallel": (("to", "distance"), ("sigma",)),
    "intersection": (("planes",), ()),
    "direction": (("through", "along"), ("sigma", "tilt_sigma")),
}


def reference_entry(reference: Reference | PendingReference) -> Entry:
    """A known plane or line of the world: where it comes from, its place, and its error."""
    entry: Entry = {"name": reference.name, "kind": kind_of(reference)}
    if reference.source is not None:
        entry["from"] = _source_entry(reference.source)
    if isinstance(reference, PendingReference):
        return entry
    way = reference.normal if isinstance(reference, ReferencePlane) else reference.direction
    entry |= {"point": reference.point.tolist(), DIRECTION[entry["kind"]]: way.tolist()}
    return entry | {
        key: matrix.tolist() for key in ERROR if (matrix := getattr(reference, key)) is not None
    }


def reference_from_entry(entry: Any, where: str) -> Reference | PendingReference:
    """The inverse of `reference_entry`; pending where there is a source and no place yet."""
    ways = tuple(DIRECTION.values())
    fields = keyed(entry, where, ("name", "kind"), ("from", "point", *ways, *ERROR))
    kind = fields.text("kind")
    if kind not in DIRECTION:
        raise DocumentError(f"{fields.path('kind')}: {kind!r} is neither plane nor line")
    place, optional = ("point", DIRECTION[kind]), ("from", *ERROR)
    source = _source(fields.raw("from"), fields.path("from")) if fields.has("from") else None
    placed = any(fields.has(key) for key in place)
    if not (placed or source is None or isinstance(source, Stated)):
        # what has no place has no error either
        keyed(entry, where, ("name", "kind", "from"), place)
        with named(where):
            return PendingReference(fields.text("name"), kind, source)
    keyed(entry, where, ("name", "kind", *place), optional)
    noun = ReferencePlane if kind == "plane" else ReferenceLine
    with named(where):
        return noun(
            fields.text("name"),
            fields.vector("point", 3),
            fields.vector(DIRECTION[kind], 3),
            covariance=_matrix(fields, "covariance"),
            by_camera=_matrix(fields, "by_camera"),
            source=source,
        )


def _source_entry(source: Source) -> Entry:
    required, optional = KEYS[source.way]
    entry: Entry = {"way": source.way}
    for key in (*required, *optional):
        value = getattr(source, key)
        # an error of nothing and an unknown one are what their absence means
        if key in required or not (value is None or (isinstance(value, float) and value == 0)):
            entry[key] = _plain(value)
    return entry


def _source(entry: Any, where: str) -> Source:
    way = entry.get("way") if isinstance(entry, Mapping) else None
    if isinstance(entry, Mapping) and not (isinstance(way, str) and way in WAYS):
        got = f"{shown(way)} is none of {', '.join(WAYS)}" if "way" in entry else "is missing"
        raise DocumentError(f"{where}.way: {got}")
    required, optional = KEYS[way] if isinstance(way, str) else ((), ())
    fields = keyed(entry, where, ("way", *required), optional)
    with named(where):
        return _READERS[fields.text("way")](fields)


def _stated(fields: Fields) -> Source:
    return Stated(_number(fields, "sigma"), _number(fields, "tilt_sigma"))


def _points(fields: Fields) -> Source:
    sigma = _numbers(fields, "sigma") if fields.has("sigma") else None
    return ThroughPoints(_rows(fields, "points", 3), sigma)


def _picks(fields: Fields) -> Source:
    pixels, heights = _rows(fields, "pixels", 2), _numbers(fields, "heights")
    return PickedPoints(pixels, heights, fields.text("above"))


def _upright(fields: Fields) -> Source:
    return Upright(_rows(fields, "pixels", 2), fields.text("on"))


def _parallel(fields: Fields) -> Source:
    return Parallel(fields.text("to"), fields.number("distance"), _number(fields, "sigma"))


def _intersection(fields: Fields) -> Source:
    where, listed = fields.path("planes"), fields.items("planes")
    if len(listed) != 2:
        raise DocumentError(f"{where}: expected two names of planes, got {len(listed)}")
    return Intersection((text(listed[0], f"{where}[0]"), text(listed[1], f"{where}[1]")))


def _direction(fields: Fields) -> Source:
    through, along = _vector_or_name(fields, "through"), _vector_or_name(fields, "along")
    return AlongDirection(through, along, _number(fields, "sigma"), _number(fields, "tilt_sigma"))


_READERS: Mapping[str, Callable[[Fields], Source]] = {
    "stated": _stated,
    "points": _points,
    "picks": _picks,
    "feature": lambda fields: FeatureOf(fields.text("of")),
    "facing_camera": lambda fields: FacingCamera(fields.text("axis")),
    "upright": _upright,
    "parallel": _parallel,
    "intersection": _intersection,
    "direction": _direction,
}


def _matrix(fields: Fields, key: str) -> Array | None:
    return fields.matrix(key, 6, 6) if fields.has(key) else None


def _number(fields: Fields, key: str) -> float:
    return fields.number(key) if fields.has(key) else 0.0


def _numbers(fields: Fields, key: str) -> Array:
    """One number for all, or a list of one for each."""
    value, where = fields.raw(key), fields.path(key)
    if not isinstance(value, list | tuple):
        return np.array(number(value, where))
    return np.array([number(v, f"{where}[{i}]") for i, v in enumerate(value)])


def _rows(fields: Fields, key: str, columns: int) -> Array:
    where = fields.path(key)
    listed = items(fields.raw(key), where)
    rows = [vector(row, f"{where}[{i}]", columns) for i, row in enumerate(listed)]
    return np.array(rows).reshape(-1, columns)


def _vector_or_name(fields: Fields, key: str) -> Array | str:
    return fields.text(key) if isinstance(fields.raw(key), str) else fields.vector(key, 3)


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return value.tolist()
    return list(value) if isinstance(value, tuple) else value
