# SPDX-License-Identifier: GPL-3.0-or-later
"""A cell, its objects and its last calibration in, the lines to draw over the picture out.

All in pixels of the undistorted view, which changes neither with zoom nor with pan.
"""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from ...core.arrays import Array
from ...core.ball.sphere import outline_pixels
from ...core.camera import Camera
from ...core.cell import Cell
from ...core.picture.wireframe import BEND_PIXELS, finite_parts, wireframe
from ...core.primitives import Primitive
from ...core.sighting import PointSighting, SphereSighting
from ..camera.report import Report
from ..lengths import length
from ..picking.pick_handles import view_pixels
from ..settings import DEFAULTS, Settings
from .drawing import GREY, HALO, WHITE, YELLOW, Color, Floats, ends_of
from .plane_grid import PlaneGrid

# what an outline is left with after the fit, in pixels: as good as pictures allow, and no longer so
FINE_PIXELS, POOR_PIXELS = 0.1, 0.6
# orange at least
DOUBTFUL_SHARE = 2 / 3
LONGEST_REASON = 40
CROSS_PIXELS = 7.0
# a pick's ring, pixels about it
RING = 3.5 * np.stack([np.cos(np.linspace(0, 6.3, 17)), np.sin(np.linspace(0, 6.3, 17))], axis=1)
ELSEWHERE = 0.55

Look = tuple[Color, float]
Looks = dict[Look, Floats]


@dataclass(frozen=True, eq=False)
class Stroke:
    """Polylines (N, 2) in undistorted pixels, to be drawn in one colour and width."""

    lines: tuple[Array, ...]
    color: Color
    width: float


@dataclass(frozen=True, eq=False)
class Label:
    """Words that start at an undistorted pixel (2,)."""

    pixel: Array
    text: str
    color: Color


def sighting_strokes(
    cell: Cell,
    report: Report | None,
    active: int,
    settings: Settings = DEFAULTS,
    shown: str | None = None,
) -> Iterator[Stroke]:
    """Outlines of the balls, crosses of the points, the active window and the advised places.

    Those that belong to another picture than `shown` are fainter.
    """
    for i, sighting in enumerate(cell.sightings):
        width = settings.line_width + (1.1 if i == active else 0.0)
        lines = _sighting_lines(cell, report, i)
        color = sighting_color(report, i, sighting.use, settings)
        if lines and shown in (None, sighting.picture):
            yield from haloed(lines, color, width)
        elif lines:
            # of another picture than the one that is shown
            yield Stroke(lines, (*color[:3], ELSEWHERE * color[3]), width)
        if i == active and isinstance(sighting, SphereSighting) and sighting.window is not None:
            yield from haloed((_rectangle(cell, sighting.window),), WHITE, 1.0)
    for place in report.advice if report is not None else ():
        x, y, z = cell.camera.pose.apply(np.array(place.place))
        radius = place.radius_pixels / cell.camera.intrinsics.fx * float(z)
        yield Stroke(
            _outline(cell, (float(x), float(y), float(z), radius)), settings.advice_color, 1.5
        )


def sighting_labels(
    cell: Cell, report: Report | None, settings: Settings = DEFAULTS
) -> Iterator[Label]:
    """The number of each sighting at its outline; the doubtful say why."""
    for i, sighting in enumerate(cell.sightings):
        lines = _sighting_lines(cell, report, i)
        if not lines:
            continue
        points = np.concatenate(lines)
        corner = np.array([points[:, 0].max(), points[:, 1].min()])
        told = f"{i + 1}"
        if report is not None and report.sightings[i].reason:
            told += "  " + textwrap.shorten(
                report.sightings[i].reason, LONGEST_REASON, placeholder=" ..."
            )
        yield Label(corner, told, sighting_color(report, i, sighting.use, settings))
    for k, place in enumerate(report.advice if report is not None else ()):
        told = f"next {k + 1}: {length(1e-3 * place.sigma_millimetres, settings.unit, finer=1)}"
        yield Label(_view_pixels(cell, [place.pixel])[0], told, settings.advice_color)


def sighting_color(
    report: Report | None, i: int, use: bool, settings: Settings = DEFAULTS
) -> Color:
    """Green for an outline that the pose explains, over yellow to red as more of it is left."""
    if not use:
        return GREY
    seen = report.sightings[i] if report is not None else None
    if seen is None or not seen.status:
        return WHITE
    if seen.status == "rejected":
        return settings.rejected_color
    if seen.rms_pixels is None:
        return settings.object_color
    share = (seen.rms_pixels - FINE_PIXELS) / (POOR_PIXELS - FINE_PIXELS)
    if seen.status == "doubtful":
        share = max(share, DOUBTFUL_SHARE)
    stops = np.array(
        [settings.good_color, YELLOW, settings.doubtful_color, settings.rejected_color]
    )
    r, g, b, a = (float(np.interp(np.clip(share, 0, 1) * 3, range(4), c)) for c in stops.T)
    return (r, g, b, a)


