# SPDX-License-Identifier: GPL-3.0-or-later
"""Cell documents on disk: `*.cell.json` to a Cell and back, read strictly, written whole."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

from .atomic import atomic_path
from .cell import Cell, Reference, check_names
from .entries import (
    camera_entry,
    camera_from_entry,
    object_entry,
    reference_entry,
    reference_from_entry,
    sighting_entry,
    sighting_from_entry,
    thing_from_entry,
)
from .errors import DocumentError, InvalidValue
from .fields import keyed, text
from .primitives import Primitive
from .sketch import Sketch

VERSION = 1


def read_cell(path: str | Path) -> Cell:
    """Read a cell document. Raises DocumentError with the file and the path of the field."""
    file = Path(path)
    try:
        return cell_from_document(parse_json(file), file.parent)
    except (DocumentError, InvalidValue) as error:
        if str(error).startswith(str(file)):
            raise
        raise DocumentError(f"{file}: {error}") from None


def write_cell(cell: Cell, path: str | Path) -> None:
    """Write a cell document whole or not at all; picture names become relative to it."""
    file = Path(path)
    document = document_from_cell(cell, file.parent)
    with atomic_path(file) as temporary:
        temporary.write_text(dumped(document), encoding="utf-8")


def cell_from_document(document: Any, folder: Path) -> Cell:
    """A Cell from parsed JSON whose relative paths start at `folder`. Raises DocumentError."""
    fields = keyed(
        document, "", ("monocell", "camera"), ("picture", "sightings", "references", "objects")
    )
    version = fields.whole("monocell")
    if not 1 <= version <= VERSION:
        raise DocumentError(f"monocell: version {version} is unknown; this reads up to {VERSION}")
    things = [
        thing_from_entry(entry, f"objects[{i}]") for i, entry in enumerate(fields.items("objects"))
    ]
    references = [
        reference_from_entry(entry, f"references[{i}]")
        for i, entry in enumerate(fields.items("references"))
    ]
    _check_names(references, things)
    return Cell(
        camera=_camera(fields.raw("camera"), folder),
        picture=fields.text("picture") if fields.has("picture") else None,
        sightings=tuple(
            sighting_from_entry(entry, f"sightings[{i}]")
            for i, entry in enumerate(fields.items("sightings"))
        ),
        references=tuple(references),
        objects=tuple(thing for thing in things if isinstance(thing, Primitive)),
        sketches=tuple(thing for thing in things if isinstance(thing, Sketch)),
        folder=folder,
    )


def document_from_cell(cell: Cell, folder: Path) -> dict[str, Any]:
    """The JSON value of a cell for a document standing in `folder`."""
    document: dict[str, Any] = {"monocell": VERSION, "camera": camera_entry(cell.camera)}
    if cell.picture is not None:
        document["picture"] = _moved(cell.picture, cell.folder, folder)
    document["sightings"] = [
        sighting_entry(sighting) | {"picture": _moved(sighting.picture, cell.folder, folder)}
        for sighting in cell.sightings
    ]
    document["references"] = [reference_entry(reference) for reference in cell.references]
    document["objects"] = [object_entry(thing) for thing in cell.things]
    return document


def parse_json(file: Path) -> Any:
    """Parsed JSON. Raises DocumentError naming the file, and line and column where it breaks."""
    try:
        return json.loads(file.read_text(encoding="utf-8-sig"), object_pairs_hook=_once_each)
    except FileNotFoundError:
        raise DocumentError(f"{file}: there is no such file") from None
    except OSError as error:
        raise DocumentError(f"{file}: can't be read ({error.strerror})") from None
    except UnicodeDecodeError:
        raise DocumentError(f"{file}: is not a text file, so it is no JSON document") from None
    except json.JSONDecodeError as error:
        at = f"line {error.lineno}, column {error.colno}"
        raise DocumentError(f"{file}: is not JSON ({error.msg} at {at})") from None
    except RecursionError:
        raise DocumentError(f"{file}: is nested too deeply to be a cell document") from None
    except DocumentError as error:
        raise DocumentError(f"{file}: {error}") from None
    except ValueError as error:
        # a whole number of thousands of digits
        raise DocumentError(f"{file}: is not JSON that can be read ({error})") from None


def dumped(document: Any) -> str:
    """JSON a person can read: one line a number list, shortest digits that read back exactly."""
    return _laid_out(document, 0) + "\n"


def _once_each(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """A JSON object's keys; JSON would silently take the last of two equal ones."""
    value = dict(pairs)
    if len(value) < len(pairs):
        keys = [key for key, _ in pairs]
        twice = next(key for key in keys if keys.count(key) > 1)
        raise DocumentError(f"{twice}: stands there twice; leave one of them")
    return value


def _check_names(references: list[Reference], things: list[Primitive | Sketch]) -> None:
    """Here things still stand in the document's order, which messages count by."""
    try:
        check_names(references, things)
    except InvalidValue as error:
        raise DocumentError(str(error)) from None


def _camera(value: Any, folder: Path) -> Any:
    if not isinstance(value, str):
        return camera_from_entry(value)
    # imported here: the formats of others bring OpenCV and YAML, which most documents do not need
    from .camera_file import read_camera

    return read_camera(folder / text(value, "camera"))


def _moved(name: str, old_folder: Path, new_folder: Path) -> str:
    """A relative picture name as seen from the new folder; an absolute one stays."""
    if Path(name).is_absolute() or old_folder.resolve() == new_folder.resolve():
        return name
    return Path(os.path.relpath((old_folder / name).resolve(), new_folder.resolve())).as_posix()


def _laid_out(value: Any, depth: int) -> str:
    flat = json.dumps(value, ensure_ascii=False, allow_nan=False)
    if depth > 0 and len(flat) + 2 * depth <= 100 and not _holds_objects(value):
        return flat
    inner, outer = "  " * (depth + 1), "  " * depth
    if isinstance(value, dict) and value:
        rows = (f"{json.dumps(k)}: {_laid_out(v, depth + 1)}" for k, v in value.items())
        return "{\n" + ",\n".join(inner + row for row in rows) + f"\n{outer}}}"
    if isinstance(value, list) and value:
        return "[\n" + ",\n".join(inner + _laid_out(v, depth + 1) for v in value) + f"\n{outer}]"
    return flat


def _holds_objects(value: Any) -> bool:
    parts = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
    return any(isinstance(part, dict) for part in parts)
