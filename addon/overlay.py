# SPDX-License-Identifier: GPL-3.0-or-later
"""The overlay of the camera view: ball outlines and wire-frames over the picture."""

from __future__ import annotations

from typing import Any

import bpy

from .document import bare_cell, has_cell, stored_report


class Overlay:
    """Draws over every viewport that looks through a cell's camera.

    Lines are computed and sent to the graphics card when the cell, a calibration or an object
    changes; a redraw only places them.
    """

    def __init__(self) -> None:
        self._balls: tuple[Any, list[Any], list[Any]] = ((), [], [])
        self._objects: dict[str, tuple[Any, list[Any]]] = {}

    def draw(self) -> None:
        """Blender's call, once a redraw of any 3D viewport."""
        context = bpy.context
        scene, space = context.scene, context.space_data
        if not has_cell(scene) or not space.overlay.show_overlays:
            return
        from .cell_scene import looks_through

        if looks_through(scene, space):
            self._draw_over(context, scene, space)

    def _draw_over(self, context: Any, scene: Any, space: Any) -> None:
        import gpu

        from .picture_frame import picture_frame

        intrinsics = bare_cell(scene).camera.intrinsics
        frame = picture_frame(scene, context.region, space, intrinsics)
        (x, y), (right, below) = frame.region_points([[0.0, 0.0], [1.0, 1.0]])
        batches = [*self._object_batches(context, scene), *self._ball_batches(scene)]
        scale = context.preferences.system.ui_scale
        with gpu.matrix.push_pop():
            gpu.matrix.translate((x, y))
            gpu.matrix.scale((right - x, below - y))
            for batch in batches:
                batch.draw(scale)
        from .drawing import draw_labels

        _, _, labels = self._balls
        points = frame.region_points([label.pixel for label in labels]) if labels else ()
        draw_labels(
            [(at, one.text, one.color) for at, one in zip(points, labels, strict=True)], scale
        )

    def _ball_batches(self, scene: Any) -> list[Any]:
        stored = scene.monocell_cell
        key = (stored.text, stored.report, stored.sighting_index)
        if self._balls[0] != key:
            from .overlay_lines import sighting_labels, sighting_strokes

            cell, report = bare_cell(scene), stored_report(scene)
            strokes = sighting_strokes(cell, report, stored.sighting_index)
            self._balls = key, _batches(strokes), list(sighting_labels(cell, report))
        return self._balls[1]

    def _object_batches(self, context: Any, scene: Any) -> list[Any]:
        from ..scene.objects import is_modelled

        if bare_cell(scene).camera.camera_from_world is None:
            return []
        active = context.view_layer.objects.active
        shown = [ob for ob in scene.objects if is_modelled(ob) and ob.visible_get()]
        before, self._objects = self._objects, {}
        for ob in shown:
            key = _object_key(scene, ob, ob == active and ob.select_get())
            held = before.get(ob.name)
            if held is None or held[0] != key:
                held = key, _batches(_strokes_of(scene, ob, key[0]))
            self._objects[ob.name] = held
        return [batch for _, batches in self._objects.values() for batch in batches]


def register() -> None:
    """Start drawing. Blender's handle is kept where `unregister` takes it from again."""
    handle = bpy.types.SpaceView3D.draw_handler_add(Overlay().draw, (), "WINDOW", "POST_PIXEL")
    bpy.types.SpaceView3D.monocell_overlay = handle


def unregister() -> None:
    """Stop drawing."""
    handle = bpy.types.SpaceView3D.monocell_overlay
    bpy.types.SpaceView3D.draw_handler_remove(handle, "WINDOW")
    del bpy.types.SpaceView3D.monocell_overlay


def _object_key(scene: Any, ob: Any, active: bool) -> tuple[Any, ...]:
    """What an object's lines depend on; in edit mode its dimensions follow the edit."""
    place = tuple(tuple(row) for row in ob.matrix_world)
    return (active, scene.monocell_cell.text, place, tuple(ob.dimensions))


def _strokes_of(scene: Any, ob: Any, active: bool) -> Any:
    from ..core.errors import MonocellError
    from ..scene.objects import read_object
    from .overlay_lines import object_strokes

    try:
        thing = read_object(ob)
    except MonocellError:
        # an object edited out of its kind has no wire-frame; the panel says so
        return ()
    return object_strokes(thing, bare_cell(scene).camera, active)


def _batches(strokes: Any) -> list[Any]:
    from .drawing import LineBatch

    return [LineBatch(stroke.lines, stroke.color, stroke.width) for stroke in strokes]
