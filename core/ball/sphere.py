# SPDX-License-Identifier: GPL-3.0-or-later
"""A sphere and its outline: rays of the outline to the sphere's centre and back, in closed form."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array, Mask, frozen, positive
from ..errors import SphereNotFound
from ..intrinsics import Intrinsics


def sphere_from_rays(rays: ArrayLike, radius: float, weights: ArrayLike | None = None) -> Array:
    """The centre (3,) of the sphere of `radius` metres whose outline the unit rays (N, 3) touch.

    A ray u touches the sphere (C, r) where `u . C = sqrt(|C|^2 - r^2)`. With
    `w = C / sqrt(|C|^2 - r^2)` that is `u . w = 1`: linear in w, and `C = r w / sqrt(|w|^2 - 1)`.
    No ellipse is fitted and no lens assumed. `weights` (N,) multiply the equations.

    Raises SphereNotFound when the rays are no outline of a sphere (fewer than three, or bent the
    wrong way).
    """
    u = np.asarray(rays, dtype=float)
    if len(u) < 3:
        raise SphereNotFound(f"a sphere needs three rays of its outline, got {len(u)}")
    scale = np.ones(len(u)) if weights is None else np.asarray(weights, dtype=float)
    w = np.linalg.lstsq(u * scale[:, None], scale, rcond=None)[0]
    excess = float(w @ w) - 1.0
    # rays all in one give |w| = 1 to the last digit, and a ball beyond the moon
    if not excess > 1e-12:
        raise SphereNotFound(
            f"the {len(u)} rays bend away from a sphere (|w|^2 - 1 = {excess:.2g}): "
            "no outline of a ball"
        )
    centre: Array = w * (radius / np.sqrt(excess))
    return centre


def outline_rays(centre_camera: ArrayLike, radius: float, angles: ArrayLike) -> Array:
    """Unit rays (N, 3) that touch the sphere, at `angles` (N,) around the ray to its centre.

    Angle 0 points to the right of the picture, pi / 2 downwards. Raises SphereNotFound when the
    camera is inside the sphere.
    """
    centre = frozen(centre_camera, (3,), "centre_camera")
    distance = float(np.linalg.norm(centre))
    if distance <= radius:
        raise SphereNotFound(
            f"the camera is inside the ball: {distance:.4g} m from its centre, radius {radius:g} m"
        )
    axis = centre / distance
    right, down = _across(axis)
    phi = np.asarray(angles, dtype=float)[:, None]
    sine = radius / distance
    ring = np.cos(phi) * right + np.sin(phi) * down
    rays: Array = np.sqrt(1 - sine * sine) * axis + sine * ring
    return rays


def outline_pixels(
    intrinsics: Intrinsics, centre_camera: ArrayLike, radius: float, count: int = 180
) -> Array:
    """The sphere's outline in the picture, (count, 2) pixels; NaN where it is not imaged."""
    angles = np.arange(count) * (2 * np.pi / count)
    return intrinsics.project(outline_rays(centre_camera, radius, angles))


@dataclass(frozen=True, eq=False)
class OutlineRays:
    """Measured outline pixels (N, 2) as unit rays (N, 3), with their derivative by the pixel."""

    pixels: Array
    rays: Array
    rays_by_pixel: Array

    @staticmethod
    def of(intrinsics: Intrinsics, pixels: Array) -> OutlineRays:
        rays, by_pixel = intrinsics.rays_with_jacobian(pixels)
        return OutlineRays(pixels, rays, by_pixel)

    @staticmethod
    def around(
        intrinsics: Intrinsics, centre_camera: ArrayLike, radius: float, count: int
    ) -> OutlineRays:
        """`count` points of a sphere's own outline; NaN where it is not imaged."""
        rays = outline_rays(centre_camera, radius, np.arange(count) * (2 * np.pi / count))
        pixels, by_pixel = intrinsics.pixels_with_jacobian(rays)
        return OutlineRays(pixels, rays, by_pixel)

    def moved(self, along: Array, by_pixels: Array) -> OutlineRays:
        """The points shifted by `by_pixels` (N,) along `along` (N, 2), to first order.

        A shift of d pixels is wrong by d^2 over the focal length: 0.002 px for 1.5 px.
        """
        shift = along * by_pixels[:, None]
        rays = self.rays + np.einsum("nij,nj->ni", self.rays_by_pixel, shift)
        rays = rays / _lengths(rays)[:, None]
        return OutlineRays(self.pixels + shift, rays, self.rays_by_pixel)

    def chosen(self, which: Mask) -> OutlineRays:
        """Some of the points."""
        return OutlineRays(self.pixels[which], self.rays[which], self.rays_by_pixel[which])


