# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures from a distorted lens to a perfect one and back, through exact maps."""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..errors import InvalidValue, PictureError
from ..intrinsics import Intrinsics

# OpenCV's remap addresses pixels by signed 16-bit numbers
LONGEST_SIDE = 32766
# a flat picture of a wide lens grows without bounds; eight times the pixels is where help ends
LARGEST_GROWTH = 8.0
# OpenCV's remap rounds to a 32nd of a pixel: a map that is interpolated in blocks of so many pixels
# may be off by so much
BLOCK, MAP_PIXELS = 8, 0.005
# each distorted pixel is the mean of so many by so many points
POINTS_PER_SIDE = 4


def undistorted_picture(picture: NDArray[Any], intrinsics: Intrinsics) -> NDArray[Any]:
    """The picture (H, W, 3) as a perfect lens of the same K would have taken it, in its own type.

    `result(intrinsics.undistorted().project(p)) == picture(intrinsics.project(p))`, interpolated
    bicubically (sharp, without the ringing that Lanczos leaves along black edges). Black where the
    lens saw nothing. Raises PictureError when the size is not the camera's.
    """
    _check_size(picture, intrinsics)
    if intrinsics.distortion.model == "none":
        return picture.copy()
    # no ray is a place outside any picture
    place = np.nan_to_num(view_map(intrinsics), copy=False, nan=-1e4)
    return _remapped(picture, place, cv2.INTER_CUBIC)


def undistorted_window(
    picture: NDArray[Any], intrinsics: Intrinsics, window: tuple[int, int, int, int]
) -> NDArray[Any]:
    """`undistorted_picture` of `window` (x, y, width, height) alone, (height, width, 3).

    Raises PictureError when the size is not the camera's.
    """
    _check_size(picture, intrinsics)
    x, y, width, height = window
    if intrinsics.distortion.model == "none":
        return picture[y : y + height, x : x + width].copy()
    imaged = _imaged(intrinsics, x + np.arange(width) * 1.0, y + np.arange(height) * 1.0)
    place = np.nan_to_num(imaged, nan=-1e4).astype(np.float32)
    return _remapped(picture, place, cv2.INTER_CUBIC)


