# SPDX-License-Identifier: GPL-3.0-or-later
"""A cell, its objects and its last calibration in, the lines to draw over the picture out.

All in pixels of the undistorted view, which changes neither with zoom nor with pan.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from ..core.arrays import Array
from ..core.ball.sphere import outline_pixels
from ..core.camera import Camera
from ..core.cell import Cell
from ..core.picture.wireframe import finite_parts, wireframe
from ..core.primitives import Primitive
from ..core.sighting import SphereSighting
from .drawing import GREEN, HALO, ORANGE, RED, SKY, YELLOW, Color
from .report import Report

STATUS_COLORS = {"used": GREEN, "doubtful": ORANGE, "rejected": RED}
OUTLINE_POINTS = 120


@dataclass(frozen=True, eq=False)
class Stroke:
    """Polylines (N, 2) in undistorted pixels, to be drawn in one colour and width."""

    lines: tuple[Array, ...]
    color: Color
    width: float


def ball_strokes(cell: Cell, report: Report | None, active: int) -> Iterator[Stroke]:
    """The outline of every ball: where it was found, or, if it was not, where it should be."""
    if report is None:
        return
    for i, seen in enumerate(report.sightings):
        ball = seen.ball or _expected(cell, i)
        if ball is None:
            continue
        pixels = outline_pixels(
            cell.camera.intrinsics.undistorted(), ball[:3], ball[3], OUTLINE_POINTS
        )
        lines = tuple(finite_parts(np.concatenate([pixels, pixels[:1]])))
        yield from haloed(lines, STATUS_COLORS[seen.status], 2.6 if i == active else 1.5)


def object_strokes(thing: Primitive, camera: Camera, active: bool) -> Iterator[Stroke]:
    """The wire-frame of an object, hidden edges faint."""
    color = YELLOW if active else SKY
    pinhole = replace(camera, intrinsics=camera.intrinsics.undistorted())
    frame = wireframe(thing, pinhole)
    hidden = tuple(line.pixels for line in frame if not line.visible)
    yield Stroke(hidden, (*color[:3], 0.5), 1.0)
    seen = tuple(line.pixels for line in frame if line.visible)
    yield from haloed(seen, color, 1.8)


def haloed(lines: tuple[Array, ...], color: Color, width: float) -> tuple[Stroke, Stroke]:
    """Lines over a darker, wider copy that keeps them readable on any picture."""
    return Stroke(lines, HALO, width + 2.0), Stroke(lines, color, width)


def _expected(cell: Cell, i: int) -> tuple[float, float, float, float] | None:
    if cell.camera.camera_from_world is None:
        return None
    sighting = cell.sightings[i]
    if not isinstance(sighting, SphereSighting) or sighting.center_world is None:
        return None
    x, y, z = cell.camera.pose.apply(sighting.center_world)
    return (float(x), float(y), float(z), sighting.radius) if z > sighting.radius else None
