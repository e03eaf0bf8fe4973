# SPDX-License-Identifier: GPL-3.0-or-later
"""An object and a camera in, the pixel lines of its edges and outline out, visible or hidden.

Lines follow the lens: they bend with its distortion, and end where the lens or the camera's own
plane ends them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from ..arrays import Array, Mask
from ..camera import Camera
from ..errors import InvalidValue
from ..primitives import Box, Cylinder, Primitive

# a line is cut in two where its middle leaves the chord by more than this
BEND_PIXELS = 0.05
ROUNDS = 14
LINE_SAMPLES = 9
CIRCLE_SAMPLES = 49
# what lands farther away than so many picture sizes is as good as behind the camera
FARTHEST_PICTURES = 10.0
# on a circle a part shorter than this (in radians) is a touching point, not an arc
SHORTEST_ARC = 1e-9

# parameters (N,) to world points (N, 3)
Curve = Callable[[Array], Array]


@dataclass(frozen=True, eq=False)
class Polyline:
    """Pixels (N, 2) joined in order; `visible` is False for what the object itself hides."""

    pixels: Array
    visible: bool


def wireframe(thing: Primitive, camera: Camera) -> tuple[Polyline, ...]:
    """Every edge and outline of a box or cylinder as the camera's lens images it.

    A box's edge is hidden when both its faces look away. A cylinder has its two rims, the far half
    of a rim apart when it is hidden, and the two exact lines where sight touches its side. Other
    objects in front are not looked at.

    Raises InvalidValue for another kind of object, NoPose without a camera pose.
    """
    if isinstance(thing, Box):
        return _box_lines(thing, camera)
    if isinstance(thing, Cylinder):
        return _cylinder_lines(thing, camera)
    raise InvalidValue(f"{thing.name}: a {thing.kind} has no wire-frame; boxes and cylinders do")


def polylines(
    curve: Curve, ends: tuple[float, float], camera: Camera, visible: bool, samples: int
) -> list[Polyline]:
    """The image of a world curve between two parameters, in as many parts as are imaged.

    It is sampled until no chord leaves the curve by more than 0.05 px, and its ends lie within
    1e-4 of the first sampling of where the imaging ends.
    """
    parameters = np.linspace(*ends, samples)
    pixels = _imaged(curve, parameters, camera)
    for _ in range(ROUNDS):
        middles = 0.5 * (parameters[:-1] + parameters[1:])
        between = _imaged(curve, middles, camera)
        wanted = _wanted(pixels, between)
        if not wanted.any():
            break
        places = np.flatnonzero(wanted) + 1
        parameters = np.insert(parameters, places, middles[wanted])
        pixels = np.insert(pixels, places, between[wanted], axis=0)
    return [Polyline(part, visible) for part in finite_parts(pixels)]


def finite_parts(pixels: Array) -> list[Array]:
    """The runs of two or more imaged points among pixels (N, 2) with NaN between them."""
    seen = np.isfinite(pixels[:, 0])
    starts = np.flatnonzero(np.diff(seen.astype(int))) + 1
    parts = np.split(pixels, starts)
    return [part for part in parts if len(part) > 1 and np.isfinite(part[0, 0])]


def _box_lines(box: Box, camera: Camera) -> tuple[Polyline, ...]:
    corners = box.corners_world()
    eye = box.world_from_object.inverse().apply(camera.centre_world)
    # bit 0, 1, 2 of a corner's index is its side of x, y, z; an edge joins two that differ in one
    lines: list[Polyline] = []
    for i, j in combinations(range(8), 2):
        if (i ^ j).bit_count() != 1:
            continue
        others = [axis for axis in range(3) if not (i ^ j) >> axis & 1]
        visible = any(_faces_eye(eye, box.half_extent, axis, i >> axis & 1) for axis in others)
        lines += polylines(
            _segment(corners[i], corners[j]), (0.0, 1.0), camera, visible, LINE_SAMPLES
        )
    return tuple(lines)


def _faces_eye(eye: Array, half_extent: Array, axis: int, upper: int) -> bool:
    return bool((eye[axis] if upper else -eye[axis]) > half_extent[axis])


def _cylinder_lines(cylinder: Cylinder, camera: Camera) -> tuple[Polyline, ...]:
    eye = cylinder.world_from_object.inverse().apply(camera.centre_world)
    distance = float(np.hypot(eye[0], eye[1]))
    facing = float(np.arctan2(eye[1], eye[0]))
    # sight touches the side where outward . eye = radius; from within, nowhere
    outside = distance > cylinder.radius
    limb = float(np.arccos(cylinder.radius / distance)) if outside else 0.0
    lines: list[Polyline] = []
    for side in (-1.0, 1.0):
        rim = _rim(cylinder, side * cylinder.height / 2)
        if side * eye[2] > cylinder.height / 2:
            arcs = [(facing - np.pi, facing + np.pi, True)]
        else:
            arcs = [
                (facing - limb, facing + limb, True),
                (facing + limb, facing + 2 * np.pi - limb, False),
            ]
        for start, end, visible in arcs:
            if end - start > SHORTEST_ARC:
                lines += polylines(rim, (start, end), camera, visible, CIRCLE_SAMPLES)
    for angle in (facing - limb, facing + limb) if outside else ():
        foot = _rim(cylinder, -cylinder.height / 2)(np.array([angle]))[0]
        head = _rim(cylinder, cylinder.height / 2)(np.array([angle]))[0]
        lines += polylines(_segment(foot, head), (0.0, 1.0), camera, True, LINE_SAMPLES)
    return tuple(lines)


def _segment(start: Array, end: Array) -> Curve:
    return lambda t: start + t[:, None] * (end - start)


def _rim(cylinder: Cylinder, level: float) -> Curve:
    def points(angles: Array) -> Array:
        x, y = cylinder.radius * np.cos(angles), cylinder.radius * np.sin(angles)
        return cylinder.world_from_object.apply(np.stack([x, y, np.full_like(x, level)], axis=1))

    return points


def _imaged(curve: Curve, parameters: Array, camera: Camera) -> Array:
    pixels = camera.project(curve(parameters))
    inner = camera.intrinsics
    middle = np.array([inner.width, inner.height]) / 2
    reach = FARTHEST_PICTURES * max(inner.width, inner.height)
    # a comparison with NaN is false, so that what is not imaged stays NaN
    pixels[~(np.abs(pixels - middle) < reach).all(axis=1)] = np.nan
    return pixels


def _wanted(pixels: Array, between: Array) -> Mask:
    """Which chords need their middle: bent ones, and those where the imaging begins or ends."""
    bend = np.linalg.norm(between - 0.5 * (pixels[:-1] + pixels[1:]), axis=1)
    seen = np.isfinite(pixels[:, 0])
    chord = np.linalg.norm(pixels[1:] - pixels[:-1], axis=1)
    # along a straight line perspective shifts the middle, which needs no cut: only the part of the
    # shift across the chord counts
    across = _cross(pixels[1:] - pixels[:-1], between - pixels[:-1]) / np.maximum(chord, 1e-9)
    bent = np.abs(np.where(chord > 1e-9, across, bend)) > BEND_PIXELS
    count = seen[1:].astype(int) + np.isfinite(between[:, 0]) + seen[:-1]
    cut = (count > 0) & (count < 3)
    wanted: Mask = bent | cut
    return wanted


def _cross(a: Array, b: Array) -> Array:
    product: Array = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    return product
