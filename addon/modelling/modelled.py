# SPDX-License-Identifier: GPL-3.0-or-later
"""Picks to an object in the scene: what all picking operators do once the picks are there."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

from ...core.cell import Cell
from ...core.errors import InvalidValue, PickError
from ...core.reference import PendingReference, Reference, ReferenceLine
from ..cell.document import objects_collection, read_scene
from ..cell.modes import leave_modes


def add_modelled(context: Any, kind: str, asked: Any) -> Any:
    """Solve the picks of a new object, build it, and select it. Returns the `Modelled`.

    `asked` has the texts `name` (empty: the first free one), `on` (empty: the list's active
    reference), `picks` and `known` (JSON), and the `way` it is held. Raises PickError for picks
    that can't be the object, InvalidValue for a name that is taken.
    """
    from ...core.modelling.solve import solve_sketch
    from ...core.sketch import Sketch
    from ...scene.objects import build_object
    from ..picking.pick_plans import plan_of

    scene = context.scene
    cell = standing_cell(scene)
    plan = plan_of(kind, asked.way)
    held = cell.reference(asked.on) if asked.on else active_reference(scene, cell, kind)
    on, relations = plan.holding(held)
    known = {**plan.known, **_parsed(asked.known, kind, "known")}
    sketch = Sketch(
        asked.name or free_name(cell, kind),
        kind,
        on,
        _parsed(asked.picks, kind, "picks"),
        known,
        relations=relations,
    )
    sigma = scene.monocell_inputs.pick_sigma_pixels
    camera = cell.standing_camera()
    modelled = solve_sketch(camera, sketch, cell.placed_references, cell.objects, sigma)
    # refuses a name that is taken, before anything is built
    cell.with_objects((*cell.objects, modelled.object))
    leave_modes(scene)
    ob = build_object(modelled.object, objects_collection(scene))
    return replace(modelled, warnings=(*modelled.warnings, *select_only(context, ob)))


def standing_cell(scene: Any) -> Cell:
    """The cell, its references where the objects that they are made from stand now.

    Raises what `resolve_references` raises.
    """
    from ...core.references.resolve import resolve_references

    cell = read_scene(scene)
    if not any(reference.source for reference in cell.references):
        return cell
    return resolve_references(cell, scene.monocell_inputs.pick_sigma_pixels)[0]


def active_reference(scene: Any, cell: Cell, kind: str) -> Reference:
    """The list's active reference, in its place.

    Raises InvalidValue for one without a place, and for a line, which holds none but balls.
    """
    reference = cell.references[scene.monocell_cell.reference_index]
    if isinstance(reference, PendingReference):
        raise InvalidValue(f"{reference.name} has no place yet: press Solve All first")
    if isinstance(reference, ReferenceLine) and kind != "sphere":
        raise InvalidValue(f"{reference.name} is a line; choose a plane to stand things on")
    return reference


def select_only(context: Any, ob: Any) -> tuple[str, ...]:
    """Make a new object the active one, and the only one selected.

    Returns a word on one that is not seen, because its collection is not.
    """
    layer, space = context.view_layer, context.space_data
    for other in context.selected_objects:
        other.select_set(False)
    if ob.name in layer.objects:
        layer.objects.active = ob
        ob.select_set(True)
        if space is not None and space.type == "VIEW_3D" and space.local_view is not None:
            ob.local_view_set(space, True)
    if ob.visible_get():
        return ()
    held = ob.users_collection[0].name
    return (f"{ob.name}: is not seen, as {held} is hidden or excluded; show it in the outliner",)


def free_name(cell: Cell, kind: str) -> str:
    """The kind, with the first number that makes it new."""
    taken = {thing.name for thing in cell.things} | {r.name for r in cell.references}
    names = (kind if i == 1 else f"{kind} {i}" for i in range(1, len(taken) + 2))
    return next(name for name in names if name not in taken)


def _parsed(text: str, kind: str, what: str) -> Any:
    try:
        parsed = json.loads(text or "{}")
    except json.JSONDecodeError as error:
        raise PickError(f"{what}: not JSON ({error.msg}); pick the {kind} in the picture") from None
    if not isinstance(parsed, dict):
        raise PickError(f"{what}: expected a JSON object, got {text:.40}")
    return parsed


def parsed_pixels(text: str) -> Any:
    """Pixels [[u, v], ...] from JSON. Raises PickError for anything else."""
    try:
        pixels = json.loads(text or "[]")
    except json.JSONDecodeError as error:
        raise PickError(f"picks: not JSON ({error.msg}); click in the picture") from None
    if not isinstance(pixels, list) or not all(isinstance(p, list) and len(p) == 2 for p in pixels):
        raise PickError(f"picks: expected a list of pixels [u, v], got {text:.40}")
    return pixels
