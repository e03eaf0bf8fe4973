# SPDX-License-Identifier: GPL-3.0-or-later
"""The overlay of the camera view: ball outlines and wire-frames over the picture."""

from __future__ import annotations

from typing import Any

import bpy

from .document import active_plane, bare_cell, has_cell, stored_report
from .preferences import settings
from .settings import Settings


class Overlay:
    """Draws over every viewport that looks through a cell's camera.

    Lines are computed and sent to the graphics card when the cell, a calibration or an object
    changes; a redraw only places them.
    """

    def __init__(self) -> None:
        self._balls: tuple[Any, list[Any], list[Any]] = ((), [], [])
        self._grid: tuple[Any, list[Any]] = ((), [])
        self._common: tuple[Any, ...] = ()
        self._lines: dict[str, tuple[Any, _Held]] = {}
        self._objects: list[Any] | None = None

    def draw(self) -> None:
        """Blender's call, once a redraw of any 3D viewport."""
        context = bpy.context
        scene, space = context.scene, context.space_data
        if not has_cell(scene) or not space.overlay.show_overlays:
            return
        from .camera_view import looks_through, view_of

        view = view_of(space, context.region)
        if looks_through(scene, space, view):
            self._draw_over(context, scene, view)

    def _draw_over(self, context: Any, scene: Any, view: Any) -> None:
        import gpu

        from .picture_frame import picture_frame

        intrinsics = bare_cell(scene).camera.intrinsics
        frame = picture_frame(scene, context.region, view, intrinsics)
        (x, y), (right, below) = frame.region_points([[0.0, 0.0], [1.0, 1.0]])
        look = settings(context)
        batches = list(self._grid_batches(scene, look))
        work = context.window_manager.monocell_work
        # what would change is drawn instead
        batches += [] if work.reviewing else self._object_batches(context, scene, look)
        # sightings would lie over what is picked or chosen
        busy = work.picking or work.reviewing
        batches += [] if busy else self._ball_batches(scene, look)
        scale = context.preferences.system.ui_scale
        with gpu.matrix.push_pop():
            gpu.matrix.translate((x, y))
            gpu.matrix.scale((right - x, below - y))
            for batch in batches:
                batch.draw(scale)
        from .drawing import draw_labels

        labels = [] if busy else self._balls[2]
        points = frame.region_points([label.pixel for label in labels]) if labels else ()
        draw_labels(
            [(at, one.text, one.color) for at, one in zip(points, labels, strict=True)], scale
        )

    def _grid_batches(self, scene: Any, look: Settings) -> list[Any]:
        stored = scene.monocell_cell
        camera = bare_cell(scene).camera
        if not scene.monocell_inputs.show_grid or camera.camera_from_world is None:
            return []
        key = (stored.text, stored.reference_index, look)
        if self._grid[0] != key:
            from .overlay_lines import grid_strokes
            from .plane_grid import plane_grid

            plane = active_plane(scene)
            grid = None if plane is None else plane_grid(camera, plane)
            self._grid = key, [] if grid is None else _batches(grid_strokes(grid, look))
        return self._grid[1]

    def _ball_batches(self, scene: Any, look: Settings) -> list[Any]:
        stored = scene.monocell_cell
        shown = stored.shown_picture
        key = (stored.text, stored.report, stored.sighting_index, look, shown)
        if self._balls[0] != key:
            from .overlay_lines import sighting_labels, sighting_strokes

            cell, report = bare_cell(scene), stored_report(scene)
            strokes = sighting_strokes(cell, report, stored.sighting_index, look, shown)
            self._balls = key, _batches(strokes), list(sighting_labels(cell, report, look))
        return self._balls[1]

    def _object_batches(self, context: Any, scene: Any, look: Settings) -> list[Any]:
        from ..scene.objects import is_modelled

        if bare_cell(scene).camera.camera_from_world is None:
            return []
        active = context.view_layer.objects.active
        common = (scene.monocell_cell.text, look)
        # what was drawn for another camera or in other colours is of no use
        before = self._lines if self._common == common else {}
        self._lines, self._common = {}, common
        for ob in scene.objects:
            if not is_modelled(ob) or not ob.visible_get(viewport=context.space_data):
                continue
            key = _object_key(ob, ob == active and ob.select_get())
            held = before.get(ob.name)
            if held is None or held[0] != key:
                held = key, _lines_of(scene, ob, key[0], look)
            self._lines[ob.name] = held
        # of a hundred objects one was moved: the lines of the others are kept, and sent as one
        if before != self._lines or self._objects is None:
            self._objects = _joined(lines for _, lines in self._lines.values())
        return self._objects


def register() -> None:
    """Start drawing. Blender's handle is kept where `unregister` takes it from again."""
    handle = bpy.types.SpaceView3D.draw_handler_add(Overlay().draw, (), "WINDOW", "POST_PIXEL")
    bpy.types.SpaceView3D.monocell_overlay = handle


def unregister() -> None:
    """Stop drawing."""
    handle = bpy.types.SpaceView3D.monocell_overlay
    bpy.types.SpaceView3D.draw_handler_remove(handle, "WINDOW")
    del bpy.types.SpaceView3D.monocell_overlay


def _object_key(ob: Any, active: bool) -> tuple[Any, ...]:
    """What an object's lines depend on; in edit mode its dimensions follow the edit."""
    return (active, ob.matrix_world.copy(), tuple(ob.dimensions))


class _Held:
    """An object's lines; two are equal when they are the same ones."""

    def __init__(self, looks: Any) -> None:
        self.looks = looks


def _lines_of(scene: Any, ob: Any, active: bool, look: Settings) -> _Held:
    from ..core.errors import MonocellError
    from ..scene.objects import read_object
    from .overlay_lines import looks_of, object_strokes

    try:
        thing = read_object(ob)
    except MonocellError:
        # an object edited out of its kind has no wire-frame; the panel says so
        return _Held({})
    return _Held(looks_of(object_strokes(thing, bare_cell(scene).camera, active, look)))


def _joined(held: Any) -> list[Any]:
    from .drawing import LineBatch
    from .overlay_lines import joined

    looks = joined(one.looks for one in held)
    return [LineBatch.of_ends(ends, color, width) for (color, width), ends in looks.items()]


def _batches(strokes: Any) -> list[Any]:
    from .drawing import LineBatch

    return [LineBatch(stroke.lines, stroke.color, stroke.width) for stroke in strokes]
