# SPDX-License-Identifier: GPL-3.0-or-later
"""What holds objects and how they move: relations, motions, composites to JSON values and back."""

from __future__ import annotations

from typing import Any

from ..composite import Composite
from ..errors import DocumentError, InvalidValue
from ..motion import JOINTS, MOTIONS, Motion
from ..relation import RELATIONS, Relation
from .fields import Fields, keyed, text
from .pose_entries import Entry, named


def relation_entry(relation: Relation) -> Entry:
    """A relation; what it leaves out is absent."""
    entry: Entry = {"kind": relation.kind, "to": relation.to}
    if relation.own is not None:
        entry["own"] = relation.own
    if relation.about is not None:
        entry["about"] = relation.about
    return entry


def relation_from_entry(entry: Any, where: str) -> Relation:
    """Raises DocumentError with the path of the field, as all readers here."""
    fields = keyed(entry, where, ("kind", "to"), ("own", "about"))
    kind = _one_of(fields, "kind", tuple(RELATIONS))
    with named(where):
        return Relation(kind, fields.text("to"), _text(fields, "own"), _text(fields, "about"))


def motion_entry(motion: Motion) -> Entry:
    """A motion; what it leaves out is absent."""
    entry: Entry = {"kind": motion.kind}
    for key in ("mass", "density", "to", "joint"):
        if getattr(motion, key) is not None:
            entry[key] = getattr(motion, key)
    for key in ("axis", "point"):
        if getattr(motion, key) is not None:
            entry[key] = getattr(motion, key).tolist()
    if motion.limits is not None:
        entry["limits"] = list(motion.limits)
    return entry


def motion_from_entry(entry: Any, where: str) -> Motion:
    """The inverse of `motion_entry`."""
    optional = ("mass", "density", "to", "joint", "axis", "point", "limits")
    fields = keyed(entry, where, ("kind",), optional)
    kind = _one_of(fields, "kind", MOTIONS)
    joint = _one_of(fields, "joint", JOINTS) if fields.has("joint") else None
    limits = fields.vector("limits", 2) if fields.has("limits") else None
    values: dict[str, Any] = {
        "mass": fields.number("mass") if fields.has("mass") else None,
        "density": fields.number("density") if fields.has("density") else None,
        "axis": fields.vector("axis", 3) if fields.has("axis") else None,
        "point": fields.vector("point", 3) if fields.has("point") else None,
        "limits": None if limits is None else (float(limits[0]), float(limits[1])),
    }
    try:
        return Motion(kind, to=_text(fields, "to"), joint=joint, **values)
    except InvalidValue as error:
        # the noun calls its fields motion.mass, motion.axis, ...: here they have a longer path
        told = str(error).removeprefix("motion")
        raise DocumentError(f"{where}{told if told[:1] in '.:' else ':' + told}") from None


def composite_entry(composite: Composite) -> Entry:
    """A group of objects."""
    entry: Entry = {"name": composite.name, "parts": list(composite.parts)}
    if composite.motion.kind != "static":
        entry["motion"] = motion_entry(composite.motion)
    return entry


def composite_from_entry(entry: Any, where: str) -> Composite:
    """The inverse of `composite_entry`."""
    fields = keyed(entry, where, ("name", "parts"), ("motion",))
    parts = fields.items("parts")
    with named(where):
        return Composite(
            fields.text("name"),
            tuple(text(part, f"{where}.parts[{i}]") for i, part in enumerate(parts)),
            optional_motion(fields),
        )


def optional_motion(fields: Fields) -> Motion:
    """The motion of an object or composite, static where it says none."""
    if not fields.has("motion"):
        return Motion()
    return motion_from_entry(fields.raw("motion"), fields.path("motion"))


def _text(fields: Fields, key: str) -> str | None:
    return fields.text(key) if fields.has(key) else None


def _one_of(fields: Fields, key: str, known: tuple[str, ...]) -> str:
    value = fields.text(key)
    if value not in known:
        raise DocumentError(f"{fields.path(key)}: {value!r} is none of {', '.join(known)}")
    return value