def view_map(intrinsics: Intrinsics) -> NDArray[np.float32]:
    """Where the lens images each pixel of its undistorted view, (H, W, 2); NaN where nowhere.

    Lenses are smooth: the map is worked out once a block, and between blocks is interpolated
    wherever that is true to `MAP_PIXELS`. The rest is worked out pixel by pixel.
    """
    height, width = intrinsics.height, intrinsics.width
    # the middles of all blocks, with one row of them beyond the picture on each side
    rows, columns = (np.arange(-1, -(-n // BLOCK) + 1) * BLOCK for n in (height, width))
    half = (BLOCK - 1) / 2
    nodes = _imaged(intrinsics, columns + half, rows + half)
    # halfway between four blocks, where interpolating is worst
    true = _imaged(intrinsics, columns[:-1] + half + BLOCK / 2, rows[:-1] + half + BLOCK / 2)
    between = (nodes[:-1, :-1] + nodes[:-1, 1:] + nodes[1:, :-1] + nodes[1:, 1:]) / 4
    # a comparison with NaN is false
    smooth = (np.abs(between - true) <= MAP_PIXELS).all(axis=2).astype(np.uint8)
    # beside a place where the lens turns over, its middle may be right by chance
    smooth = cv2.erode(smooth, np.ones((5, 5), np.uint8)) > 0
    size = (BLOCK * len(columns), BLOCK * len(rows))
    filled = cv2.resize(nodes.astype(np.float32), size, interpolation=cv2.INTER_LINEAR)
    whole = np.ascontiguousarray(filled[BLOCK : BLOCK + height, BLOCK : BLOCK + width])
    # which four blocks a pixel lies between
    row, column = ((np.arange(n) + BLOCK // 2) // BLOCK for n in (height, width))
    v, u = np.nonzero(~smooth[np.ix_(row, column)])
    rays = intrinsics.undistorted().rays(np.stack([u, v], axis=1).astype(float))
    whole[v, u] = intrinsics.project(rays)
    return whole


def _imaged(intrinsics: Intrinsics, u: Array, v: Array) -> Array:
    """Where the lens images the pixels of the undistorted view at all `u` by all `v`, (V, U, 2)."""
    pixels = np.stack(np.meshgrid(u, v), axis=-1).reshape(-1, 2)
    imaged = intrinsics.project(intrinsics.undistorted().rays(pixels))
    return imaged.reshape(len(v), len(u), 2)


def pinhole_around(intrinsics: Intrinsics, finer: float) -> Intrinsics:
    """A perfect lens that sees all that a distorted one sees, `finer` times as fine.

    Its pixels subtend at most `1 / finer` of a distorted pixel at the principal point. Raises
    InvalidValue when the field of view is too wide for a flat picture.
    """
    rays = intrinsics.rays(_rim(intrinsics))
    forward = rays[:, 2] > 0.05
    plane = rays[forward, :2] / rays[forward, 2:]
    if len(plane) < 4 or (not forward.all() and np.isfinite(rays).all()):
        raise InvalidValue("the lens sees 174 degrees or more, which no flat picture can hold")
    low, high = plane.min(axis=0), plane.max(axis=0)
    focal = np.array([intrinsics.fx, intrinsics.fy]) * finer
    # a pixel of margin on each side feeds the interpolation at the rim
    width, height = (int(n) for n in np.ceil((high - low) * focal) + 3)
    given = intrinsics.width * intrinsics.height * finer**2
    if max(width, height) > LONGEST_SIDE or width * height > LARGEST_GROWTH * given:
        raise InvalidValue(
            f"a flat picture of this lens needs {width} x {height} px, more than "
            f"{LARGEST_GROWTH:g} times the distorted one; its field of view is too wide"
        )
    cx, cy = 1.0 - low * focal
    return Intrinsics(width, height, float(focal[0]), float(focal[1]), cx, cy)


def distorted_picture(
    perfect: NDArray[np.float32], pinhole: Intrinsics, intrinsics: Intrinsics
) -> NDArray[np.float32]:
    """What the lens of `intrinsics` makes of a finer picture (h, w, 3) by `pinhole`, (H, W, 3).

    Each pixel is the mean over its own area, as a sensor takes it: give linear light. Pixels that
    no ray reaches are black.
    """
    _check_size(perfect, pinhole)
    whole = (0, 0, intrinsics.width, intrinsics.height)
    return distorted_window(perfect, (0, 0), pinhole, intrinsics, whole)


def distorted_window(
    perfect: NDArray[np.float32],
    origin: tuple[int, int],
    pinhole: Intrinsics,
    intrinsics: Intrinsics,
    window: tuple[int, int, int, int],
) -> NDArray[np.float32]:
    """`distorted_picture` of `window` (x, y, width, height) alone, (height, width, 3).

    `perfect` is the part of the finer picture whose top left pixel is `origin` there.
    """
    x, y, width, height = window
    v, u = np.mgrid[y : y + height, x : x + width]
    rays = intrinsics.rays(np.stack([u.ravel(), v.ravel()], axis=1))
    grid = (pinhole.project(rays) - origin).reshape(height, width, 2)
    # inside a pixel the map is as good as linear
    down, right = np.gradient(grid, axis=(0, 1))
    steps = (np.arange(POINTS_PER_SIDE) + 0.5) / POINTS_PER_SIDE - 0.5
    total = np.zeros((height, width, 3), np.float32)
    for dv in steps:
        for du in steps:
            place = np.nan_to_num(grid + du * right + dv * down, nan=-1e4).astype(np.float32)
            total += _remapped(perfect, place, cv2.INTER_LINEAR)
    return total / np.float32(POINTS_PER_SIDE**2)


def window_behind(
    pinhole: Intrinsics, intrinsics: Intrinsics, window: tuple[int, int, int, int]
) -> tuple[int, int, int, int]:
    """The part of the finer picture by `pinhole` that `distorted_window` needs, a window there.

    Raises InvalidValue when the lens sees nothing in some part of the window's rim.
    """
    x, y, width, height = window
    across, down = np.linspace(x - 1, x + width, 64), np.linspace(y - 1, y + height, 64)
    sides = [np.stack([across, np.full(64, at)], 1) for at in (down[0], down[-1])]
    sides += [np.stack([np.full(64, at), down], 1) for at in (across[0], across[-1])]
    seen = pinhole.project(intrinsics.rays(np.concatenate(sides)))
    if not np.isfinite(seen).all():
        raise InvalidValue(f"window: the lens images nothing in a part of {list(window)}")
    size = [pinhole.width, pinhole.height]
    low = np.clip(np.floor(seen.min(axis=0)).astype(int) - 2, 0, size)
    high = np.clip(np.ceil(seen.max(axis=0)).astype(int) + 3, 0, size)
    return int(low[0]), int(low[1]), int(high[0] - low[0]), int(high[1] - low[1])


def _check_size(picture: NDArray[Any], intrinsics: Intrinsics) -> None:
    expected = (intrinsics.height, intrinsics.width, 3)
    if picture.shape != expected:
        raise PictureError(
            f"the picture has shape {picture.shape}, the camera takes {expected}; "
            "is the camera file for another resolution?"
        )
    if max(expected) > LONGEST_SIDE:
        raise PictureError(f"{max(expected)} px on one side is more than {LONGEST_SIDE}; scale it")


def _rim(intrinsics: Intrinsics) -> Array:
    """Points (N, 2) along the outer border of the picture, one per pixel."""
    u = np.arange(intrinsics.width + 1) - 0.5
    v = np.arange(intrinsics.height + 1) - 0.5
    sides = [np.stack([u, np.full_like(u, at)], 1) for at in (v[0], v[-1])]
    sides += [np.stack([np.full_like(v, at), v], 1) for at in (u[0], u[-1])]
    return np.concatenate(sides)


def _remapped(picture: NDArray[Any], place: NDArray[np.float32], how: int) -> NDArray[Any]:
    black = (0.0, 0.0, 0.0)
    nowhere = np.zeros(0, np.float32)
    return np.asarray(cv2.remap(picture, place, nowhere, how, None, cv2.BORDER_CONSTANT, black))
