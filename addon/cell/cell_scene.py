# SPDX-License-Identifier: GPL-3.0-or-later
"""A cell into a Blender scene of its own: camera, picture behind the view, objects, document."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import bpy
import numpy as np

from ...core.arrays import Array
from ...core.camera import Camera
from ...core.cell import Cell
from ...core.errors import InvalidValue, PictureError
from ...core.pose import Pose
from ..preferences import settings
from ..waiting import waiting
from .document import bare_cell, show_objects, write_scene

# how far a click may be off, in pixels, before the Blender camera counts as moved
SAME_PIXELS = 0.05
# the picture's corners and middle, a metre and more ahead, tell whether two cameras see the same
PROBES_CAMERA = np.array([[x, y, z] for x in (-0.4, 0, 0.4) for y in (-0.3, 0.3) for z in (1, 3)])
# where a camera is put that has no pose yet: like someone standing at the cell's corner
FIRST_DIRECTION = np.array([1.0, -1.3, 0.9])
LEAST_DISTANCE = 1.5
# what `first_plate` tells of, and that Blender shows it
PLATE_STEPS = 4
LENGTH_UNITS = {"mm": "MILLIMETERS", "cm": "CENTIMETERS", "m": "METERS", "in": "INCHES"}


def open_scene(context: Any, cell: Cell, plate: Any | None, title: str) -> Any:
    """Make a scene of `cell` and show it in the window; the user's own scenes are left alone.

    `plate` is what is shown behind the view, as `first_plate` reads it. A refusal (PictureError,
    InvalidValue) changes nothing.
    Returns the scene.
    """
    with waiting(context), _new_scene(title) as scene:
        write_scene(scene, cell)
        _measure_in(scene, settings(context).unit)
        put_camera(scene)
        if plate is not None:
            show_picture(scene, plate)
        for missing in show_objects(scene, cell):
            raise PictureError(missing)
    context.window.scene = scene
    return scene


def _measure_in(scene: Any, unit: str) -> None:
    """Let Blender's own fields show the user's unit."""
    measured = scene.unit_settings
    measured.system = "IMPERIAL" if unit == "in" else "METRIC"
    measured.length_unit = LENGTH_UNITS[unit]


def first_plate(cell: Cell, watch: Callable[[str], None]) -> Any | None:
    """The `Plate` to show first: of the cell's own picture, or of its first sighting's.

    It asks nothing of Blender. Raises PictureError.
    """
    from ...core.picture.plate import read_plate

    name = cell.picture
    if name is None and cell.sightings:
        name = cell.sightings[0].picture
    return None if name is None else read_plate(cell, name, watch)


def show_picture(scene: Any, plate: Any) -> None:
    """Show a `Plate` of the scene's cell behind the camera view."""
    from ...scene.background import show_plate

    image = show_plate(_camera_of(scene), plate)
    # Blender decodes it when it is first asked: here, under the wait cursor, not while it draws
    tuple(image.size)
    scene.monocell_cell.shown_picture = plate.name
    scene.monocell_cell.shown_told = "; ".join(plate.told)


def needs_picture_again(scene: Any) -> bool:
    """Whether the shown picture went with a camera that was deleted."""
    stored = scene.monocell_cell
    if not stored.shown_picture:
        return False
    return stored.camera is None or not stored.camera.data.background_images


def put_camera(scene: Any) -> None:
    """Give Blender's camera the lens and place of the document's; it is locked against slips."""
    from ...scene.blender_camera import place_camera

    ob, cell = _camera_of(scene), bare_cell(scene)
    place_camera(ob, scene.render, cell.camera.intrinsics, _pose_or_guess(cell))
    ob.lock_location = ob.lock_rotation = ob.lock_scale = (True, True, True)
    scene.camera = ob
    _unhide(scene, ob)


def camera_stands(scene: Any) -> bool:
    """Whether Blender's camera still is the document's, so that models meet the picture."""
    from ...scene.blender_camera import read_camera

    ob, cell = scene.monocell_cell.camera, bare_cell(scene)
    if ob is None or scene.camera != ob or scene.objects.get(ob.name) != ob:
        return False
    try:
        now = read_camera(ob, scene.render)
    except InvalidValue:
        return False
    wanted = Camera(cell.camera.intrinsics.undistorted(), _pose_or_guess(cell))
    seen = Camera(now.intrinsics.undistorted(), now.camera_from_world)
    points = wanted.pose.inverse().apply(PROBES_CAMERA)
    same = np.abs(wanted.project(points) - seen.project(points)) < SAME_PIXELS
    size = (cell.camera.intrinsics.width, cell.camera.intrinsics.height)
    return bool(same.all()) and size == (now.intrinsics.width, now.intrinsics.height)


