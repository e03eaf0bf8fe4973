# SPDX-License-Identifier: GPL-3.0-or-later
"""Pixels and a reference in, their points in the world with covariances and doubts out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array, frozen, positive
from ..camera import Camera
from ..errors import PickError
from ..reference import Reference, ReferenceLine, ReferencePlane
from .mapped_covariance import point_covariance_on_line, point_covariance_on_plane
from .picks import OUTSIDE_SHARE
from .reverse_mapping import (
    GRAZING_DEGREES,
    grazing_warnings,
    point_derivatives_on_line,
    points_on_line,
    points_on_plane,
)

# a pixel so far beside a line's image, in sigmas of the pick and at least in pixels, is a doubt
BESIDE_SIGMAS, BESIDE_PIXELS = 4.0, 5.0
# 1 sigma of a point beyond this share of its distance from the camera deserves a word
DOUBTFUL_SHARE = 0.05


@dataclass(frozen=True, eq=False)
class MappedPixels:
    """World points (N, 3), their covariances (N, 3, 3) in m^2, and doubts, one line each."""

    points: Array
    covariances: Array
    warnings: tuple[str, ...] = ()

    @property
    def sigmas(self) -> Array:
        """1 sigma of each point along the world axes, (N, 3) in metres."""
        return np.sqrt(np.diagonal(self.covariances, axis1=1, axis2=2))


def map_pixels(
    camera: Camera,
    reference: Reference,
    pixels: ArrayLike,
    pick_sigma_pixels: float = 1.0,
    labels: Sequence[str] = (),
) -> MappedPixels:
    """The points of a plane, or the nearest ones of a line, that pixels (N, 2) show.

    The covariances join pick noise, the camera's pose and the reference's own error.

    Raises PickError for a pixel more than half a picture outside the picture, above the plane's
    horizon, or whose ray meets the reference behind the camera; NoPose without a camera pose.
    """
    p, sigma = frozen(pixels, (None, 2), "pixels"), positive(pick_sigma_pixels, "pick_sigma_pixels")
    labels = labels or tuple(f"pixel {i}" for i in range(len(p)))
    outside = _outside(camera, p, labels)
    if isinstance(reference, ReferencePlane):
        points = points_on_plane(camera, reference, p, labels)
        covariances = point_covariance_on_plane(camera, reference, p, sigma)
        doubts = grazing_warnings(camera, reference, p, labels)
    else:
        points = points_on_line(camera, reference, p, labels)
        covariances = point_covariance_on_line(camera, reference, p, sigma)
        doubts = _line_warnings(camera, reference, p, points, sigma, labels)
    vague = _vague(camera, points, covariances, labels)
    bound = _bound(camera, reference)
    return MappedPixels(points, covariances, (*outside, *doubts, *vague, *bound))


def _bound(camera: Camera, reference: Reference) -> tuple[str, ...]:
    known = reference.by_camera is not None or reference.source is None
    if known or reference.covariance is None or camera.covariance is None:
        return ()
    return (
        f"{reference.name}: how much of its error is the camera's is not known, so each sigma is "
        "an upper bound",
    )


def _outside(camera: Camera, pixels: Array, labels: Sequence[str]) -> tuple[str, ...]:
    """A word on pixels beside the picture. Raises PickError for those far from it."""
    size = np.array([camera.intrinsics.width, camera.intrinsics.height])
    over = np.maximum(-0.5 - pixels, pixels - size + 0.5)
    told = []
    for i in np.flatnonzero((over > 0).any(axis=1)):
        u, v = pixels[i]
        what = f"{labels[i]} at ({u:.1f}, {v:.1f})"
        picture = f"the {size[0]} x {size[1]} px picture"
        if (over[i] > OUTSIDE_SHARE * size).any():
            raise PickError(f"{what} lies more than half a picture outside {picture}")
        told.append(f"{what} lies {over[i].max():.1f} px outside {picture}")
    return tuple(told)


def _line_warnings(
    camera: Camera,
    line: ReferenceLine,
    pixels: Array,
    points: Array,
    sigma: float,
    labels: Sequence[str],
) -> tuple[str, ...]:
    """Pixels beside the line's image, and rays that run nearly along the line."""
    beside = np.linalg.norm(camera.project(points) - pixels, axis=1)
    _, rays = camera.rays_world(pixels)
    sines = np.linalg.norm(np.cross(rays, line.direction), axis=1)
    degrees = np.degrees(np.arcsin(np.minimum(sines, 1.0)))
    told = [
        f"{labels[i]} lies {beside[i]:.1f} px beside the image of {line.name}; its point is the "
        "nearest one of the line"
        for i in np.flatnonzero(beside > max(BESIDE_PIXELS, BESIDE_SIGMAS * sigma))
    ]
    flat = np.flatnonzero(degrees < GRAZING_DEGREES)
    if len(flat):
        by_pixel, _ = point_derivatives_on_line(camera, line, pixels[flat])
        spread = 1e3 * np.linalg.norm(by_pixel, ord=2, axis=(1, 2))
        told += [
            f"{labels[i]} looks along {line.name} at {degrees[i]:.2f} degrees: one pixel there is "
            f"{mm:.0f} mm"
            for i, mm in zip(flat, spread, strict=True)
        ]
    return tuple(told)


def _vague(
    camera: Camera, points: Array, covariances: Array, labels: Sequence[str]
) -> tuple[str, ...]:
    distances = np.linalg.norm(points - camera.centre_world, axis=1)
    sigmas = np.sqrt(np.linalg.eigvalsh(covariances)[:, -1])
    return tuple(
        f"{labels[i]}: its point is known to {1e3 * sigmas[i]:.0f} mm, {distances[i]:.3g} m from "
        "the camera"
        for i in np.flatnonzero(sigmas > DOUBTFUL_SHARE * distances)
    )
