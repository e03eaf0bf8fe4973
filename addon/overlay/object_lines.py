# SPDX-License-Identifier: GPL-3.0-or-later
"""The wire-frames of a viewport's objects: a scene in, lines on the graphics card out.

What did not change is not looked at again: with a hundred objects in the view, a redraw costs no
more than with one.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

from ..cell.document import bare_cell
from ..settings import Settings
from .drawing import LineBatch


class ObjectLines:
    """The lines of all objects that one viewport shows, in few batches.

    The objects that changed last have batches of their own: while one is dragged, the lines of the
    others stay on the graphics card.
    """

    def __init__(self) -> None:
        self._state: Any = None
        self._common: Any = None
        # by the object's name: what its lines depend on, and its lines
        self._held: dict[str, tuple[Any, Any]] = {}
        self._apart: frozenset[str] = frozenset()
        self._resting: list[LineBatch] = []
        self._changing: list[LineBatch] = []

    def batches(self, context: Any, look: Settings, changes: int) -> list[LineBatch]:
        """The batches to draw in the context's viewport; `changes` grows with every change."""
        scene, layer, space = context.scene, context.view_layer, context.space_data
        active = layer.objects.active
        selected = active is not None and active.select_get(view_layer=layer)
        common = (scene.monocell_cell.text, look)
        shown = (layer.name, space.local_view is not None, selected and active.name)
        if self._state != (changes, common, shown):
            self._state = changes, common, shown
            self._look_again(scene, space, active if selected else None, common)
        return [*self._resting, *self._changing]

    def _look_again(self, scene: Any, space: Any, active: Any, common: Any) -> None:
        from ...scene.objects import is_modelled

        # what was drawn for another camera or in other colours is of no use
        before = self._held if self._common == common else {}
        held, changed = {}, set(before)
        for ob in scene.objects:
            if not is_modelled(ob) or not ob.visible_get(viewport=space):
                continue
            key = _object_key(ob, ob == active)
            kept = before.get(ob.name)
            if kept is not None and kept[0] == key:
                held[ob.name] = kept
                changed.discard(ob.name)
            else:
                held[ob.name] = key, _lines_of(scene, ob, key[0], common[1])
                changed.add(ob.name)
        self._held, self._common = held, common
        self._send(changed)

    def _send(self, changed: set[str]) -> None:
        """Send to the graphics card what changed, and the rest where it did not hold the same."""
        if not changed:
            return
        if self._apart != changed:
            self._apart = frozenset(changed)
            self._resting = self._joined(self._held.keys() - self._apart)
        self._changing = self._joined(self._apart & self._held.keys())

    def _joined(self, names: Collection[str]) -> list[LineBatch]:
        from .overlay_lines import joined

        looks = joined(lines for name, (_, lines) in self._held.items() if name in names)
        return [LineBatch.of_ends(ends, color, width) for (color, width), ends in looks.items()]


def _object_key(ob: Any, active: bool) -> tuple[Any, ...]:
    """What an object's lines depend on; in edit mode its dimensions follow the edit."""
    return (active, ob.matrix_world.copy(), tuple(ob.dimensions))


def _lines_of(scene: Any, ob: Any, active: bool, look: Settings) -> Any:
    from ...core.errors import MonocellError
    from ...scene.objects import read_object
    from .overlay_lines import looks_of, object_strokes

    try:
        thing = read_object(ob)
    except MonocellError:
        # an object edited out of its kind has no wire-frame; the panel says so
        return {}
    return looks_of(object_strokes(thing, bare_cell(scene).camera, active, look))
