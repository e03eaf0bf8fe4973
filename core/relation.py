# SPDX-License-Identifier: GPL-3.0-or-later
"""A relation between an object and something else that is kept when either is edited."""

from __future__ import annotations

from dataclasses import dataclass

from .errors import InvalidValue

# kind to what `to` has to name
RELATIONS = {
    "stands_on": "plane",
    "lies_on": "plane",
    "leans_on": "plane",
    "touches": "plane or line",
    "parallel": "direction",
    "perpendicular": "direction",
    "centred_on": "line",
    "same_size": "object",
    "symmetric": "object",
}


@dataclass(frozen=True)
class Relation:
    """How one object is held by another, or by a reference.

    `to` names a reference of the cell (`table`), a feature of an object (`crate.top`, `drum.axis`),
    or for `same_size` and `symmetric` an object. `own` names the feature of this object that is
    meant, where the kind leaves a choice. `about` is the plane of a symmetry.

    | kind | says |
    |---|---|
    | stands_on | its base (or the face `own`) lies flush on the plane, its axis along the normal |
    | lies_on | its axis is parallel to the plane, and it touches the plane |
    | leans_on | its face `own` lies flush against the plane; without `own` it touches the plane |
    | touches | it touches the plane or line (or its feature `own` lies on it) |
    | parallel | its axis (or `own`) is parallel to the direction of a line, or a plane's normal |
    | perpendicular | its axis (or `own`) is at a right angle to that direction |
    | centred_on | its origin (or `own`) lies on the line, or the normal through a face's middle |
    | same_size | all its sizes (or the one named by `own`) are the other's |
    | symmetric | it is the other's mirror image in the plane `about` |
    """

    kind: str
    to: str
    own: str | None = None
    about: str | None = None

    def __post_init__(self) -> None:
        if self.kind not in RELATIONS:
            raise InvalidValue(f"relation {self.kind!r} is none of {', '.join(RELATIONS)}")
        if not self.to:
            raise InvalidValue(f"relation {self.kind}: `to` names nothing")
        if (self.kind == "symmetric") != (self.about is not None):
            raise InvalidValue(
                f"relation {self.kind}: `about` names the plane of a symmetry, and of nothing else"
            )
