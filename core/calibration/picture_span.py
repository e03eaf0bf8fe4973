# SPDX-License-Identifier: GPL-3.0-or-later
"""How the balls fill the view: their centres in the camera frame in, shares and depths out."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from ..arrays import Array
from ..intrinsics import Intrinsics


@dataclass(frozen=True)
class PictureSpan:
    """What the balls' centres span.

    `share` of the picture inside the line round them; `width_share`, `height_share` of its sides;
    `nearest` and `farthest` from the camera, metres.
    """

    share: float
    width_share: float
    height_share: float
    nearest: float
    farthest: float


def span_of(intrinsics: Intrinsics, centres_camera: Array) -> PictureSpan:
    """Measure centres (N, 3), N at least one, that the lens images."""
    pixels = intrinsics.project(centres_camera)
    distances = np.linalg.norm(centres_camera, axis=1)
    hull = cv2.convexHull(pixels.astype(np.float32))
    size = np.array([intrinsics.width, intrinsics.height])
    across = np.ptp(pixels, axis=0) / size
    return PictureSpan(
        float(cv2.contourArea(hull) / size.prod()),
        float(across[0]),
        float(across[1]),
        float(distances.min()),
        float(distances.max()),
    )