def look_through(context: Any) -> None:
    """Turn the window's largest 3D viewport to the camera, the picture filling its free part.

    In a quad view that is the part that looks through it already, else the one that turns freely.
    """
    area = viewport(context)
    if area is None:
        return
    from ..on_picture.camera_view import camera_region, view_of, window_regions
    from ..on_picture.picture_frame import fit_picture, free_part

    scene, space = context.scene, area.spaces.active
    space.use_local_camera = False
    region = camera_region(scene, area) or window_regions(area)[-1]
    view = view_of(space, region)
    _aim(scene, view)
    view.view_perspective = "CAMERA"
    fit_picture(scene, region, view, free_part(area, region))
    if space.local_view is not None:
        # Blender hides the picture with its camera
        scene.camera.local_view_set(space, True)
    # the picture shows through the models; grid and cursor would only lie on top of it
    space.shading.show_xray, space.shading.xray_alpha = True, 0.35
    space.overlay.show_floor = space.overlay.show_cursor = False
    space.overlay.show_axis_x = space.overlay.show_axis_y = False
    area.tag_redraw()


def viewport(context: Any) -> Any | None:
    """The 3D viewport that the user is in, or else the largest of the window."""
    if context.area is not None and context.area.type == "VIEW_3D":
        return context.area
    screen = context.window.screen if context.window else None
    areas = [area for area in screen.areas if area.type == "VIEW_3D"] if screen else []
    return max(areas, key=lambda area: area.width * area.height, default=None)


def _pose_or_guess(cell: Cell) -> Pose:
    """The camera's pose, or for a camera without one a place that overlooks its sightings."""
    if cell.camera.camera_from_world is not None:
        return cell.camera.camera_from_world
    middle = _middle(cell)
    reach = max((np.linalg.norm(place - middle) for place in _places(cell)), default=0.0)
    direction = FIRST_DIRECTION / np.linalg.norm(FIRST_DIRECTION)
    return Pose.looking_at(
        middle + max(LEAST_DISTANCE, 3 * float(reach)) * direction, middle, [0, 0, 1]
    )


def _aim(scene: Any, view: Any) -> None:
    """Let the view turn about the cell's middle when the user leaves the camera."""
    middle = _middle(bare_cell(scene))
    view.view_location = middle.tolist()
    view.view_distance = float(np.linalg.norm(np.array(scene.camera.matrix_world)[:3, 3] - middle))


def _middle(cell: Cell) -> Array:
    """The middle of the ball's positions, (3,); the world's origin without any."""
    return np.array(_places(cell) or [np.zeros(3)]).mean(axis=0)


def _places(cell: Cell) -> list[Array]:
    """The known places of the cell's sightings, and of the rest that of the flange."""
    flanges = [s.world_from_flange for s in cell.sightings if s.center_world is None]
    places = [s.center_world for s in cell.sightings if s.center_world is not None]
    return [*places, *(flange.translation for flange in flanges if flange is not None)]


def _camera_of(scene: Any) -> Any:
    """The cell's camera; made, or linked again, where a user removed it.

    A scene that was made with the settings of another gets one of its own, with the same picture.
    """
    stored = scene.monocell_cell
    scenes = () if stored.camera is None else stored.camera.users_scene
    if scenes and scene not in scenes:
        data = stored.camera.data.copy()
        stored.camera = stored.camera.copy()
        stored.camera.data = data
    if stored.camera is None:
        stored.camera = bpy.data.objects.new("Cell camera", bpy.data.cameras.new("Cell camera"))
        data = stored.camera.data
        # a cell may begin a hand's breadth from the lens
        data.clip_start, data.clip_end = 0.01, 100.0
        data.passepartout_alpha, data.display_size = 0.85, 0.08
    if scene.objects.get(stored.camera.name) != stored.camera:
        scene.collection.objects.link(stored.camera)
    return stored.camera


def _unhide(scene: Any, ob: Any) -> None:
    """Show a camera that the user hid, alone or with a collection: Blender hides its picture."""
    ob.hide_viewport = False
    if ob.name not in scene.collection.objects and not ob.visible_get():
        scene.collection.objects.link(ob)
    for layer in scene.view_layers:
        if ob.name in layer.objects:
            ob.hide_set(False, view_layer=layer)


@contextmanager
def _new_scene(title: str) -> Iterator[Any]:
    """A new scene, taken away again with all that is in it when building it is refused."""
    scene = bpy.data.scenes.new(title)
    try:
        yield scene
    except Exception:
        built = list(scene.collection.all_objects)
        bpy.data.batch_remove([*built, *(ob.data for ob in built)])
        bpy.data.batch_remove(list(scene.collection.children))
        bpy.data.scenes.remove(scene)
        raise


def title_of(path: str | Path) -> str:
    """What a scene is called after its file: `bench.cell.json` gives `bench`."""
    return Path(path).name.removesuffix(".json").removesuffix(".cell")
