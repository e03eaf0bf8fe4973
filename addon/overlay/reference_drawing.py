# SPDX-License-Identifier: GPL-3.0-or-later
"""What is drawn over the picture while a reference is chosen or made."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np

from ...core.arrays import Array
from ...core.camera import Camera
from ...core.picture.wireframe import finite_parts
from ..on_picture.picture_frame import PictureFrame
from .drawing import ORANGE, WHITE, YELLOW, draw_crosses, draw_lines

LINE_SAMPLES = 24


def draw_shown(
    context: Any, frame: PictureFrame, camera: Camera, shown: Any, operator: Any
) -> None:
    """The face, edge or axis under the cursor, and its name."""
    scale = context.preferences.system.ui_scale
    words = "nothing to stand on here"
    if shown is not None:
        words = shown.path
        draw_lines(_in_region(frame, camera, shown.line), ORANGE, 3.5, scale)
    operator.paint_words(context, [(words, ORANGE if shown is not None else WHITE)])


def draw_upright(context: Any, frame: PictureFrame, operator: Any) -> None:
    """Crosses at the clicks, the foot line to the cursor, and what the next click is for."""
    scale = context.preferences.system.ui_scale
    inner = frame.intrinsics
    clicked = np.array(operator.pixels).reshape(-1, 2)
    points = frame.region_points(inner.undistorted().project(inner.rays(clicked)))
    aim = operator.aim(context, context.area)
    if len(points) and aim is not None:
        end = frame.region_points(inner.undistorted().project(inner.rays(aim.pixel[None])))
        draw_lines([np.vstack([points[-1:], end])], YELLOW, 2.0, scale)
    draw_crosses(points, YELLOW, scale)
    snapped = operator.paint_aim(context, frame)
    operator.paint_words(context, [(operator.keys()[0][1], WHITE), (snapped, WHITE)])


def _in_region(frame: PictureFrame, camera: Camera, line: Array) -> list[Array]:
    """A line (N, 3) of the world as it is drawn."""
    if not len(line):
        return []
    pinhole = replace(camera, intrinsics=camera.intrinsics.undistorted())
    shares = np.linspace(0.0, 1.0, LINE_SAMPLES)[:, None]
    points = np.concatenate([a + shares * (b - a) for a, b in pairwise(line)])
    return [frame.region_points(part) for part in finite_parts(pinhole.project(points))]
