# SPDX-License-Identifier: GPL-3.0-or-later
"""Edits of the model in a Blender scene: solved without Blender, then shown, in one undo step."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from ...core.cell import Cell
from ...core.errors import InvalidValue
from ..cell.document import show_objects, stored_report, write_scene
from .modelled import standing_cell

if TYPE_CHECKING:
    # solving takes its time to import, and registering has none
    from .editing import Edited


def change_model(scene: Any, edit: Callable[[Cell, float], Edited]) -> Edited:
    """Let an edit (cell, pick noise in pixels) change the scene.

    Raises what the edit raises; the scene is then as it was.
    """
    edited = edit(standing_cell(scene), scene.monocell_inputs.pick_sigma_pixels)
    write_scene(scene, edited.cell, stored_report(scene))
    told = show_objects(scene, edited.cell, edited.changed)
    return replace(edited, warnings=(*edited.warnings, *told))


def active_object(context: Any) -> Any | None:
    """Blender's active object, if it is one of the model."""
    from ...scene.objects import is_modelled

    ob = context.view_layer.objects.active
    return ob if ob is not None and is_modelled(ob) else None


def name_of(context: Any, asked: str) -> str:
    """The name in the document of what is asked for; empty: of the active object.

    Raises InvalidValue without one.
    """
    from ...scene.objects import read_object

    if asked:
        return asked
    ob = active_object(context)
    if ob is None:
        raise InvalidValue("no object of the cell is active: click on one, or name it")
    return read_object(ob).name


def make_active(scene: Any, reference: str) -> None:
    """Let new objects stand on a reference of the list."""
    stored = scene.monocell_cell
    stored.reference_index = stored.references.find(reference)


def paths_for(scene: Any) -> list[str]:
    """What a relation may name: references, and features of the model's objects."""
    from ...core.errors import MonocellError
    from ...core.shape.features import feature_names
    from ...scene.objects import is_modelled, read_object

    found = [row.name for row in scene.monocell_cell.references]
    for ob in scene.objects:
        if is_modelled(ob):
            try:
                thing = read_object(ob)
            except MonocellError:
                continue
            found += [thing.name, *(f"{thing.name}.{name}" for name in feature_names(thing))]
    return found


def redraw(context: Any) -> None:
    """Draw every 3D viewport anew."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()
