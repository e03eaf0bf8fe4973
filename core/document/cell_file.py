# SPDX-License-Identifier: GPL-3.0-or-later
"""Cell documents on disk: `*.cell.json` to a Cell and back, read strictly, written whole."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from ..atomic import atomic_path
from ..camera import Camera
from ..cell import Cell, check_names, check_sightings
from ..composite import Composite
from ..errors import DocumentError, InvalidValue
from ..mount import Mount
from ..primitives import Primitive
from ..reference import PendingReference, Reference
from ..sighting import Sighting
from ..sketch import Sketch
from .appearance_entries import with_pictures_moved
from .entries import (
    camera_entry,
    camera_from_entry,
    composite_entry,
    composite_from_entry,
    object_entry,
    thing_from_entry,
)
from .fields import keyed, text
from .json_text import dumped, parse_json
from .reference_entries import reference_entry, reference_from_entry
from .sighting_entries import mount_entry, mount_from_entry, sighting_entry, sighting_from_entry

VERSION = 1
OPTIONAL = ("mount", "picture", "sightings", "references", "objects", "composites")


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
    """Write a cell document whole or not at all; picture names become relative to it.

    Raises DocumentError for another ending than .json: a slip would cost the picture named there.
    """
    file = Path(path)
    if file.suffix.lower() != ".json":
        raise DocumentError(f"{file}: a cell document ends in .json, such as cell.cell.json")
    document = document_from_cell(cell, file.parent)
    with atomic_path(file) as temporary:
        temporary.write_text(dumped(document), encoding="utf-8")


def cell_from_document(document: Any, folder: Path) -> Cell:
    """A Cell from parsed JSON whose relative paths start at `folder`. Raises DocumentError."""
    fields = keyed(document, "", ("monocell", "camera"), OPTIONAL)
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
    sightings = tuple(
        sighting_from_entry(entry, f"sightings[{i}]")
        for i, entry in enumerate(fields.items("sightings"))
    )
    mount = mount_from_entry(fields.raw("mount")) if fields.has("mount") else None
    composites = [
        composite_from_entry(entry, f"composites[{i}]")
        for i, entry in enumerate(fields.items("composites"))
    ]
    _check(references, things, composites, sightings, mount)
    camera = _camera(fields.raw("camera"), folder)
    return Cell(
        camera=camera if mount is None else _mounted(camera, mount),
        picture=fields.text("picture") if fields.has("picture") else None,
        sightings=sightings,
        references=tuple(references),
        objects=tuple(thing for thing in things if isinstance(thing, Primitive)),
        sketches=tuple(thing for thing in things if isinstance(thing, Sketch)),
        folder=folder,
        mount=mount,
        composites=tuple(composites),
    )


def document_from_cell(cell: Cell, folder: Path) -> dict[str, Any]:
    """The JSON value of a cell for a document standing in `folder`."""
    # the pose of a mounted camera follows from its mount: it is written once
    camera = cell.camera if cell.mount is None else Camera(cell.camera.intrinsics)
    document: dict[str, Any] = {"monocell": VERSION, "camera": camera_entry(camera)}
    if cell.mount is not None:
        document["mount"] = mount_entry(cell.mount)
    if cell.picture is not None:
        document["picture"] = picture_from(cell.picture, cell.folder, folder)
    document["sightings"] = [
        sighting_entry(sighting) | {"picture": picture_from(sighting.picture, cell.folder, folder)}
        for sighting in cell.sightings
    ]
    document["references"] = [reference_entry(reference) for reference in cell.references]
    document["objects"] = [
        with_pictures_moved(
            object_entry(thing), lambda name: picture_from(name, cell.folder, folder)
        )
        for thing in cell.things
    ]
    if cell.composites:
        document["composites"] = [composite_entry(composite) for composite in cell.composites]
    return document


def picture_from(name: str, old_folder: Path, new_folder: Path) -> str:
    """A relative picture name as seen from the new folder; an absolute one stays."""
    if Path(name).is_absolute() or old_folder.resolve() == new_folder.resolve():
        return name
    return Path(os.path.relpath((old_folder / name).resolve(), new_folder.resolve())).as_posix()


def _check(
    references: list[Reference | PendingReference],
    things: list[Primitive | Sketch],
    composites: list[Composite],
    sightings: tuple[Sighting, ...],
    mount: Mount | None,
) -> None:
    """Here things still stand in the document's order, which messages count by."""
    try:
        check_names(references, things, composites)
        check_sightings(sightings, mount)
    except InvalidValue as error:
        raise DocumentError(str(error)) from None


def _mounted(camera: Camera, mount: Mount) -> Camera:
    if camera.camera_from_world is not None or camera.covariance is not None:
        raise DocumentError(
            "camera.camera_from_world: a camera on the flange stands elsewhere in every picture; "
            "give mount.camera_from_flange, and mount.world_from_flange of the picture"
        )
    return mount.placed(camera)


def _camera(value: Any, folder: Path) -> Camera:
    if not isinstance(value, str):
        return camera_from_entry(value)
    # imported here: the formats of others bring OpenCV and YAML, which most documents do not need
    from .camera_file import read_camera

    return read_camera(folder / text(value, "camera"))
