# SPDX-License-Identifier: GPL-3.0-or-later
"""Depth and colours per pixel to light: a soft sun with shadows, a sky, and darkness in corners.

PyBullet's own renderer lights flatly; from its depth alone all of this can be had.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from ...core.arrays import Array, Mask
from .stage import Layer, pixel_rays

SUN = np.array([2.0, 1.92, 1.78])
SKY, GROUND = np.array([0.44, 0.49, 0.56]), np.array([0.24, 0.22, 0.2])
BACKDROP_LOW, BACKDROP_HIGH = np.array([0.8, 0.82, 0.84]), np.array([0.5, 0.58, 0.68])
SHADOW_BIAS, SHADOW_SOFTNESS = 0.006, 2.5
CORNER_RADIUS, CORNER_SAMPLES = 0.09, 14


@dataclass(frozen=True, eq=False)
class Surface:
    """What there is to be lit, per pixel, and where there is anything at all (H, W).

    Points (H, W, 3) in the world, unit normals (H, W, 3), colours (H, W, 3) in linear light.
    """

    points: Array
    normals: Array
    colors: Array
    there: Mask


def surface(layer: Layer, color_of: dict[int, Array]) -> Surface:
    """The surface a layer sees; `color_of` gives each body's colour (3,)."""
    points = layer.points_world()
    table = np.zeros((max([*color_of, 0]) + 2, 3))
    for body, color in color_of.items():
        table[body] = color
    return Surface(points, _normals(layer, points), table[layer.body], layer.body >= 0)


def with_floor(seen: Surface, layer: Layer, height: float, color: Array) -> tuple[Surface, Array]:
    """The surface with an endless floor at z = `height` behind it, and how much of it is in mist.

    Mist (H, W) goes from 0 near the target to 1 far away.
    """
    rows, columns = seen.there.shape
    world_from_camera = layer.view.camera_from_world().inverse()
    rays = world_from_camera.rotate(pixel_rays(layer.view, columns, rows))
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = (height - layer.view.eye[2]) / rays[..., 2]
    hit = ~seen.there & (distance > 0) & (distance < 4 * layer.view.far)
    points = layer.view.eye + rays * np.where(hit, distance, 1.0)[..., None]
    merged = Surface(
        np.where(hit[..., None], points, seen.points),
        np.where(hit[..., None], [0.0, 0, 1], seen.normals),
        np.where(hit[..., None], color, seen.colors),
        seen.there | hit,
    )
    away = np.linalg.norm(points[..., :2] - layer.view.target[:2], axis=-1)
    return merged, np.where(hit, np.clip((away - 1.0) / 2.6, 0, 1) ** 0.8, 0.0)


def lit(seen: Surface, sun: Layer, corners: Array) -> Array:
    """Linear light (H, W, 3) of a surface, shadowed by what the sun's own view sees first.

    `corners` (H, W) dims the sky.
    """
    towards = sun.view.eye - sun.view.target
    towards = towards / np.linalg.norm(towards)
    facing = np.clip(seen.normals @ towards, 0, None) * _sunlit(seen, sun)
    up = (seen.normals[..., 2:] + 1) / 2
    sky = (SKY * up + GROUND * (1 - up)) * corners[..., None]
    light: Array = seen.colors * (sky + SUN / np.pi * facing[..., None])
    return light


def backdrop(rows: int, columns: int) -> Array:
    """What is behind everything (rows, columns, 3): lighter towards the bottom."""
    down = np.linspace(0, 1, rows)[:, None, None]
    gradient = BACKDROP_HIGH * (1 - down) + BACKDROP_LOW * down
    return np.broadcast_to(gradient, (rows, columns, 3)).copy()


