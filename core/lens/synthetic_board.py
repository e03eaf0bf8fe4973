# SPDX-License-Identifier: GPL-3.0-or-later
"""Synthetic pictures of boards with known answers: a lens, a board and its poses in, pictures out.

Shares nothing with the estimators but the lens: each pixel's ray is intersected with the board's
plane, the print is averaged over the pixel in linear light, blurred, given noise and encoded.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..intrinsics import Intrinsics
from ..pose import Pose
from .board import Board
from .drawing import board_picture

PIXELS_PER_SQUARE = 84
MARGIN = 1.0
POINTS_PER_SIDE = 4
CANDIDATES = 6
# linear light of paper, ink and the wall behind
PAPER, INK, WALL = 0.75, 0.03, 0.18


@dataclass(frozen=True)
class BoardPhotographer:
    """`blur_pixels` is a Gaussian's sigma, `noise_grey_levels` that of the noise after encoding."""

    blur_pixels: float = 0.6
    noise_grey_levels: float = 2.0
    seed: int = 0


def photograph_boards(
    intrinsics: Intrinsics,
    board: Board,
    camera_from_boards: Sequence[Pose],
    photographer: BoardPhotographer | None = None,
) -> list[NDArray[np.uint8]]:
    """One sRGB picture (H, W, 3) of the board at each `camera_from_board`."""
    how = photographer or BoardPhotographer()
    rng = np.random.default_rng(how.seed)
    v, u = np.mgrid[: intrinsics.height, : intrinsics.width]
    rays = intrinsics.rays(np.stack([u.ravel(), v.ravel()], 1).astype(float))
    grid = rays.reshape(intrinsics.height, intrinsics.width, 3)
    ink = board_picture(board, PIXELS_PER_SQUARE, MARGIN)
    paper = np.where(ink == 0, INK, PAPER).astype(np.float32)
    return [_photograph(grid, paper, board, pose, how, rng) for pose in camera_from_boards]


def scattered_poses(
    intrinsics: Intrinsics,
    board: Board,
    count: int,
    rng: np.random.Generator,
    tilt_degrees: float = 35.0,
    fill: float = 0.55,
) -> list[Pose]:
    """Poses of a board held about the picture: `fill` of its width, tilted up to `tilt_degrees`.

    All of it is in view, at a random angle. Of a few random places each time the one is taken that
    is farthest from those before, as a careful photographer would.
    """
    poses: list[Pose] = []
    middles: list[Array] = []
    while len(poses) < count:
        tried = [
            _in_view(intrinsics, board, rng, np.radians(tilt_degrees), fill)
            for _ in range(CANDIDATES)
        ]
        lonely = [_nearest(_middle(intrinsics, board, pose), middles) for pose in tried]
        poses.append(tried[int(np.argmax(lonely))])
        middles.append(_middle(intrinsics, board, poses[-1]))
    return poses


def _in_view(
    intrinsics: Intrinsics, board: Board, rng: np.random.Generator, tilt: float, fill: float
) -> Pose:
    """One random pose that shows the whole board."""
    size = np.array([intrinsics.width, intrinsics.height])
    extent = float(np.linalg.norm(np.ptp(board.corners, axis=0)))
    distance = extent * intrinsics.fx / (fill * intrinsics.width)
    while True:
        axis = rng.normal(size=2)
        leaned = tilt * np.sqrt(rng.uniform(0.1, 1)) * axis / np.linalg.norm(axis)
        turn = Pose.from_rotation_vector([0, 0, rng.uniform(-np.pi, np.pi)], np.zeros(3))
        lean = Pose.from_rotation_vector([*leaned, 0.0], np.zeros(3))
        ray = intrinsics.rays(rng.uniform(0.05, 0.95, (1, 2)) * size)[0]
        if not np.isfinite(ray).all():
            continue
        place = Pose(np.eye(3), ray * distance * rng.uniform(0.75, 1.4))
        pose = place @ _facing(ray) @ lean @ turn @ Pose(np.eye(3), -board.corners.mean(axis=0))
        pixels = intrinsics.project(pose.apply(_rim(board)))
        if np.isfinite(pixels).all() and intrinsics.contains(pixels).all():
            return pose


def _middle(intrinsics: Intrinsics, board: Board, pose: Pose) -> Array:
    middle: Array = intrinsics.project(pose.apply(board.corners)).mean(axis=0)
    return middle


def _nearest(place: Array, others: Sequence[Array]) -> float:
    return min((float(np.linalg.norm(place - other)) for other in others), default=0.0)


def _rim(board: Board) -> Array:
    """The outer corners of the squares all round, (N, 3) on the board."""
    columns, rows = board.squares
    across = [(x, y) for x in range(columns + 1) for y in (0, rows)]
    down = [(x, y) for x in (0, columns) for y in range(rows + 1)]
    # the frame begins at the first inner corner
    places = np.array([(x - 1, y - 1, 0) for x, y in (*across, *down)], dtype=float)
    return places * board.square


def _facing(ray: Array) -> Pose:
    """The rotation that turns the optical axis into a ray, about the shortest way."""
    axis = np.cross([0.0, 0.0, 1.0], ray)
    length = float(np.linalg.norm(axis))
    angle = float(np.arctan2(length, ray[2]))
    return Pose.from_rotation_vector(axis * (angle / max(length, 1e-12)), np.zeros(3))


def _photograph(
    rays: Array,
    paper: NDArray[np.float32],
    board: Board,
    camera_from_board: Pose,
    how: BoardPhotographer,
    rng: np.random.Generator,
) -> NDArray[np.uint8]:
    light = _board_light(_print_places(rays, board, camera_from_board), paper)
    if how.blur_pixels > 0:
        light = np.asarray(cv2.GaussianBlur(light, (0, 0), how.blur_pixels), np.float32)
    encoded = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    noisy = 255 * encoded + rng.normal(0, how.noise_grey_levels, light.shape)
    grey = np.clip(np.rint(noisy), 0, 255).astype(np.uint8)
    return np.asarray(cv2.cvtColor(grey, cv2.COLOR_GRAY2BGR), np.uint8)


def _print_places(rays: Array, board: Board, camera_from_board: Pose) -> Array:
    """Where each ray (H, W, 3) meets the board, (H, W, 2) in pixels of the print; NaN nowhere."""
    back = camera_from_board.inverse()
    directions = back.rotate(rays)
    start = back.translation
    # a board is printed on one side: its z axis points away from the camera
    with np.errstate(invalid="ignore", divide="ignore"):
        along = -start[2] / directions[..., 2]
        along = np.where(along > 0, along, np.nan)
    places = start[:2] + directions[..., :2] * along[..., None]
    # from the first inner corner to the print's top left pixel centre
    return (places / board.square + 1 + MARGIN) * PIXELS_PER_SQUARE - 0.5


def _board_light(places: Array, paper: NDArray[np.float32]) -> NDArray[np.float32]:
    """The mean light over each pixel's own area."""
    down, right = np.gradient(places, axis=(0, 1))
    steps = (np.arange(POINTS_PER_SIDE) + 0.5) / POINTS_PER_SIDE - 0.5
    total = np.zeros(places.shape[:2], np.float32)
    for dv in steps:
        for du in steps:
            points = np.nan_to_num(places + du * right + dv * down, nan=-1e4)
            total += cv2.remap(
                paper,
                np.clip(points, -1e4, 1e4).astype(np.float32),
                np.zeros(0, np.float32),
                cv2.INTER_LINEAR,
                None,
                cv2.BORDER_CONSTANT,
                (WALL,),
            )
    return total / np.float32(POINTS_PER_SIDE**2)
