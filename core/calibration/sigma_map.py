# SPDX-License-Identifier: GPL-3.0-or-later
"""How well the points of a surface are known: a calibrated camera and a plane in, 1 sigma out.

What a pixel shows of the plane is found by reverse mapping (paper section 4); the pose's covariance
makes its error. The error of the pick itself is not in it: that is the picker's, not the camera's.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array
from ..camera import Camera
from ..errors import NoPose
from ..modelling.reverse_mapping import GRAZING_DEGREES
from ..reference import ReferencePlane
from ..rotation import hat

# nodes along the longer side of the picture: between them the field is as good as linear
NODES = 240
BLOCK = 16384


@dataclass(frozen=True, eq=False)
class SigmaField:
    """1 sigma of the plane's points, in metres, at the nodes of a grid over the whole picture.

    - `columns` (C,) and `rows` (R,): the nodes' u and v, the picture's rim included
    - `scaled` (R, C): sigma times the squared sine of the ray to the plane; `sines` (R, C): that
      sine, negative above the horizon. Both pass the horizon smoothly, where sigma itself is
      infinite, so they may be interpolated. NaN where the lens images nothing.
    """

    plane: ReferencePlane
    columns: Array
    rows: Array
    scaled: Array
    sines: Array

    @cached_property
    def sigma(self) -> Array:
        """Sigma at the nodes (R, C); NaN above the horizon and where rays only graze the plane."""
        return sigma_from(self.scaled, self.sines)


def sigma_from(scaled: Array, sines: Array) -> Array:
    """Sigma from the two smooth fields; NaN at less than two degrees to the plane."""
    seen = sines > np.sin(np.radians(GRAZING_DEGREES))
    return np.where(seen, scaled / np.where(seen, sines, 1.0) ** 2, np.nan)


def sigma_field(camera: Camera, plane: ReferencePlane) -> SigmaField:
    """The field over a camera's picture. Raises NoPose without pose or covariance."""
    inner = camera.intrinsics
    longest = max(inner.width, inner.height)
    counts = [max(2, round(NODES * size / longest)) for size in (inner.width, inner.height)]
    columns = np.linspace(-0.5, inner.width - 0.5, counts[0])
    rows = np.linspace(-0.5, inner.height - 0.5, counts[1])
    u, v = np.meshgrid(columns, rows)
    scaled, sines = _smooth_parts(camera, plane, np.stack([u.ravel(), v.ravel()], axis=1))
    return SigmaField(plane, columns, rows, scaled.reshape(u.shape), sines.reshape(u.shape))


def surface_sigma(camera: Camera, plane: ReferencePlane, pixels: ArrayLike) -> Array:
    """1 sigma (N,) in metres of the plane's points that pixels (N, 2) show, over all directions.

    The root of the trace of each point's covariance. NaN where a pixel shows nothing of the plane
    or its ray only grazes it. Raises NoPose without pose or covariance.
    """
    return sigma_from(*_smooth_parts(camera, plane, np.asarray(pixels, dtype=float)))


def plane_derivatives(camera: Camera, plane: ReferencePlane, rays_camera: Array) -> Array:
    """How the plane's points on unit rays (N, 3) move with the camera's twist, (N, 3, 6).

    In the camera's axes, times the squared sine `n.d` of the ray to the plane: a polynomial of the
    ray, `(n.d - d n^T) [h hat(d), -n.d]` for the camera at height h.
    """
    normal, height = _seen_from(camera, plane)
    sines = rays_camera @ normal
    identity = np.eye(3)
    slide = sines[:, None, None] * identity - rays_camera[:, :, None] * normal
    moved = np.broadcast_to(-identity, (len(sines), 3, 3)) * sines[:, None, None]
    derivatives: Array = slide @ np.concatenate([height * hat(rays_camera), moved], axis=2)
    return derivatives


def _smooth_parts(camera: Camera, plane: ReferencePlane, pixels: Array) -> tuple[Array, Array]:
    if camera.covariance is None:
        raise NoPose("the camera's pose has no covariance, so no point's error follows from it")
    normal, height = _seen_from(camera, plane)
    scaled, sines = np.empty(len(pixels)), np.empty(len(pixels))
    for start in range(0, len(pixels), BLOCK):
        part = slice(start, start + BLOCK)
        rays = camera.intrinsics.rays(pixels[part])
        by_twist = plane_derivatives(camera, plane, rays)
        trace = np.einsum("nij,jk,nik->n", by_twist, camera.covariance, by_twist, optimize=True)
        scaled[part] = np.sqrt(np.maximum(trace, 0.0))
        # towards the plane, from whichever side the camera looks at it; from within it, never
        sines[part] = np.sign(height) * (rays @ normal)
    return scaled, sines


def _seen_from(camera: Camera, plane: ReferencePlane) -> tuple[Array, float]:
    """The plane's normal in the camera frame, and how far along it the plane lies."""
    height = float(plane.normal @ (plane.point - camera.centre_world))
    return camera.pose.rotate(plane.normal), height
