# SPDX-License-Identifier: GPL-3.0-or-later
"""The entries of a cell document: nouns to JSON values and back, strictly read."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

from ..arrays import Array, positive
from ..camera import Camera
from ..distortion import Distortion
from ..errors import DocumentError, InvalidValue
from ..intrinsics import Intrinsics
from ..pose import Pose
from ..primitives import KINDS, Box, Cylinder, Picks, Primitive
from ..sketch import Sketch
from .appearance_entries import appearance_entry, appearance_from_fields, check_faces
from .fields import Fields, items, keyed, number, shown, vector

Entry = dict[str, Any]
INTRINSICS = ("width", "height", "fx", "fy", "cx", "cy")


@contextmanager
def named(where: str) -> Iterator[None]:
    """What a noun refuses is refused by the document, with the path in front."""
    try:
        yield
    except InvalidValue as error:
        told = str(error)
        raise DocumentError(told if told.startswith(where) else f"{where}: {told}") from None


def pose_entry(pose: Pose) -> Entry:
    """A pose as rotation rows and a translation in metres."""
    return {"rotation": pose.rotation.tolist(), "translation": pose.translation.tolist()}


def pose_from_entry(entry: Any, where: str) -> Pose:
    """Raises DocumentError with the path of the field, as all readers here."""
    fields = keyed(entry, where, ("rotation", "translation"), ())
    with named(where):
        return Pose(fields.matrix("rotation", 3, 3), fields.vector("translation", 3))


def camera_entry(camera: Camera) -> Entry:
    """Intrinsics, distortion, and, where known, pose and covariance."""
    entry: Entry = {name: getattr(camera.intrinsics, name) for name in INTRINSICS}
    distortion = camera.intrinsics.distortion
    entry["distortion"] = {
        "model": distortion.model,
        "coefficients": distortion.coefficients.tolist(),
    }
    if camera.camera_from_world is not None:
        entry["camera_from_world"] = pose_entry(camera.camera_from_world)
    if camera.covariance is not None:
        entry["covariance"] = camera.covariance.tolist()
    return entry


def camera_from_entry(entry: Any, where: str = "camera") -> Camera:
    """The camera of a document, of a camera file of our own, or of a glTF's extras."""
    fields = keyed(entry, where, INTRINSICS, ("distortion", "camera_from_world", "covariance"))
    pose = fields.raw("camera_from_world")
    with named(where):
        return Camera(
            Intrinsics(
                fields.whole("width"),
                fields.whole("height"),
                fields.number("fx"),
                fields.number("fy"),
                fields.number("cx"),
                fields.number("cy"),
                _distortion(fields),
            ),
            None if pose is None else pose_from_entry(pose, fields.path("camera_from_world")),
            _covariance(fields, 6),
        )


def object_entry(thing: Primitive | Sketch, *, with_picks: bool = True) -> Entry:
    """An object, solved or only picked; without picks as it travels in a glTF's extras."""
    entry: Entry = {"name": thing.name, "kind": thing.kind}
    if thing.on is not None:
        entry["on"] = thing.on
    if isinstance(thing, Primitive):
        entry |= _sizes_entry(thing)
        entry["world_from_object"] = pose_entry(thing.world_from_object)
        if thing.covariance is not None:
            entry["covariance"] = thing.covariance.tolist()
    if thing.known:
        entry["known"] = dict(thing.known)
    # a sketch is nothing without its picks, even while there are none yet
    if with_picks and (thing.picks or isinstance(thing, Sketch)):
        entry["picks"] = {role: _plain(pixels) for role, pixels in thing.picks.items()}
    if thing.appearance is not None:
        entry["appearance"] = appearance_entry(thing.appearance)
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
    common = ("on", "picks", "known", "appearance")
    kind = entry.get("kind") if isinstance(entry, dict) else None
    if isinstance(entry, dict) and not (isinstance(kind, str) and kind in KINDS):
        got = f"{shown(kind)} is none of {', '.join(KINDS)}" if "kind" in entry else "is missing"
        raise DocumentError(f"{where}.kind: {got}")
    sizes = ("size",) if kind == "box" else ("radius", "height")
    if isinstance(entry, dict) and "world_from_object" not in entry:
        required: tuple[str, ...] = ("name", "kind", "on", "picks")
        fields = keyed(entry, where, required, ("known", "appearance"))
        with named(where):
            return Sketch(
                fields.text("name"),
                fields.text("kind"),
                fields.text("on"),
                _picks(fields),
                _known(fields),
                appearance_from_fields(fields),
            )
    required = ("name", "kind", "world_from_object", *sizes)
    thing = _solved(keyed(entry, where, required, (*common, "covariance")))
    check_faces(thing, where)
    return thing


def _solved(fields: Fields) -> Primitive:
    kind = KINDS[fields.text("kind")]
    with named(fields.where):
        shared: dict[str, Any] = {
            "name": fields.text("name"),
            "world_from_object": pose_from_entry(
                fields.raw("world_from_object"), fields.path("world_from_object")
            ),
            "on": fields.text("on") if fields.has("on") else None,
            "picks": _picks(fields),
            "known": _known(fields),
            "appearance": appearance_from_fields(fields),
            "covariance": _covariance(fields, 6 + len(kind.size_names)),
        }
        if kind is Box:
            return Box(**shared, size=fields.vector("size", 3))
        return Cylinder(**shared, radius=fields.number("radius"), height=fields.number("height"))


def _sizes_entry(thing: Primitive) -> Entry:
    if isinstance(thing, Box):
        return {"size": thing.size.tolist()}
    return dict(zip(thing.size_names, thing.sizes.tolist(), strict=True))


def _distortion(fields: Fields) -> Distortion:
    if not fields.has("distortion"):
        return Distortion()
    where = fields.path("distortion")
    inner = keyed(fields.raw("distortion"), where, ("model",), ("coefficients",))
    listed = inner.items("coefficients")
    values = [number(v, f"{where}.coefficients[{i}]") for i, v in enumerate(listed)]
    with named(fields.where):
        return Distortion(inner.text("model"), np.array(values))


def _covariance(fields: Fields, size: int) -> Array | None:
    return fields.matrix("covariance", size, size) if fields.has("covariance") else None


def _known(fields: Fields) -> dict[str, float]:
    if not fields.has("known"):
        return {}
    kind = KINDS[fields.text("kind")]
    known = keyed(fields.raw("known"), fields.path("known"), (), kind.size_names)
    return {
        name: positive(known.number(name), known.path(name))
        for name in kind.size_names
        if known.has(name)
    }


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
