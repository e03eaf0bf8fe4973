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
class Bar:
    """A straight finger before the ball: from and to in pixels, round ends, in linear light."""

    start: tuple[float, float]
    end: tuple[float, float]
    width_pixels: float
    color: tuple[float, float, float] = (0.04, 0.04, 0.04)


@dataclass(frozen=True)
class Photographer:
    """Light and camera: direction to the light (camera frame), blur, noise, and encoding.

    `blur_pixels` is the sigma of a Gaussian, `motion_pixels` the way of a shaken camera;
    `noise_grey_levels` is the sigma of the noise after encoding; `jpeg_quality` None keeps the
    picture as it is. `background` is linear light from left to right, `checker_pixels` the squares
    of a board painted on it, its dark ones `checker_contrast` darker. Where `a x + b y + c z < d`
    for the `shadow` (a, b, c, d), in the camera frame, a ball gets ambient light alone.
    """

    light: tuple[float, float, float] = (-0.5, -0.8, -0.6)
    ambient: float = 0.25
    background: tuple[float, float] = (0.08, 0.3)
    texture: float = 0.0
    checker_pixels: float = 0.0
    checker_contrast: float = 0.7
    shadow: tuple[float, float, float, float] | None = None
    blur_pixels: float = 0.5
    motion_pixels: tuple[float, float] = (0.0, 0.0)
    noise_grey_levels: float = 1.0
    jpeg_quality: int | None = None
    supersampling: int = 5
    seed: int = 0
    hidden: tuple[tuple[float, float, float, float], ...] = field(default=())
    """Rectangles (x, y, width, height) in pixels of something dark in front of the ball."""
    bars: tuple[Bar, ...] = ()
    panels: tuple[tuple[tuple[float, float, float, float], tuple[float, float, float]], ...] = ()
    """Rectangles behind the ball, each with its colour (red, green, blue) in linear light."""


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
    for bar in how.bars:
        _lay_before(light, bar)
    return _developed(light, how, rng)


def _developed(light: Array, how: Photographer, rng: np.random.Generator) -> NDArray[np.uint8]:
    """What the lens, the sensor and the file make of the light."""
    if how.blur_pixels > 0:
        light = cv2.GaussianBlur(light, (0, 0), how.blur_pixels).astype(float)
    if any(how.motion_pixels):
        light = cv2.filter2D(light, -1, _way(how.motion_pixels)).astype(float)
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
    colored = np.asarray(wall[:, :, None] * np.array([1.0, 0.95, 0.85]))
    for (x, y, width, height), color in how.panels:
        left, top = max(round(x), 0), max(round(y), 0)
        panel = colored[top : max(round(y + height), 0), left : max(round(x + width), 0)]
        panel[...] = np.array(color)[::-1]
    if how.checker_pixels > 0:
        turned = np.array([[0.96, 0.28], [-0.28, 0.96]]) / how.checker_pixels
        place = np.stack(np.meshgrid(*(np.arange(n) for n in shape[::-1])), axis=2) @ turned
        dark = np.floor(place).sum(axis=2) % 2 > 0
        colored[dark] *= 1 - how.checker_contrast
    return colored


def _lay_before(light: Array, bar: Bar) -> None:
    """Cover what lies within half a bar's width of its middle line, edges in proportion."""
    start, along = np.array(bar.start), np.array(bar.end) - bar.start
    rows, columns = np.indices(light.shape[:2])
    place = np.stack([columns, rows], axis=2) - start
    share = np.clip(place @ along / max(along @ along, 1e-12), 0, 1)
    off = np.linalg.norm(place - share[..., None] * along, axis=2)
    covered = np.clip(0.5 + bar.width_pixels / 2 - off, 0, 1)[..., None]
    light[...] = light * (1 - covered) + covered * np.array(bar.color)[::-1]


def _way(motion_pixels: tuple[float, float]) -> Array:
    """The kernel of a camera that moves evenly along a straight way."""
    reach = int(np.ceil(np.abs(motion_pixels).max() / 2)) + 1
    kernel = np.zeros((2 * reach + 1, 2 * reach + 1))
    for t in np.linspace(-0.5, 0.5, 64):
        u, v = reach + t * motion_pixels[0], reach + t * motion_pixels[1]
        i, j = int(v), int(u)
        kernel[i, j] += (1 - v + i) * (1 - u + j)
        kernel[i + 1, j] += (v - i) * (1 - u + j)
        kernel[i, j + 1] += (1 - v + i) * (u - j)
        kernel[i + 1, j + 1] += (v - i) * (u - j)
    return np.asarray(kernel / kernel.sum())


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
    if how.shadow is not None:
        facing = facing * _lit(middle + ball.radius * normals, how.shadow)
    mirrored = 2 * facing[:, None] * normals - to_light
    highlight = np.where(facing > 0, -(mirrored * np.nan_to_num(rays)).sum(1), 0).clip(0) ** 40
    matt = how.ambient + (1 - how.ambient) * facing
    color = matt[:, None] * np.array(ball.color)[::-1] + ball.shine * highlight[:, None]
    return hit.astype(float), np.where(hit[:, None], color, 0.0)


def _lit(points: Array, shadow: tuple[float, float, float, float]) -> Array:
    """Which points (N, 3) the lamp reaches, softly over a millimetre at the shadow's edge."""
    return np.clip(0.5 + (points @ shadow[:3] - shadow[3]) / 1e-3, 0, 1)


def _encoded(light: Array) -> Array:
    """Linear light to sRGB (IEC 61966-2-1)."""
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
