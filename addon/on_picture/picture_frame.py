# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the camera's picture lies in a region of the viewport, and region points to pixels."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ...core.arrays import Array
from ...core.intrinsics import Intrinsics

# Blender's own limits of the camera view's zoom
LEAST_ZOOM, MOST_ZOOM = -30.0, 600.0
# what is left free round a picture that is fitted into the view
MARGIN_SHARE = 0.03
SIDE_SAMPLES = 9


@dataclass(frozen=True)
class PictureFrame:
    """The picture's left, bottom, right and top edge in region pixels, y up, edges at integers.

    Pixels of the view are undistorted ones; those of a document are as the picture came. Both have
    the centre of the top-left pixel at (0, 0), u right, v down.
    """

    left: float
    bottom: float
    right: float
    top: float
    intrinsics: Intrinsics

    def view_pixel(self, x: float, y: float) -> Array:
        """A region point to the undistorted pixel (2,) there."""
        u = (x - self.left) / (self.right - self.left) * self.intrinsics.width - 0.5
        v = (self.top - y) / (self.top - self.bottom) * self.intrinsics.height - 0.5
        return np.array([u, v])

    def picture_pixel(self, x: float, y: float) -> Array | None:
        """A region point to the pixel (2,) of the picture as it came; None where it shows none."""
        pinhole = self.intrinsics.undistorted()
        pixel = self.intrinsics.project(pinhole.rays(self.view_pixel(x, y)[None]))[0]
        return pixel if np.isfinite(pixel).all() else None

    def view_pixels(self, picture_pixels: ArrayLike) -> Array:
        """Pixels (N, 2) of the picture as it came to undistorted ones of the view."""
        rays = self.intrinsics.rays(np.asarray(picture_pixels, dtype=float))
        return self.intrinsics.undistorted().project(rays)

    def region_points(self, view_pixels: ArrayLike) -> Array:
        """Undistorted pixels (N, 2) to region points (N, 2)."""
        pixels = np.asarray(view_pixels, dtype=float)
        size = np.array([self.intrinsics.width, self.intrinsics.height])
        share = (pixels + 0.5) / size
        return np.stack(
            [
                self.left + share[:, 0] * (self.right - self.left),
                self.top - share[:, 1] * (self.top - self.bottom),
            ],
            axis=1,
        )

    def contains(self, x: float, y: float) -> bool:
        """Whether a region point lies on the picture."""
        return self.left <= x <= self.right and self.bottom <= y <= self.top


def picture_frame(scene: Any, region: Any, view: Any, intrinsics: Intrinsics) -> PictureFrame:
    """The frame of the scene's camera in a region that looks through it.

    From the zoom and offset of its `view`, as Blender itself draws it: in double precision, where
    projecting the frame's corners through float32 matrices would lose a tenth of a pixel. The
    camera's sensor fit is HORIZONTAL, as `scene.blender_camera` sets it.
    """
    zoom = _zoom_factor(view.view_camera_zoom)
    width = region.width * zoom
    height = width * _height_share(scene.render)
    x = region.width / 2 - view.view_camera_offset[0] * 2 * region.width * zoom
    y = region.height / 2 - view.view_camera_offset[1] * 2 * region.height * zoom
    return PictureFrame(x - width / 2, y - height / 2, x + width / 2, y + height / 2, intrinsics)


def fit_picture(
    scene: Any, region: Any, view: Any, free: tuple[float, float, float, float]
) -> None:
    """Zoom and pan a camera view so that the picture fills `free`: left, bottom, right, top."""
    left, bottom, right, top = free
    share = 1.0 - 2 * MARGIN_SHARE
    width = share * min(right - left, (top - bottom) / _height_share(scene.render))
    zoom = (2.0 * math.sqrt(max(width, 1.0) / region.width) - math.sqrt(2.0)) * 50.0
    view.view_camera_zoom = min(max(zoom, LEAST_ZOOM), MOST_ZOOM)
    factor = _zoom_factor(view.view_camera_zoom)
    view.view_camera_offset = (
        (region.width - (left + right)) / (4 * region.width * factor),
        (region.height - (bottom + top)) / (4 * region.height * factor),
    )


def window_of(
    frame: PictureFrame, start: tuple[float, float], end: tuple[float, float]
) -> tuple[float, float, float, float]:
    """The window (x, y, width, height) of the picture as it came round a rectangle in the region.

    A straight side of the view is bent in the picture: its whole length counts.
    """
    (x0, y0), (x1, y1) = start, end
    along = np.linspace(0.0, 1.0, SIDE_SAMPLES)
    across, up = x0 + along * (x1 - x0), y0 + along * (y1 - y0)
    sides = [(x, y) for y in (y0, y1) for x in across] + [(x, y) for x in (x0, x1) for y in up]
    found = [frame.picture_pixel(x, y) for x, y in sides]
    pixels = np.array([pixel for pixel in found if pixel is not None]).reshape(-1, 2)
    most = np.array([frame.intrinsics.width, frame.intrinsics.height]) - 0.5
    clipped = np.clip(pixels, -0.5, most) if len(pixels) else np.zeros((1, 2))
    (left, top), (width, height) = clipped.min(axis=0), np.ptp(clipped, axis=0)
    return float(left), float(top), float(width), float(height)


def free_part(area: Any, region: Any) -> tuple[float, float, float, float]:
    """The part of a region that no sidebar, toolbar or header covers: left, bottom, right, top."""
    left, bottom, right, top = 0.0, 0.0, float(region.width), float(region.height)
    for other in area.regions:
        if other.type == "WINDOW" or other.width <= 1 or other.height <= 1:
            continue
        if other.alignment == "RIGHT":
            right = min(right, float(other.x - region.x))
        elif other.alignment == "LEFT":
            left = max(left, float(other.x + other.width - region.x))
        elif other.alignment == "TOP":
            top = min(top, float(other.y - region.y))
        elif other.alignment == "BOTTOM":
            bottom = max(bottom, float(other.y + other.height - region.y))
    return left, bottom, right, top


def _zoom_factor(view_camera_zoom: float) -> float:
    return float((math.sqrt(2.0) + view_camera_zoom / 50.0) ** 2 / 4.0)


def _height_share(render: Any) -> float:
    """The frame's height in units of its width."""
    width = render.resolution_x * render.pixel_aspect_x
    return float(render.resolution_y * render.pixel_aspect_y / width)
