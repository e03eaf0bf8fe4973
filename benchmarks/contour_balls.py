# SPDX-License-Identifier: GPL-3.0-or-later
"""The usual ways to find a ball with OpenCV, as a careful user writes them: windows in, balls out.

The window is put around the ball by hand. Canny's edges inside it are sifted by RANSAC: a sphere
through each of many threes of them (after Toth and Hajder, "A minimal solution for image-based
sphere estimation", 2023), the one kept that most edges agree with. Then either an ellipse is fitted
to those edges (`cv2.fitEllipse`), whose centre stands for the ball's, or a sphere.
"""

from __future__ import annotations

import cv2
import numpy as np
from monocell.core.ball.sphere import sphere_from_rays
from monocell.core.errors import SphereNotFound
from monocell.core.intrinsics import Intrinsics

Window = tuple[int, int, int, int]

# of the window's side, half the ball's size, and how far that may be off
SIZE_SHARE, SIZE_TOLERANCE = 0.3125, 1.3
TRIPLES, AGREEING_PIXELS, FEWEST = 4000, 1.0, 20


def agreeing_edges(
    picture: np.ndarray, window: Window, intrinsics: Intrinsics, seed: int
) -> np.ndarray:
    """Pixels (N, 2) of the edges in a window that lie on one ball's outline; empty without one."""
    edges = _edges(picture, window)
    if len(edges) < FEWEST:
        return np.zeros((0, 2))
    rays = intrinsics.rays(edges)
    threes = np.random.default_rng(seed).integers(len(edges), size=(TRIPLES, 3))
    corners = rays[threes]
    corners = corners[np.abs(np.linalg.det(corners)) > 1e-12]
    # u . w = 1 for the rays u that touch the sphere; |w| tells its size, and w its direction
    w = np.linalg.solve(corners, np.ones((len(corners), 3, 1)))[:, :, 0]
    w = w[_plausible(w, window, intrinsics)]
    if not len(w):
        return np.zeros((0, 2))
    off = (1 - w @ rays.T) / np.sqrt((w * w).sum(axis=1) - 1)[:, None]
    agreeing = np.abs(off) * intrinsics.fx < AGREEING_PIXELS
    best = agreeing[np.argmax(agreeing.sum(axis=1))]
    return edges[best] if best.sum() >= FEWEST else np.zeros((0, 2))


def ellipse_centre(edges: np.ndarray) -> np.ndarray | None:
    """The centre (2,) of the ellipse fitted to edges (N, 2)."""
    return np.array(cv2.fitEllipse(edges.astype(np.float32))[0]) if len(edges) else None


def sphere_centre(intrinsics: Intrinsics, edges: np.ndarray, radius: float) -> np.ndarray | None:
    """The centre (3,) in the camera frame of the sphere of `radius` metres fitted to edges."""
    if not len(edges):
        return None
    try:
        return sphere_from_rays(intrinsics.rays(edges), radius)
    except SphereNotFound:
        return None


def _edges(picture: np.ndarray, window: Window) -> np.ndarray:
    """Pixels of Canny's edges in any channel, its upper threshold by Otsu's as is usual."""
    x, y, width, height = window
    smooth = cv2.GaussianBlur(picture[y : y + height, x : x + width], (5, 5), 0)
    found = np.zeros(smooth.shape[:2], bool)
    for channel in cv2.split(smooth):
        high, _ = cv2.threshold(channel, 0, 255, cv2.THRESH_OTSU)
        found |= cv2.Canny(channel, 0.5 * high, high) > 0
    v, u = np.nonzero(found)
    return np.stack([u + x, v + y], axis=1).astype(float)


def _plausible(w: np.ndarray, window: Window, intrinsics: Intrinsics) -> np.ndarray:
    """Which spheres are of about the size and place that the window says."""
    x, y, width, height = window
    excess = (w * w).sum(axis=1) - 1
    size = intrinsics.fx * np.sqrt(np.maximum(excess, 0))
    expected = SIZE_SHARE * 0.5 * (width + height)
    middle = intrinsics.project(w) - [x + width / 2, y + height / 2]
    near = np.linalg.norm(np.nan_to_num(middle, nan=1e9), axis=1) < 0.5 * expected
    return (size > expected / SIZE_TOLERANCE) & (size < expected * SIZE_TOLERANCE) & near
