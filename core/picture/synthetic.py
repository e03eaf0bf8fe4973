# SPDX-License-Identifier: GPL-3.0-or-later
"""Synthetic pictures of balls with known answers, for tests and benchmarks that need no Blender.

A ray tracer of its own, sharing nothing with the estimators but the lens: every sub-pixel's ray is
intersected with the spheres, shaded in linear light, averaged, blurred, given noise and encoded.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import cv2
import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..intrinsics import Intrinsics


@dataclass(frozen=True)
class Ball:
    """A matt ball with a highlight: centre (3,) in the camera frame, radius in metres."""

    centre_camera: tuple[float, float, float]
    radius: float
    color: tuple[float, float, float] = (0.75, 0.32, 0.08)
    shine: float = 0.25


@dataclass(frozen=True)
class Photographer:
    """Light and camera: direction to the light (camera frame), blur, noise, and encoding.

    `blur_pixels` is the sigma of a Gaussian; `noise_grey_levels` that of the noise after encoding;
    `jpeg_quality` None keeps the picture as it is. `background` is linear light from left to right.
    """

    light: tuple[float, float, float] = (-0.5, -0.8, -0.6)
    ambient: float = 0.25
    background: tuple[float, float] = (0.08, 0.3)
    texture: float = 0.0
    blur_pixels: float = 0.5
    noise_grey_levels: float = 1.0
    jpeg_quality: int | None = None
    supersampling: int = 5
    seed: int = 0
    hidden: tuple[tuple[float, float, float, float], ...] = field(default=())
    """Rectangles (x, y, width, height) in pixels of something dark in front of the ball."""


def photograph(
    intrinsics: Intrinsics, balls: tuple[Ball, ...], photographer: Photographer | None = None
) -> NDArray[np.uint8]:
    """An sRGB picture (H, W, 3) blue, green, red of balls before a plain or textured wall."""
    how = photographer or Photographer()
    rng = np.random.default_rng(how.seed)
    light = _wall(intrinsics, how, rng)
    for ball in balls:
        _paint(light, intrinsics, ball, how)
    for x, y, width, height in how.hidden:
        cover = light[round(y) : round(y + height), round(x) : round(x + width)]
        cover[...] = 0.04
    if how.blur_pixels > 0:
        light = cv2.GaussianBlur(light, (0, 0), how.blur_pixels).astype(float)
    grey_levels = 255 * _encoded(np.clip(light, 0, 1))
    noisy = grey_levels + rng.normal(0, how.noise_grey_levels, light.shape)
    picture = np.clip(np.rint(noisy), 0, 255).astype(np.uint8)
    if how.jpeg_quality is None:
        return picture
    _, data = cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, how.jpeg_quality])
    return np.asarray(cv2.imdecode(data, cv2.IMREAD_COLOR), dtype=np.uint8)


def _wall(intrinsics: Intrinsics, how: Photographer, rng: np.random.Generator) -> Array:
    shape = (intrinsics.height, intrinsics.width)
    wall = np.broadcast_to(np.linspace(*how.background, intrinsics.width), shape).copy()
    if how.texture > 0:
        # blotches of several sizes, as plaster or foliage out of focus would show
        for size in (1.5, 5.0, 16.0):
            blotches = cv2.GaussianBlur(rng.normal(size=shape), (0, 0), size)
            wall *= np.exp(how.texture * blotches / blotches.std())
    return np.asarray(wall[:, :, None] * np.array([1.0, 0.95, 0.85]))


def _paint(light: Array, intrinsics: Intrinsics, ball: Ball, how: Photographer) -> None:
    """Replace the pixels that the ball covers, partly covered ones in proportion."""
    middle = np.array(ball.centre_camera)
    rim = middle + ball.radius * 1.3 * np.array(
        [[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    )
    seen = intrinsics.project(rim)
    low = np.maximum(np.floor(np.nanmin(seen, axis=0)).astype(int), 0)
    size = np.array([intrinsics.width, intrinsics.height])
    high = np.minimum(np.ceil(np.nanmax(seen, axis=0)).astype(int) + 1, size)
    if (high <= low).any():
        return
    n = how.supersampling
    steps = (np.arange(n) + 0.5) / n - 0.5
    u, v = np.meshgrid(np.arange(low[0], high[0]), np.arange(low[1], high[1]))
    covered, shade = np.zeros(u.shape), np.zeros((*u.shape, 3))
    for du in steps:
        for dv in steps:
            rays = intrinsics.rays(np.stack([u.ravel() + du, v.ravel() + dv], 1))
            hit, color = _shaded(rays, middle, ball, how)
            covered += hit.reshape(u.shape) / n**2
            shade += color.reshape(shade.shape) / n**2
    patch = light[low[1] : high[1], low[0] : high[0]]
    patch[...] = patch * (1 - covered[..., None]) + shade


def _shaded(rays: Array, middle: Array, ball: Ball, how: Photographer) -> tuple[Array, Array]:
    """Whether each ray hits, and the light that comes back: Lambert's law and Phong's highlight."""
    along = np.nan_to_num(rays @ middle)
    inside = along**2 - (middle @ middle - ball.radius**2)
    hit = (inside > 0) & (along > 0)
    depth = along - np.sqrt(np.maximum(inside, 0))
    normals = (np.nan_to_num(rays) * depth[:, None] - middle) / ball.radius
    to_light = np.array(how.light) / np.linalg.norm(how.light)
    facing = np.maximum(normals @ to_light, 0)
    mirrored = 2 * facing[:, None] * normals - to_light
    highlight = np.maximum(-(mirrored * np.nan_to_num(rays)).sum(1), 0) ** 40
    matt = how.ambient + (1 - how.ambient) * facing
    color = matt[:, None] * np.array(ball.color)[::-1] + ball.shine * highlight[:, None]
    return hit.astype(float), np.where(hit[:, None], color, 0.0)


def _encoded(light: Array) -> Array:
    """Linear light to sRGB (IEC 61966-2-1)."""
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
