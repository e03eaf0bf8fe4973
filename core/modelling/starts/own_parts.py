# SPDX-License-Identifier: GPL-3.0-or-later
"""A kind and the name of one of its features in, the material points and direction of it out.

The points are linear in the parameters (`core.shape.anchors`), so that they are evaluated for any
number of guesses at once.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ...shape.anchors import anchor_names, anchors

BOX_FACES = {"x-": (0, -1.0), "x+": (0, 1.0), "y-": (1, -1.0), "y+": (1, 1.0)}
AXES = {"axis_x": 0, "axis_y": 1, "axis": 2}


@dataclass(frozen=True, eq=False)
class OwnPart:
    """A `plane`, `line` or `point`: the middle `by` (3, P) parameters, points that span it, normal.

    `spans` (K, 3, P) lie on it. `direction` (3,) is a face's outward normal or a line's direction
    in the object's frame; None for a point, and for a prism's side, whose normal is its polygon's.
    """

    sort: str
    by: Array
    spans: Array
    direction: Array | None


def own_part(kind: str, parameters: int, name: str) -> OwnPart:
    """The feature of that name of a solid with so many parameters, as `core.shape.features`.

    Raises KeyError for a name that is not there; the exact fit refuses it in words.
    """
    by = np.zeros((3, parameters))
    if name == "centre":
        return OwnPart("point", by, by[None], None)
    if name in AXES:
        direction = np.eye(3)[AXES[name]]
        return OwnPart("line", by, by[None], direction)
    if name in ("base", "top"):
        by = _by(kind, parameters, [f"{name} centre"])[0]
        direction = np.array([0.0, 0.0, 1.0 if name == "top" else -1.0])
        spans = _by(kind, parameters, _corners(kind, parameters, name)) if _flat(kind) else by[None]
        return OwnPart("plane", by, spans, direction)
    if kind == "prism":
        return _prism_part(parameters, name)
    return _box_part(parameters, name)


def _flat(kind: str) -> bool:
    return kind in ("box", "prism")


def _by(kind: str, parameters: int, names: list[str]) -> Array:
    return anchors(kind, np.zeros(parameters), names)[1]


def _corners(kind: str, parameters: int, face: str) -> list[str]:
    names = [n for n in anchor_names(kind, parameters) if not n.endswith("centre")]
    return [n for n in names if face in n]


def _box_part(parameters: int, name: str) -> OwnPart:
    faces = re.findall(r"[xy][+-]|base|top", name)
    if "".join(faces) != name or not 1 <= len(faces) <= 2:
        raise KeyError(name)
    by = np.zeros((3, parameters))
    used = []
    for face in faces:
        axis, sign = BOX_FACES.get(face, (2, 1.0 if face == "top" else -1.0))
        by[axis, axis] = sign / 2
        used.append((axis, sign))
    corners = [n for n in _corners("box", parameters, "") if all(face in n for face in faces)]
    spans = _by("box", parameters, corners)
    if len(used) == 1:
        axis, sign = used[0]
        return OwnPart("plane", by, spans, sign * np.eye(3)[axis])
    return OwnPart("line", by, spans, np.eye(3)[3 - used[0][0] - used[1][0]])


def _prism_part(parameters: int, name: str) -> OwnPart:
    found = re.fullmatch(r"(side|edge)(\d+)", name)
    count = (parameters - 1) // 2
    if found is None or int(found[2]) >= count:
        raise KeyError(name)
    i = int(found[2])
    corners = [i] if found[1] == "edge" else [i, (i + 1) % count]
    spans = _by("prism", parameters, [f"{end}{c}" for c in corners for end in ("base", "top")])
    direction = np.array([0.0, 0.0, 1.0]) if found[1] == "edge" else None
    sort = "line" if found[1] == "edge" else "plane"
    return OwnPart(sort, spans.mean(axis=0), spans, direction)
