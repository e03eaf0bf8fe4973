# SPDX-License-Identifier: GPL-3.0-or-later
"""Pixels and a reference in, points in the world out, with the derivatives of each.

Reverse mapping of the paper (section 4, eq. 16-22): a pixel is a ray, and the known plane or line
tells how far along it the point lies. Rays are exact for every distortion model.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array, frozen
from ..camera import Camera
from ..errors import InvalidValue, PickError
from ..intrinsics import BLOCK
from ..reference import ReferenceLine, ReferencePlane
from ..rotation import hat

# a ray this flat to its plane turns a pixel into decimetres
GRAZING_DEGREES = 2.0
HORIZON_STEPS = 12


def points_on_plane(
    camera: Camera, plane: ReferencePlane, pixels: ArrayLike, labels: Sequence[str] = ()
) -> Array:
    """World points (N, 3) of the plane that pixels (N, 2) show (paper eq. 18-20).

    `p = o + d n.(p0 - o) / n.d` for a ray from o along d. `labels` name the pixels in errors.

    Raises PickError for the first pixel whose ray the lens does not image, or that lies above the
    plane's horizon, with its distance from the horizon.
    """
    checked = frozen(pixels, (None, 2), "pixels")
    points = points_on_plane_or_nan(camera, plane, checked)
    lost = np.flatnonzero(np.isnan(points[:, 0]))
    if len(lost):
        i = int(lost[0])
        raise PickError(_why_no_point(camera, plane, checked[i], _label(labels, i)))
    return points


def points_on_plane_or_nan(camera: Camera, plane: ReferencePlane, pixels: ArrayLike) -> Array:
    """`points_on_plane` in bulk: NaN where a pixel shows nothing of the plane."""
    p = _as_pixels(pixels)
    world_from_camera = camera.pose.inverse()
    normal_camera = camera.pose.rotate(plane.normal)
    height = float(plane.normal @ (plane.point - world_from_camera.translation))
    points = np.empty((len(p), 3))
    # in blocks that stay in the cache, as the rays themselves are mapped
    for start in range(0, len(p), BLOCK):
        part = slice(start, start + BLOCK)
        rays = camera.intrinsics.rays(p[part])
        with np.errstate(divide="ignore", invalid="ignore"):
            depth = height / (rays @ normal_camera)
        depth[~((depth > 0) & np.isfinite(depth))] = np.nan
        rays *= depth[:, None]
        np.matmul(rays, world_from_camera.rotation.T, out=points[part])
        points[part] += world_from_camera.translation
    return points


def points_on_line(
    camera: Camera, line: ReferenceLine, pixels: ArrayLike, labels: Sequence[str] = ()
) -> Array:
    """World points (N, 3) of the line nearest to the rays of pixels (N, 2) (paper eq. 19, 22).

    For a pixel on the line's image this is the point it shows; for one beside it the point whose
    direction from the camera is nearest, to first order.

    Raises PickError for the first pixel whose ray is not imaged, runs along the line, or passes it
    nearest behind the camera.
    """
    checked = frozen(pixels, (None, 2), "pixels")
    points = points_on_line_or_nan(camera, line, checked)
    lost = np.flatnonzero(np.isnan(points[:, 0]))
    if len(lost):
        i = int(lost[0])
        raise PickError(_why_not_on_line(camera, line, checked[i], _label(labels, i)))
    return points


def points_on_line_or_nan(camera: Camera, line: ReferenceLine, pixels: ArrayLike) -> Array:
    """`points_on_line` in bulk: NaN where a pixel has no nearest point in front of the camera."""
    origin, rays = camera.rays_world(_as_pixels(pixels))
    along, depth = _nearest(origin, rays, line)
    along[~(depth > 0)] = np.nan
    points: Array = line.point + along[:, None] * line.direction
    return points


def point_derivatives_on_plane(
    camera: Camera, plane: ReferencePlane, pixels: ArrayLike
) -> tuple[Array, Array]:
    """How `points_on_plane` move with the pixels, (N, 3, 2), and the camera's twist, (N, 3, 6).

    A moved ray slides its point along itself back onto the plane: `I - d n^T / n.d` times the
    point's own motion. Metres per pixel, and per radian and metre of `Pose.perturbed`.
    """
    p = frozen(pixels, (None, 2), "pixels")
    points = points_on_plane(camera, plane, p)
    points_camera = camera.pose.apply(points)
    distance = np.linalg.norm(points_camera, axis=1)
    rays_camera, by_pixel = camera.intrinsics.rays_with_jacobian(p)
    normal = camera.pose.rotate(plane.normal)
    slide = np.eye(3) - rays_camera[:, :, None] * normal / (rays_camera @ normal)[:, None, None]
    world_slide = camera.pose.rotation.T @ slide
    # seen from a camera turned by w and moved by v the same ray starts at -v, turned by -w
    twist = np.concatenate([hat(points_camera), np.broadcast_to(-np.eye(3), (len(p), 3, 3))], 2)
    return world_slide @ (by_pixel * distance[:, None, None]), world_slide @ twist


def point_derivatives_on_line(
    camera: Camera, line: ReferenceLine, pixels: ArrayLike
) -> tuple[Array, Array]:
    """How `points_on_line` move with the pixels, (N, 3, 2), and the camera's twist, (N, 3, 6)."""
    p = frozen(pixels, (None, 2), "pixels")
    points = points_on_line(camera, line, p)
    world_from_camera = camera.pose.rotation.T
    origin, rays = camera.rays_world(p)
    _, depth = _nearest(origin, rays, line)
    rays_camera, by_pixel = camera.intrinsics.rays_with_jacobian(p)
    # both conditions, gap.k = 0 and gap.d = 0, are differentiated and solved for the line's
    # parameter; the ray's turning also enters through the gap itself
    cosine = (rays @ line.direction)[:, None]
    gap = points - origin - depth[:, None] * rays
    by_move = line.direction - cosine * rays
    by_turn = (depth[:, None] * by_move + cosine * gap) / (1 - cosine**2)
    by_move = by_move / (1 - cosine**2)
    turned = world_from_camera @ np.concatenate([by_pixel, hat(rays_camera)], 2)
    along = (by_turn[:, None, :] @ turned)[:, 0]
    moved = -(by_move @ world_from_camera)
    whole = line.direction[:, None] * np.concatenate([along, moved], 1)[:, None, :]
    return whole[:, :, :2], whole[:, :, 2:]


