# SPDX-License-Identifier: GPL-3.0-or-later
"""Pixels mapped onto a reference in, the covariance of each point out.

Three things err: the pick, the camera's pose, and the reference itself. A reference that was made
through the same camera errs with it: a camera that stands higher than thought sees a picked table
top too high *and* maps pixels onto it too far. Hence the part of the reference's error that it
shares with the camera (`by_camera`) is added to the camera's own before either is squared.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array
from ..camera import Camera
from ..covariance import bound_of_sum, propagated, remainder
from ..reference import Reference, ReferenceLine, ReferencePlane
from .reverse_mapping import (
    point_derivatives_by_line,
    point_derivatives_by_plane,
    point_derivatives_on_line,
    point_derivatives_on_plane,
)


def point_covariance_on_plane(
    camera: Camera, plane: ReferencePlane, pixels: ArrayLike, pixel_sigma: float = 1.0
) -> Array:
    """Covariances (N, 3, 3) in m^2 of `points_on_plane`: pick noise, camera pose and plane.

    `pixel_sigma` is 1 sigma of a pick in u and v. `camera.covariance` and `plane.covariance` count
    where they are stated. Of a plane with a source whose `by_camera` is not known it is an upper
    bound: the camera's and the plane's sigmas are added, not their squares.
    """
    by_pixel, by_twist = point_derivatives_on_plane(camera, plane, pixels)
    picked = pixel_sigma**2 * by_pixel @ np.swapaxes(by_pixel, 1, 2)
    if plane.covariance is None:
        return _with_camera(picked, by_twist, camera)
    by_plane = point_derivatives_by_plane(camera, plane, pixels)
    return picked + _together(by_twist, by_plane, camera, plane, plane.covariance)


def point_covariance_on_line(
    camera: Camera, line: ReferenceLine, pixels: ArrayLike, pixel_sigma: float = 1.0
) -> Array:
    """Covariances (N, 3, 3) in m^2 of `points_on_line`, as for the plane."""
    by_pixel, by_twist = point_derivatives_on_line(camera, line, pixels)
    picked = pixel_sigma**2 * by_pixel @ np.swapaxes(by_pixel, 1, 2)
    if line.covariance is None:
        return _with_camera(picked, by_twist, camera)
    by_line = point_derivatives_by_line(camera, line, pixels)
    return picked + _together(by_twist, by_line, camera, line, line.covariance)


def _with_camera(picked: Array, by_twist: Array, camera: Camera) -> Array:
    if camera.covariance is None:
        return picked
    return picked + propagated(by_twist, camera.covariance)


def _together(
    by_twist: Array, by_reference: Array, camera: Camera, reference: Reference, covariance: Array
) -> Array:
    """What the camera's and the reference's error make of the points, (N, 3, 3)."""
    if camera.covariance is None:
        return propagated(by_reference, covariance)
    shared = reference.by_camera
    if shared is None:
        parts = [propagated(by_twist, camera.covariance), propagated(by_reference, covariance)]
        # what was given in the world knows nothing of the camera
        return parts[0] + parts[1] if reference.source is None else bound_of_sum(parts)
    own = remainder(covariance, propagated(shared, camera.covariance))
    whole = by_twist + by_reference @ shared
    return propagated(whole, camera.covariance) + propagated(by_reference, own)
