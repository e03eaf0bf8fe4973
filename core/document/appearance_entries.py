# SPDX-License-Identifier: GPL-3.0-or-later
"""The appearance of an object in a cell document: colour and textures to JSON values and back."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..appearance import Appearance, Texture
from ..errors import DocumentError, InvalidValue
from ..primitive import Primitive
from ..shape.intervals import face_names
from .fields import Fields, keyed


def appearance_entry(appearance: Appearance) -> dict[str, Any]:
    """`{"color": [r, g, b]}`, and `textures` by face where there are any."""
    entry: dict[str, Any] = {"color": appearance.color.tolist()}
    if appearance.textures:
        entry["textures"] = {
            face: {"picture": texture.picture, "seen": texture.seen}
            for face, texture in appearance.textures.items()
        }
    return entry


def appearance_from_fields(fields: Fields) -> Appearance | None:
    """The `appearance` of an object's entry; raises DocumentError with the path of the field."""
    if not fields.has("appearance"):
        return None
    where = fields.path("appearance")
    inner = keyed(fields.raw("appearance"), where, ("color",), ("textures",))
    try:
        return Appearance(inner.vector("color", 3), _textures(inner))
    except InvalidValue as error:
        raise DocumentError(f"{where}: {error}") from None


def check_faces(thing: Primitive, where: str) -> None:
    """Raises DocumentError for a texture of a face that the object has not."""
    for face in thing.appearance.textures if thing.appearance else ():
        if face not in face_names(thing):
            raise DocumentError(
                f"{where}.appearance.textures.{face}: {thing.name} has no such face; it has "
                f"{', '.join(face_names(thing))}"
            )


def with_pictures_moved(entry: dict[str, Any], moved: Callable[[str], str]) -> dict[str, Any]:
    """An object's entry whose textures are named as `moved` names them."""
    look = entry.get("appearance", {})
    if "textures" not in look:
        return entry
    textures = {
        face: texture | {"picture": moved(texture["picture"])}
        for face, texture in look["textures"].items()
    }
    return entry | {"appearance": look | {"textures": textures}}


def _textures(inner: Fields) -> dict[str, Texture]:
    if not inner.has("textures"):
        return {}
    where, value = inner.path("textures"), inner.raw("textures")
    # any face may be named here: which there are depends on the object
    faces = keyed(value, where, (), tuple(value) if isinstance(value, dict) else ())
    return {face: _texture(faces.raw(face), faces.path(face)) for face in value}


def _texture(value: Any, where: str) -> Texture:
    fields = keyed(value, where, ("picture",), ("seen",))
    seen = fields.number("seen") if fields.has("seen") else 1.0
    return Texture(fields.text("picture"), seen)
