# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a ball should show: an approximate camera pose and a world position in, a window out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array, finite, frozen, positive
from ..camera import Camera
from ..errors import InvalidValue, SphereNotFound
from ..pose import point_jacobian
from .candidates import Window
from .hints import SMALLEST_PIXELS
from .sphere import outline_pixels

SIGMAS = 3.0
# what a window leaves around the outline, as a share of its radius and in pixels
MARGIN_SHARE, MARGIN_PIXELS = 0.3, 6.0
# a depth known worse than this tells nothing of the size
ROUGH_DEPTH = 0.3


@dataclass(frozen=True, eq=False)
class Prediction:
    """Where a ball should be found.

    - `centre_camera` (3,) and `reach`: metres by which the ball may be elsewhere
    - `window` (x, y, width, height) in pixels that holds all of its outline
    - `radius_pixels` of the outline, None when the depth is too uncertain to tell
    """

    centre_camera: Array
    reach: float
    window: Window
    radius_pixels: float | None

    def aside(self, centre_camera: Array) -> float:
        """How far a centre (3,) lies from here across the line of sight, metres."""
        axis = self.centre_camera / np.linalg.norm(self.centre_camera)
        off = centre_camera - self.centre_camera
        return float(np.linalg.norm(off - (off @ axis) * axis))

    def doubts(self, centre_camera: Array) -> tuple[str, ...]:
        """What to tell of a ball (3,) found farther from here than was said."""
        aside = self.aside(centre_camera)
        if aside <= self.reach:
            return ()
        return (
            f"the ball is {1e3 * aside:.0f} mm aside of where the pose puts it, "
            f"{1e3 * self.reach:.0f} mm were expected at most",
        )


def predicted(camera: Camera, centre_world: ArrayLike, radius: float, within: float) -> Prediction:
    """Where the ball at a world position (3,) shows, by a camera whose pose is nearly known.

    `within` metres is how far the ball may be from there; three sigmas of the pose's covariance
    come on top, where it has one. Raises NoPose without a pose, SphereNotFound when the ball lies
    behind the camera or outside the picture, InvalidValue for impossible numbers.
    """
    radius, within = positive(radius, "radius"), finite(within, "within")
    if within < 0:
        raise InvalidValue(f"within: must not be below zero, got {within:g} m")
    centre = camera.pose.apply(frozen(centre_world, (3,), "centre_world"))
    if centre[2] <= radius:
        raise SphereNotFound(
            f"by the pose the ball's centre has z = {centre[2]:.2f} m in the camera's frame, not "
            "before the camera; is the pose camera_from_world, and is the position in metres?"
        )
    reach = within + SIGMAS * _sigma(camera, centre)
    outline = outline_pixels(camera.intrinsics, centre, radius, 72)
    outline = outline[np.isfinite(outline).all(axis=1)]
    if len(outline) < 12:
        raise SphereNotFound("by the pose the ball lies outside what the lens images")
    low, high = outline.min(axis=0), outline.max(axis=0)
    size = float((high - low).mean()) / 2
    margin = (MARGIN_SHARE + reach / radius) * size + MARGIN_PIXELS
    x, y = (low - margin).tolist()
    width, height = (high - low + 2 * margin).tolist()
    _check_seen(camera, (x, y, width, height), (low + high) / 2)
    known = reach < ROUGH_DEPTH * float(np.linalg.norm(centre)) and size >= SMALLEST_PIXELS
    return Prediction(centre, reach, (x, y, width, height), size if known else None)


def _sigma(camera: Camera, centre_camera: Array) -> float:
    """The largest standard deviation of a point across the line of sight, from the pose's."""
    if camera.covariance is None:
        return 0.0
    jacobian = point_jacobian(centre_camera)
    covariance = jacobian @ camera.covariance @ jacobian.T
    axis = centre_camera / np.linalg.norm(centre_camera)
    across = np.eye(3) - np.outer(axis, axis)
    return float(np.sqrt(max(0.0, np.linalg.eigvalsh(across @ covariance @ across)[-1])))


def _check_seen(camera: Camera, window: Window, middle: Array) -> None:
    x, y, width, height = window
    lens = camera.intrinsics
    if x + width < 8 or y + height < 8 or x > lens.width - 8 or y > lens.height - 8:
        raise SphereNotFound(
            f"by the pose the ball shows at pixel ({middle[0]:.0f}, {middle[1]:.0f}), outside the "
            f"{lens.width} x {lens.height} picture; state a larger uncertainty or a better pose"
        )
