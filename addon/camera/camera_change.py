# SPDX-License-Identifier: GPL-3.0-or-later
"""Another camera for an open cell: what was worked out with the old one goes, or is marked old."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from ...core.camera import Camera
from ...core.cell import Cell
from ...core.errors import InvalidValue
from ..cell.cell_scene import put_camera, show_picture
from ..cell.document import read_scene, write_scene

SOLVED_BEFORE = "The camera changed since the objects were solved: press Solve All."


def with_other_camera(cell: Cell, camera: Camera) -> Cell | None:
    """The cell with another camera, None where it has nothing to gain from it.

    The pose was found through the old lens, and goes with it unless the new camera brings its own.
    Raises InvalidValue for a camera of another size than the cell's pictures.
    """
    _refuse_other_size(cell, camera)
    return None if same_camera(cell.camera, camera) else _with_camera(cell, camera)


def change_camera(scene: Any, camera: Camera, plate: Any) -> str:
    """Let the scene's cell have another camera; what came of the old one in words.

    Besides the pose the outlines go. `plate` is the shown picture, undistorted anew, None without.
    Objects stay as they are, marked as old where they have picks to be solved from.
    """
    cell = read_scene(scene)
    posed = cell.camera.camera_from_world is not None
    write_scene(scene, _with_camera(cell, camera))
    put_camera(scene)
    if plate is not None:
        show_picture(scene, plate)
    mark_objects(scene, cell)
    inner = camera.intrinsics
    told = f"Focal length {inner.fx:.1f}, {inner.fy:.1f} px"
    if camera.camera_from_world is not None:
        return f"{told}; the file brought the camera's pose"
    return f"{told}; the old pose is gone: calibrate again" if posed else told


def mark_objects(scene: Any, cell: Cell) -> None:
    """Say that objects with picks were solved for a camera which the scene has no longer."""
    if any(thing.picks for thing in cell.objects):
        scene.monocell_cell.outdated = SOLVED_BEFORE


def same_camera(one: Camera, other: Camera) -> bool:
    """Whether a cell of one camera has nothing to gain from the other, which may have no pose."""
    from ...core.document.entries import camera_entry

    asked = camera_entry(other)
    return {name: value for name, value in camera_entry(one).items() if name in asked} == asked


def _with_camera(cell: Cell, camera: Camera) -> Cell:
    mount = cell.mount
    if mount is None:
        return cell.with_camera(camera)
    # where it sits on the flange was found through the old lens, too
    bare = replace(mount, camera_from_flange=None, covariance=None)
    return cell.with_camera(Camera(camera.intrinsics)).with_mount(bare)


def _refuse_other_size(cell: Cell, camera: Camera) -> None:
    old, new = cell.camera.intrinsics, camera.intrinsics
    if (old.width, old.height) != (new.width, new.height):
        raise InvalidValue(
            f"the camera is one of {new.width} x {new.height} px, the cell's pictures have "
            f"{old.width} x {old.height}: give that of the same lens at their size"
        )
