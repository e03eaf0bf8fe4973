# SPDX-License-Identifier: GPL-3.0-or-later
"""An exported glTF in, the cell that its extras hold out: camera, references, exact objects."""

from __future__ import annotations

import json
import struct
from dataclasses import replace
from pathlib import Path
from typing import Any

from ...core.appearance import Appearance
from ...core.cell import Cell
from ...core.document.entries import camera_from_entry, composite_from_entry, object_from_entry
from ...core.document.reference_entries import reference_from_entry
from ...core.errors import DocumentError
from ...core.links import references_kept, without_lost_joints, without_lost_relations
from ...core.primitives import Primitive

KEY = "monocell"
# glTF 2.0, section 4: a header of 12 bytes, then chunks of length, type and padded data
HEADER = struct.Struct("<4sII")
CHUNK = struct.Struct("<II")
JSON_CHUNK = 0x4E4F534A


def read_glb_cell(path: str | Path) -> tuple[Cell, tuple[str, ...]]:
    """The cell of a `.glb` that monocell exported, and what was lost of it on the way.

    It has no picture, no sightings and no picks: a glTF carries none. Textures are taken where
    their files still lie beside it. Raises DocumentError for another file, naming what is wrong.
    """
    file = Path(path)
    document = _document(file)
    extras = _scene_extras(document, file)
    objects, composites = [], []
    for i, node in enumerate(document.get("nodes", [])):
        entry, where = _extras(node).get(KEY), f"{file}: nodes[{i}].extras.{KEY}"
        kind = entry.get("kind") if isinstance(entry, dict) else None
        if kind == "composite":
            bare = {key: value for key, value in entry.items() if key != "kind"}
            composites.append(composite_from_entry(bare, where))
        elif entry is not None and kind != "camera":
            objects.append(object_from_entry(entry, where))
    references = [
        reference_from_entry(entry, f"{file}: scene.extras.{KEY}.references[{i}]")
        for i, entry in enumerate(extras.get("references", ()))
    ]
    camera = camera_from_entry(extras["camera"], f"{file}: scene.extras.{KEY}.camera")
    things, groups, hung = without_lost_joints(objects, composites)
    things, held = without_lost_relations(things, {r.name for r in references})
    kept = references_kept(references, {}, {thing.name for thing in things})
    dressed, bare_told = _with_textures_there(things, file.parent)
    cell = Cell(
        camera, references=kept, objects=dressed, composites=groups, folder=file.parent.resolve()
    )
    return cell, (*hung, *held, *bare_told)


def _with_textures_there(
    things: tuple[Primitive, ...], folder: Path
) -> tuple[tuple[Primitive, ...], tuple[str, ...]]:
    kept, told = [], []
    for thing in things:
        look = thing.appearance
        pictures = () if look is None else [t.picture for t in look.textures.values()]
        gone = [name for name in pictures if not (folder / name).is_file()]
        if look is not None and gone:
            told.append(f"{thing.name}: its texture {gone[0]} is not beside the file")
            thing = replace(thing, appearance=Appearance(look.color))
        kept.append(thing)
    return tuple(kept), tuple(told)


def _document(file: Path) -> dict[str, Any]:
    try:
        data = file.read_bytes()
    except OSError as error:
        raise DocumentError(f"{file}: can't be read ({error.strerror})") from None
    start = HEADER.size + CHUNK.size
    if len(data) < start or data[:4] != b"glTF":
        raise DocumentError(f"{file}: is no binary glTF; choose a .glb that monocell exported")
    length, kind = CHUNK.unpack_from(data, HEADER.size)
    if kind != JSON_CHUNK or start + length > len(data):
        raise DocumentError(f"{file}: is cut short or damaged; export it again")
    try:
        document = json.loads(data[start : start + length])
    except ValueError as error:
        raise DocumentError(f"{file}: its JSON is damaged ({error})") from None
    if not isinstance(document, dict):
        raise DocumentError(f"{file}: its JSON is no object")
    return document


def _scene_extras(document: dict[str, Any], file: Path) -> dict[str, Any]:
    scenes = document.get("scenes", [])
    index = document.get("scene", 0)
    there = isinstance(index, int) and 0 <= index < len(scenes)
    extras = _extras(scenes[index]).get(KEY) if there else None
    if not isinstance(extras, dict) or "camera" not in extras:
        raise DocumentError(
            f"{file}: was not exported by monocell: its scene has no extras.{KEY} with a camera; "
            "open it with Blender's own glTF import"
        )
    return extras


def _extras(holder: Any) -> dict[str, Any]:
    extras = holder.get("extras", {}) if isinstance(holder, dict) else {}
    return extras if isinstance(extras, dict) else {}
