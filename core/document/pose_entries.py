# SPDX-License-Identifier: GPL-3.0-or-later
"""What the entries of a document share: poses, and what nouns refuse told with a field's path."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from ..errors import DocumentError, InvalidValue
from ..pose import Pose
from .fields import keyed

Entry = dict[str, Any]


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
