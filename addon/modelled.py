# SPDX-License-Identifier: GPL-3.0-or-later
"""Picks to an object in the scene: what both picking operators do once the picks are there."""

from __future__ import annotations

import json
from typing import Any

from ..core.cell import Cell
from ..core.errors import PickError
from .document import objects_collection, read_scene


def add_modelled(context: Any, kind: str, name: str, on: str, picks: str) -> Any:
    """Solve the picks (JSON) of a new object, build it, and select it. Returns the `Modelled`.

    An empty `name` gives the first free one, an empty `on` the list's active reference. Raises
    PickError for picks that can't be the object, InvalidValue for a name that is taken.
    """
    from ..core.modelling.solve import solve_sketch
    from ..core.sketch import Sketch
    from ..scene.objects import build_object

    scene = context.scene
    cell = read_scene(scene)
    on = on or cell.references[scene.monocell_cell.reference_index].name
    sketch = Sketch(name or free_name(cell, kind), kind, on, _parsed(picks, kind))
    sigma = scene.monocell_inputs.pick_sigma_pixels
    modelled = solve_sketch(cell.camera, sketch, cell.placed_references, cell.objects, sigma)
    # refuses a name that is taken, before anything is built
    cell.with_objects((*cell.objects, modelled.object))
    ob = build_object(modelled.object, objects_collection(scene))
    for other in context.selected_objects:
        other.select_set(False)
    context.view_layer.objects.active = ob
    ob.select_set(True)
    return modelled


def free_name(cell: Cell, kind: str) -> str:
    """The kind, with the first number that makes it new."""
    taken = {thing.name for thing in cell.things}
    names = (kind if i == 1 else f"{kind} {i}" for i in range(1, len(taken) + 2))
    return next(name for name in names if name not in taken)


def _parsed(picks: str, kind: str) -> Any:
    try:
        parsed = json.loads(picks or "{}")
    except json.JSONDecodeError as error:
        raise PickError(f"picks: not JSON ({error.msg}); pick the {kind} in the picture") from None
    if not isinstance(parsed, dict):
        raise PickError(f"picks: expected a JSON object, got {picks:.40}")
    return parsed