def point_derivatives_by_plane(camera: Camera, plane: ReferencePlane, pixels: ArrayLike) -> Array:
    """How `points_on_plane` follow the plane's own motion, (N, 3, 6).

    The motion is that of its covariance: rotation vector w about its point, and motion v of it. At
    a point p of it the plane rises by `n . (v + w x (p - point))`, which the ray meets elsewhere.
    """
    p = frozen(pixels, (None, 2), "pixels")
    points = points_on_plane(camera, plane, p)
    _, rays = camera.rays_world(p)
    turned = np.cross(points - plane.point, plane.normal)
    rises = np.concatenate([turned, np.broadcast_to(plane.normal, turned.shape)], axis=1)
    derivatives: Array = (rays / (rays @ plane.normal)[:, None])[:, :, None] * rises[:, None, :]
    return derivatives


def point_derivatives_by_line(camera: Camera, line: ReferenceLine, pixels: ArrayLike) -> Array:
    """How `points_on_line` follow the line's own motion, (N, 3, 6), as for the plane."""
    p = frozen(pixels, (None, 2), "pixels")
    points = points_on_line(camera, line, p)
    origin, rays = camera.rays_world(p)
    _, depth = _nearest(origin, rays, line)
    k, cosine = line.direction, (rays @ line.direction)[:, None]
    gap = points - origin - depth[:, None] * rays
    # a point of the line is carried by v + w x (p - point), then slides along to stay the nearest
    arms = points - line.point
    carried = np.concatenate([-hat(arms), np.broadcast_to(np.eye(3), (len(p), 3, 3))], 2)
    slide = ((cosine * rays - k)[:, None, :] @ carried)[:, 0]
    slide[:, :3] -= np.cross(k, gap)
    derivatives: Array = carried + k[:, None] * (slide / (1 - cosine**2))[:, None, :]
    return derivatives


