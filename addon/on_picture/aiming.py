# SPDX-License-Identifier: GPL-3.0-or-later
"""What a click would mean: a pixel under the cursor in, the corner or edge that it snaps to out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...core.arrays import Array
from ...core.camera import Camera
from ...core.errors import MonocellError
from ...core.picture.pictures import Picture
from ...core.picture.snapping import snapped
from ...core.picture.wireframe import wireframe
from ...core.primitives import Primitive
from ..cell.document import bare_cell, read_scene
from .camera_view import hidden_names
from .shown_picture import shown_picture

# pixels of the picture
FARTHEST_SNAP = 4.0


@dataclass(frozen=True, eq=False)
class Aim:
    """The pixel (2,) of the picture as it came that a click means.

    `told` says what it snapped to, empty where it is the cursor's own.
    """

    pixel: Array
    told: str


@dataclass(frozen=True, eq=False)
class Aiming:
    """What there is to snap to: the picture, None where it can't be read, and corners (N, 2)."""

    picture: Picture | None
    corners: Array

    @staticmethod
    def of(scene: Any, space: Any = None) -> Aiming:
        """The picture that the scene shows, and the corners of the objects that `space` shows."""
        cell, hidden = bare_cell(scene), hidden_names(scene, space)
        seen = [thing for thing in _objects(scene) if thing.name not in hidden]
        return Aiming(shown_picture(scene), modelled_corners(cell.camera, seen))

    def aimed(self, pixel: Array, radius: float) -> Aim:
        """A picture's corner within `radius` pixels, else a modelled one, else an edge.

        In the picture it never looks farther than a hand is off: seen from afar, another corner may
        lie within a few pixels of the screen.
        """
        radius = min(radius, FARTHEST_SNAP)
        found = None if self.picture is None else snapped(self.picture, pixel, radius)
        if found is not None and found.kind == "corner":
            return Aim(found.pixel, "corner")
        distances = np.linalg.norm(self.corners - pixel, axis=1)
        if len(distances) and distances.min() <= radius:
            return Aim(self.corners[int(distances.argmin())], "modelled corner")
        return Aim(pixel, "") if found is None else Aim(found.pixel, "edge")


def modelled_corners(camera: Camera, things: Sequence[Primitive]) -> Array:
    """Ends of the visible lines of objects, (N, 2) pixels of the picture as it came."""
    if camera.camera_from_world is None:
        return np.zeros((0, 2))
    pinhole = replace(camera, intrinsics=camera.intrinsics.undistorted())
    lines = [line for thing in things for line in wireframe(thing, pinhole) if line.visible]
    # a closed rim has no corner
    ends = [
        line.pixels[[0, -1]] for line in lines if np.ptp(line.pixels[[0, -1]], axis=0).max() > 1
    ]
    if not ends:
        return np.zeros((0, 2))
    rays = pinhole.intrinsics.rays(np.concatenate(ends))
    pixels = camera.intrinsics.project(rays)
    return pixels[np.isfinite(pixels).all(axis=1)]


def _objects(scene: Any) -> Sequence[Primitive]:
    try:
        return read_scene(scene).objects
    except MonocellError:
        # what is wrong with an object is told in the panel, and does not hinder a pick
        return ()