@dataclass(frozen=True, eq=False)
class Tangency:
    """How far outline pixels lie outside a sphere's outline, and what moves it.

    - `residual_pixels` (N,): distance along the outline's normal, positive outside
    - `by_centre` (N, 3): its derivative by the centre, pixels per metre
    - `by_radius` (N,): its derivative by the radius, pixels per metre
    - `normals` (N, 2): unit normals of the outline in the picture, pointing outwards
    """

    residual_pixels: Array
    by_centre: Array
    by_radius: Array
    normals: Array


def tangency(outline: OutlineRays, centre_camera: ArrayLike, radius: float | Array) -> Tangency:
    """Hold measured outline pixels against the sphere at `centre_camera` (3,) with `radius`.

    The angle between ray and centre is compared with the sphere's `asin(r / |C|)`, and turned into
    pixels by the angle's own gradient there: exact for any lens, to first order in the residual.
    Centres (N, 3) and radii (N,) hold each pixel against a sphere of its own.
    """
    centre = np.asarray(centre_camera, dtype=float)
    distance = np.sqrt((centre * centre).sum(axis=-1, keepdims=True))
    axis, sine = centre / distance, np.minimum(radius / distance[..., 0], 1 - 1e-9)
    cosine = np.sqrt(1 - sine * sine)
    rays = outline.rays
    along = np.einsum("ni,...i->n" if centre.ndim == 1 else "ni,ni->n", rays, axis)
    across = rays - along[:, None] * axis
    off_axis = np.maximum(_lengths(across), 1e-12)
    outwards = across / off_axis[:, None]
    angle = np.arctan2(off_axis, along) - np.arcsin(sine)
    # the angle grows along the direction that turns the ray away from the axis
    turning = along[:, None] * outwards - off_axis[:, None] * axis
    gradient = np.einsum("ni,nij->nj", turning, outline.rays_by_pixel)
    per_pixel = 1.0 / _lengths(gradient)
    tilt = (sine / cosine)[..., None]
    by_centre = (axis * tilt - outwards) * (per_pixel[:, None] / distance)
    by_radius = -per_pixel / (distance[..., 0] * cosine)
    return Tangency(angle * per_pixel, by_centre, by_radius, gradient * per_pixel[:, None])


def centre_covariance(held: Tangency, sigma_pixels: Array, used: Mask) -> Array:
    """Of the centre (3, 3), metres, from the used points' sigmas (N,) along their normals."""
    rows = held.by_centre[used] / sigma_pixels[used, None]
    covariance: Array = np.linalg.inv(rows.T @ rows)
    return covariance


def sphere_at(
    intrinsics: Intrinsics, pixel: ArrayLike, radius_pixels: float, radius: float
) -> Array:
    """The centre (3,) of a sphere that looks about `radius_pixels` large around a pixel (2,)."""
    positive(radius_pixels, "radius_pixels")
    middle = np.asarray(pixel, dtype=float)
    rim = middle + radius_pixels * np.array([[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1]])
    rays = intrinsics.rays(rim)
    sine = np.linalg.norm(np.cross(rays[1:], rays[0]), axis=1)
    mean = float(np.nanmean(sine)) if np.isfinite(sine).any() else np.nan
    if not np.isfinite(mean) or not np.isfinite(rays[0]).all():
        raise SphereNotFound(f"the lens images no ray at pixel {middle.round(1).tolist()}")
    centre: Array = rays[0] * (radius / mean)
    return centre


def _across(axis: Array) -> tuple[Array, Array]:
    """Two unit vectors across `axis` that show as right and down in the picture."""
    x, y, z = axis.tolist()
    # down cross axis, or forward cross axis where the axis itself points down
    right = np.array([z, 0.0, -x]) if x * x + z * z > 1e-12 else np.array([-y, x, 0.0])
    right /= float(np.sqrt(right @ right))
    a, b, c = right.tolist()
    return right, np.array([y * c - z * b, z * a - x * c, x * b - y * a])


def _lengths(vectors: Array) -> Array:
    lengths: Array = np.sqrt(np.einsum("ni,ni->n", vectors, vectors))
    return lengths
