# SPDX-License-Identifier: GPL-3.0-or-later
"""Looks onto disk: face pictures become PNG files beside the document, and the cell names them."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import cv2

from ..appearance import Appearance, Texture
from ..atomic import atomic_path
from ..cell import Cell
from ..errors import PictureError
from ..primitives import Primitive
from .looks import Look
from .textures import FacePicture


def with_looks(cell: Cell, looks: Iterable[Look], document: str | Path) -> Cell:
    """The cell with its objects looking so; textures are written beside `document`, whole.

    A texture is called `table.crate.top.png` for the face `top` of `crate` in `table.cell.json`.
    An object of which nothing is seen keeps what it has. Raises DocumentError when a file can't be
    written.
    """
    file = Path(document)
    looks = list(looks)
    names = _file_names(file, looks)
    dressed = {}
    for look in looks:
        pictures = {face.face: names[look.thing.name, face.face] for face in look.faces}
        for face in look.faces:
            _write_png(face, file.parent / pictures[face.face])
        relative = {face: _seen_from(cell, file.parent / name) for face, name in pictures.items()}
        dressed[look.thing.name] = _dressed(look, relative)
    return cell.with_objects(dressed.get(thing.name, thing) for thing in cell.objects)


def _dressed(look: Look, pictures: dict[str, str]) -> Primitive:
    old, color = look.thing.appearance, look.color.color
    if color is None:
        return look.thing
    textures = {face.face: Texture(pictures[face.face], face.seen) for face in look.faces}
    if old is not None and not (look.faces or look.unseen):
        # no texture was asked for: what was there may stay
        textures = dict(old.textures)
    return replace(look.thing, appearance=Appearance(color, textures))


def _seen_from(cell: Cell, picture: Path) -> str:
    """A cell names its files from its own folder, whichever document it is written to next."""
    return Path(os.path.relpath(picture.resolve(), cell.folder.resolve())).as_posix()


def _file_names(document: Path, looks: list[Look]) -> dict[tuple[str, str], str]:
    """A name for each face that a file system takes, no two alike."""
    stem = document.name.removesuffix(".json").removesuffix(".cell")
    names: dict[tuple[str, str], str] = {}
    for look in looks:
        for face in look.faces:
            plain = re.sub(r"[^\w+-]", "_", f"{look.thing.name}")
            name = f"{stem}.{plain}.{face.face}.png"
            count = 2
            # a file system may not tell upper from lower case
            while name.lower() in (other.lower() for other in names.values()):
                name = f"{stem}.{plain}~{count}.{face.face}.png"
                count += 1
            names[look.thing.name, face.face] = name
    return names


def _write_png(face: FacePicture, path: Path) -> None:
    done, data = cv2.imencode(".png", face.pixels)
    if not done:
        raise PictureError(f"{path}: the texture could not be encoded")
    with atomic_path(path) as temporary:
        temporary.write_bytes(data.tobytes())
