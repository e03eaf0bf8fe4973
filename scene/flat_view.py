# SPDX-License-Identifier: GPL-3.0-or-later
"""A cell's objects shining with their own colours and textures: a cell in, linear light out.

Textures from a picture hold the light of that picture already: shown without any other light, and
from the camera that took it, they give the picture back.
"""

from __future__ import annotations

from typing import Any

import bpy

from ..core.arrays import Array
from ..core.camera import Camera
from ..core.cell import Cell
from .rendering import render_linear, render_window
from .textures import painted_mesh
from .transforms import matrix_of


def flat_view(
    cell: Cell,
    *,
    camera: Camera | None = None,
    window: tuple[int, int, int, int] | None = None,
    samples: int = 16,
) -> Array:
    """What `camera` (the cell's own without) sees, (H, W, 3) float32 red, green, blue; else black.

    `window` (x, y, width, height) is the part of the picture that is rendered and returned.

    Everything is built in a scene of its own that is gone afterwards. Raises NoPose, PictureError
    for a texture that can't be read, InvalidValue for a window outside the picture, RenderFailed
    when Cycles gives no picture.
    """
    camera = camera or cell.standing_camera()
    scene, built = bpy.data.scenes.new("monocell flat view"), []
    try:
        for thing in cell.objects:
            mesh, made = painted_mesh(thing, cell.folder, glow=True)
            ob = bpy.data.objects.new(thing.name, mesh)
            built += [ob, *made]
            ob.matrix_world = matrix_of(thing.world_from_object)
            scene.collection.objects.link(ob)
        if window is not None:
            return render_window(scene, camera, window, samples=samples, bounces=0)
        return render_linear(scene, camera, samples=samples, bounces=0)
    finally:
        _remove(scene, built)


def _remove(scene: Any, built: list[Any]) -> None:
    if scene.camera is not None:
        built += [scene.camera, scene.camera.data]
    bpy.data.scenes.remove(scene)
    bpy.data.batch_remove(built)