def open_sky(seen: Surface, layer: Layer) -> Array:
    """How open to the sky each pixel is (H, W): less in corners and under things.

    Points are tried in the half ball over each pixel; those that lie behind what the picture shows
    there are hidden (Crytek 2007). Taken at a quarter of the pixels, then smoothed.
    """
    points, normals = seen.points[::2, ::2], seen.normals[::2, ::2]
    depth = np.where(np.isfinite(layer.depth), layer.depth, layer.view.far)[::2, ::2]
    camera = layer.view.camera_from_world()
    rows, columns = depth.shape
    focal = layer.view.focal(rows)
    random = np.random.default_rng(0)
    hidden = np.zeros((rows, columns))
    for _ in range(CORNER_SAMPLES):
        offset = random.normal(size=3)
        offset *= CORNER_RADIUS * random.uniform(0.1, 1) / np.linalg.norm(offset)
        # mirrored into the half ball over the surface
        flip = np.sign(normals @ offset)[..., None]
        x, y, z = np.moveaxis(camera.apply(points + offset * flip + normals * 0.004), -1, 0)
        u = np.clip(np.rint(x / z * focal + (columns - 1) / 2), 0, columns - 1).astype(int)
        v = np.clip(np.rint(y / z * focal + (rows - 1) / 2), 0, rows - 1).astype(int)
        nearer = z - depth[v, u]
        hidden += (nearer > 0.002) & (nearer < 2 * CORNER_RADIUS)
    openness = cv2.GaussianBlur((1 - hidden / CORNER_SAMPLES).astype(np.float32), (0, 0), 2.2)
    full = cv2.resize(openness, seen.there.shape[::-1], interpolation=cv2.INTER_LINEAR)
    return np.clip(full * 1.15, 0, 1).astype(float) ** 1.3


def _normals(layer: Layer, points: Array) -> Array:
    """Unit normals from neighbouring points, taken on the side that continues the surface."""
    across, down = (_difference(points, layer.depth, axis) for axis in (1, 0))
    normals = np.cross(down, across)
    normals /= np.maximum(np.linalg.norm(normals, axis=-1, keepdims=True), 1e-12)
    # facets of the meshes are smoothed over, edges are not
    smooth = cv2.bilateralFilter(normals.astype(np.float32), 9, 0.35, 4.0).astype(float)
    smooth /= np.maximum(np.linalg.norm(smooth, axis=-1, keepdims=True), 1e-12)
    return smooth


def _difference(points: Array, depth: Array, axis: int) -> Array:
    ahead = np.roll(points, -1, axis) - points
    behind = points - np.roll(points, 1, axis)
    # far, and finite, so that differences stay numbers
    deep = np.where(np.isfinite(depth), depth, 1e3)
    jump_ahead = np.abs(np.roll(deep, -1, axis) - deep)
    jump_behind = np.abs(deep - np.roll(deep, 1, axis))
    return np.where((jump_ahead < jump_behind)[..., None], ahead, behind)


def _sunlit(seen: Surface, sun: Layer) -> Array:
    """1 where the sun reaches, 0 in shadow, in between on the shadow's rim; (H, W)."""
    rows, columns = sun.depth.shape
    lifted = seen.points + seen.normals * SHADOW_BIAS
    x, y, z = np.moveaxis(sun.view.camera_from_world().apply(lifted), -1, 0)
    z = np.maximum(z, 1e-6)
    focal = sun.view.focal(rows)
    u, v = x / z * focal + (columns - 1) / 2, y / z * focal + (rows - 1) / 2
    depth = np.where(np.isfinite(sun.depth), sun.depth, 1e6).astype(np.float32)
    total = np.zeros(z.shape)
    steps = (-1.5, -0.5, 0.5, 1.5)
    for du in steps:
        for dv in steps:
            first = cv2.remap(
                depth,
                (u + du * SHADOW_SOFTNESS).astype(np.float32),
                (v + dv * SHADOW_SOFTNESS).astype(np.float32),
                cv2.INTER_NEAREST,
                borderMode=cv2.BORDER_CONSTANT,
                borderValue=(1e6,),
            )
            total += z <= first + SHADOW_BIAS
    return total / len(steps) ** 2