def grazing_warnings(
    camera: Camera, plane: ReferencePlane, pixels: ArrayLike, labels: Sequence[str] = ()
) -> tuple[str, ...]:
    """One line for every pixel whose ray meets the plane at less than two degrees."""
    p = frozen(pixels, (None, 2), "pixels")
    sines = np.abs(camera.intrinsics.rays(p) @ camera.pose.rotate(plane.normal))
    degrees = np.degrees(np.arcsin(np.minimum(sines, 1.0)))
    flat = np.flatnonzero(degrees < GRAZING_DEGREES)
    if not len(flat):
        return ()
    by_pixel, _ = point_derivatives_on_plane(camera, plane, p[flat])
    spread = 1e3 * np.linalg.norm(by_pixel, ord=2, axis=(1, 2))
    return tuple(
        f"{_label(labels, int(i))} at {_at(p[i])} grazes {plane.name} at {degrees[i]:.2f} degrees: "
        f"one pixel there is {mm:.0f} mm"
        for i, mm in zip(flat, spread, strict=True)
    )


def _nearest(origin: Array, rays: Array, line: ReferenceLine) -> tuple[Array, Array]:
    """Parameters of the nearest points on the line and on each ray; NaN where they are parallel."""
    gap = line.point - origin
    cosine = rays @ line.direction
    squared_sine = 1 - cosine * cosine
    squared_sine[squared_sine < 1e-14] = np.nan
    along = (cosine * (rays @ gap) - line.direction @ gap) / squared_sine
    return along, rays @ gap + along * cosine


def _why_no_point(camera: Camera, plane: ReferencePlane, pixel: Array, label: str) -> str:
    ray = camera.intrinsics.rays(pixel[None])[0]
    what = f"{label} at {_at(pixel)}"
    if np.isnan(ray[0]):
        return f"{what} is past the edge of what this lens images; pick nearer to the centre"
    height = float(plane.normal @ (plane.point - camera.centre_world))
    if abs(height) < 1e-12:
        return f"{what} has no point: the camera's centre lies in {plane.name} itself"
    sine = abs(float(ray @ camera.pose.rotate(plane.normal)))
    degrees = f"{np.degrees(np.arcsin(min(sine, 1.0))):.1f} degrees"
    walked = _pixels_to_horizon(camera, plane, pixel)
    how_far = degrees if walked is None else f"{walked:.1f} px ({degrees})"
    return f"{what} lies {how_far} above the horizon of {plane.name}; pick a point on {plane.name}"


def _pixels_to_horizon(camera: Camera, plane: ReferencePlane, pixel: Array) -> float | None:
    """How far the pixel is from the plane's vanishing line, by Newton's steps across it."""
    normal, p = camera.pose.rotate(plane.normal), pixel.copy()
    for _ in range(HORIZON_STEPS):
        rays, by_pixel = camera.intrinsics.rays_with_jacobian(p[None])
        gradient = normal @ by_pixel[0]
        p = p - gradient * float(rays[0] @ normal) / float(gradient @ gradient)
    walked = float(np.linalg.norm(p - pixel))
    return walked if np.isfinite(walked) else None


def _why_not_on_line(camera: Camera, line: ReferenceLine, pixel: Array, label: str) -> str:
    origin, rays = camera.rays_world(pixel[None])
    what = f"{label} at {_at(pixel)}"
    if np.isnan(rays[0, 0]):
        return f"{what} is past the edge of what this lens images; pick nearer to the centre"
    _, depth = _nearest(origin, rays, line)
    if np.isnan(depth[0]):
        return f"{what} looks along {line.name}: pick away from its vanishing point"
    return (
        f"{what} is nearest to {line.name} {-depth[0]:.3g} m behind the camera; "
        "pick on the line's image"
    )


def _as_pixels(pixels: ArrayLike) -> Array:
    p = np.asarray(pixels, dtype=float)
    if p.ndim != 2 or p.shape[1] != 2:
        raise InvalidValue(f"pixels: expected shape (N, 2), got {p.shape}")
    return p


def _label(labels: Sequence[str], i: int) -> str:
    return labels[i] if len(labels) else f"pixel {i}"


def _at(pixel: Array) -> str:
    return f"({pixel[0]:.1f}, {pixel[1]:.1f})"
