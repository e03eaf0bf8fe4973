# SPDX-License-Identifier: GPL-3.0-or-later
"""What both operators share that give objects their looks from the picture."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import bpy

from ...core.errors import InvalidValue
from ..background_job import WorksInBackground
from ..cell.cell_scene import title_of
from ..cell.document import show_objects, stored_report, write_scene
from ..polls import NeedsPose
from .model_changes import name_of
from .modelled import standing_cell


class TakesLooks(WorksInBackground, NeedsPose):
    """An operator that looks at one object or, with `everything`, at all; `textured` ones too."""

    textured = False

    def prepare(self, context):
        """What is done in the background."""
        from ...core.look.looks import looks_of
        from ...core.picture.pictures import read_picture

        scene = context.scene
        cell = standing_cell(scene)
        if cell.picture is None:
            raise InvalidValue("the cell has no picture, and objects get their looks from it")
        if not cell.objects:
            raise InvalidValue("no object is modelled yet, so there is nothing to look at")
        names = [thing.name for thing in cell.objects]
        names = names if self.everything else [name_of(context, "")]
        self._cell, self._document = cell, document_of(scene) if self.textured else None
        path = cell.path_of(cell.picture)

        def work(watch):
            looks = []
            for look in looks_of(
                cell,
                read_picture(path, cell.camera.intrinsics),
                names=names,
                textured=names if self.textured else (),
                jpeg=path.suffix.lower() in (".jpg", ".jpeg"),
            ):
                watch(look.thing.name)
                looks.append(look)
            return looks

        return "Looking at the objects", len(names), work

    def finish(self, context, looks):
        """Let the objects look so."""
        from ...core.errors import MonocellError
        from ...core.look.texture_files import with_looks

        try:
            # without faces nothing is written, wherever the document is
            dressed = with_looks(self._cell, looks, self._document or "unsaved")
            cell = _looking_so(standing_cell(context.scene), dressed)
        except MonocellError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        write_scene(context.scene, cell, stored_report(context.scene))
        told = show_objects(context.scene, cell, [look.thing.name for look in looks])
        self.report({"INFO"}, ", ".join(_told(look) for look in looks))
        for warning in (*told, *(w for look in looks for w in look.warnings)):
            self.report({"WARNING"}, warning)
        return {"FINISHED"}


def _looking_so(cell, dressed):
    """The cell as it is now, its objects with their looks of another."""
    looks = {thing.name: thing.appearance for thing in dressed.objects}
    return cell.with_objects(
        replace(thing, appearance=looks.get(thing.name, thing.appearance)) for thing in cell.objects
    )


def document_of(scene):
    """The file that textures are written beside: the cell's document, or the .blend.

    Raises InvalidValue where neither is saved.
    """
    path = scene.monocell_cell.path
    if path and Path(bpy.path.abspath(path)).parent.is_dir():
        return Path(bpy.path.abspath(path))
    if bpy.data.filepath:
        return Path(bpy.data.filepath).with_name(f"{title_of(scene.name)}.cell.json")
    raise InvalidValue(
        "textures are files beside the cell: save the .blend file first, or open a saved document"
    )


def _told(look):
    sample = look.color
    if sample.color is None:
        return f"{look.thing.name} is not seen"
    red, green, blue = sample.color
    faces = f", {len(look.faces)} faces" if look.faces else ""
    return f"{look.thing.name} {red:.2f} {green:.2f} {blue:.2f}{faces}"