def grid_strokes(grid: PlaneGrid, settings: Settings = DEFAULTS) -> Iterator[Stroke]:
    """The lines of the active reference, every fifth one stronger."""
    r, g, b, a = settings.grid_color
    yield Stroke(grid.fine, (r, g, b, a * 0.6), 1.0)
    yield Stroke(grid.major, (r, g, b, min(2 * a, 1.0)), 1.0)


def object_strokes(
    thing: Primitive, camera: Camera, active: bool, settings: Settings = DEFAULTS
) -> Iterator[Stroke]:
    """The wire-frame of an object, hidden edges faint; of the active one the picks, as rings."""
    color = settings.active_color if active else settings.object_color
    pinhole = replace(camera, intrinsics=camera.intrinsics.undistorted())
    frame = wireframe(thing, pinhole)
    hidden = tuple(line.pixels for line in frame if not line.visible)
    yield Stroke(hidden, (*color[:3], 0.5 * color[3]), 1.0)
    seen = tuple(line.pixels for line in frame if line.visible)
    yield from haloed(seen, color, settings.line_width + 0.2)
    if active and thing.picks:
        picks = view_pixels(camera, thing)
        rings = tuple(pick + RING for pick in picks[np.isfinite(picks).all(axis=1)])
        yield from haloed(rings, WHITE, 1.2)


def looks_of(strokes: Iterable[Stroke]) -> Looks:
    """The ends of all lines of each colour and width."""
    looks: dict[Look, list[Array]] = {}
    for stroke in strokes:
        looks.setdefault((stroke.color, stroke.width), []).extend(stroke.lines)
    return {look: ends_of(lines) for look, lines in looks.items()}


def joined(many: Iterable[Looks]) -> Looks:
    """The same of many objects, in as few as there are looks, halos first."""
    looks: dict[Look, list[Floats]] = {}
    for one in many:
        for look, ends in one.items():
            looks.setdefault(look, []).append(ends)
    ordered = sorted(looks.items(), key=lambda item: item[0][0] != HALO)
    return {look: np.concatenate(ends) for look, ends in ordered}


def haloed(lines: tuple[Array, ...], color: Color, width: float) -> tuple[Stroke, Stroke]:
    """Lines over a darker, wider copy that keeps them readable on any picture."""
    return Stroke(lines, HALO, width + 2.0), Stroke(lines, color, width)


def _sighting_lines(cell: Cell, report: Report | None, i: int) -> tuple[Array, ...]:
    """A ball's outline where it was found or else should be; a cross where a point was clicked."""
    sighting = cell.sightings[i]
    if isinstance(sighting, PointSighting):
        (u, v) = _view_pixels(cell, sighting.pixel[None])[0]
        arm = CROSS_PIXELS
        ways = ([[u - arm, v], [u + arm, v]], [[u, v - arm], [u, v + arm]])
        return tuple(np.array(way) for way in ways) if np.isfinite([u, v]).all() else ()
    if report is None:
        return ()
    ball = report.sightings[i].ball
    if ball is None and report.sightings[i].status:
        ball = _expected(cell, i)
    return () if ball is None else _outline(cell, ball)


def _outline(cell: Cell, ball: tuple[float, float, float, float]) -> tuple[Array, ...]:
    pinhole = cell.camera.intrinsics.undistorted()
    radius = pinhole.fx * ball[3] / ball[2]
    # a chord of n leaves its circle by r (1 - cos(pi / n)), about r pi^2 / 2 n^2
    count = math.ceil(math.pi * math.sqrt(max(radius, 1.0) / (2 * BEND_PIXELS)))
    pixels = outline_pixels(pinhole, ball[:3], ball[3], count)
    return tuple(finite_parts(np.concatenate([pixels, pixels[:1]])))


def _rectangle(cell: Cell, window: tuple[float, float, float, float]) -> Array:
    """A window of the picture as it came, as the undistorted view shows it."""
    x, y, width, height = window
    along = np.linspace(0, 1, 12)[:, None]
    corners = np.array([[x, y], [x + width, y], [x + width, y + height], [x, y + height], [x, y]])
    sides = [a + along * (b - a) for a, b in pairwise(corners)]
    seen = _view_pixels(cell, np.concatenate(sides))
    return seen[np.isfinite(seen).all(axis=1)]


def _view_pixels(cell: Cell, pixels: ArrayLike) -> Array:
    intrinsics = cell.camera.intrinsics
    return intrinsics.undistorted().project(intrinsics.rays(np.asarray(pixels, dtype=float)))


def _expected(cell: Cell, i: int) -> tuple[float, float, float, float] | None:
    if cell.camera.camera_from_world is None:
        return None
    sighting = cell.sightings[i]
    if not isinstance(sighting, SphereSighting) or sighting.center_world is None:
        return None
    x, y, z = cell.camera.pose.apply(sighting.center_world)
    return (float(x), float(y), float(z), sighting.radius) if z > sighting.radius else None
