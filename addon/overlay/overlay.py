# SPDX-License-Identifier: GPL-3.0-or-later
"""The overlay of the camera view: ball outlines and wire-frames over the picture."""

from __future__ import annotations

from typing import Any

import bpy

from ..cell.document import active_plane, bare_cell, has_cell, stored_report
from ..preferences import settings
from ..settings import Settings
from .scene_changes import SceneChanges

# of so many the lines of their objects are kept
MOST_VIEWPORTS = 8


class Overlay:
    """Draws over every viewport that looks through a cell's camera.

    Lines are computed and sent to the graphics card when the cell, a calibration or an object
    changes; a redraw only places them.
    """

    def __init__(self, changes: SceneChanges) -> None:
        self._changes = changes
        self._balls: tuple[Any, list[Any], list[Any]] = ((), [], [])
        self._grid: tuple[Any, list[Any]] = ((), [])
        self._objects: dict[tuple[str, int], Any] = {}

    def draw(self) -> None:
        """Blender's call, once a redraw of any 3D viewport."""
        context = bpy.context
        scene, space = context.scene, context.space_data
        if not has_cell(scene) or not space.overlay.show_overlays:
            return
        from ..on_picture.camera_view import looks_through, view_of

        view = view_of(space, context.region)
        if looks_through(scene, space, view):
            self._draw_over(context, scene, view)

    def _draw_over(self, context: Any, scene: Any, view: Any) -> None:
        import gpu

        from ..on_picture.picture_frame import picture_frame

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
        from .object_lines import ObjectLines

        if bare_cell(scene).camera.camera_from_world is None:
            return []
        viewport = (scene.name, context.space_data.as_pointer())
        if viewport not in self._objects and len(self._objects) >= MOST_VIEWPORTS:
            # viewports and scenes that were closed
            self._objects.clear()
        lines = self._objects.setdefault(viewport, ObjectLines())
        return lines.batches(context, look, self._changes.count)


def register() -> None:
    """Start drawing. What has to be ended is kept where `unregister` takes it from again."""
    changes = SceneChanges()
    changes.listen()
    draw = Overlay(changes).draw
    handle = bpy.types.SpaceView3D.draw_handler_add(draw, (), "WINDOW", "POST_PIXEL")
    bpy.types.SpaceView3D.monocell_overlay = (handle, changes)


def unregister() -> None:
    """Stop drawing."""
    handle, changes = bpy.types.SpaceView3D.monocell_overlay
    bpy.types.SpaceView3D.draw_handler_remove(handle, "WINDOW")
    changes.end()
    del bpy.types.SpaceView3D.monocell_overlay


def _batches(strokes: Any) -> list[Any]:
    from .drawing import LineBatch
    from .overlay_lines import joined, looks_of

    looks = joined([looks_of(strokes)])
    return [LineBatch.of_ends(ends, color, width) for (color, width), ends in looks.items()]
