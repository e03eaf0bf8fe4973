# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects and a camera in, the pixel lines of their edges and outlines out, visible or hidden.

Lines follow the lens: they bend with its distortion, and end where the lens or the camera's own
plane ends them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, Mask
from ..camera import Camera
from ..errors import InvalidValue
from ..primitives import KINDS, Primitive
from ..shape.world_curves import WorldCurves, world_curves

# a line is cut in two where its middle leaves the chord by more than this
BEND_PIXELS = 0.05
ROUNDS = 14
LINE_SAMPLES, CIRCLE_SAMPLES = 5, 33
# what lands farther away than so many picture sizes is as good as behind the camera
FARTHEST_PICTURES = 10.0


@dataclass(frozen=True, eq=False)
class Polyline:
    """Pixels (N, 2) joined in order; `visible` is False for what the object itself hides."""

    pixels: Array
    visible: bool


def wireframe(thing: Primitive, camera: Camera) -> tuple[Polyline, ...]:
    """Every edge and outline of one object, see `wireframes`."""
    return wireframes([thing], camera)[0]


def wireframes(things: Sequence[Primitive], camera: Camera) -> tuple[tuple[Polyline, ...], ...]:
    """Every edge, rim and exact silhouette of the objects as the camera's lens images them.

    A line is hidden where its own object hides it; other objects in front are not looked at. All
    objects' lines are sampled together, until no chord leaves its curve by more than 0.05 px, and
    end within 1e-4 of the first sampling of where the imaging ends.

    Raises InvalidValue for an object of no kind that is known, NoPose without a camera pose.
    """
    for thing in things:
        if thing.kind not in KINDS:
            raise InvalidValue(f"{thing.name}: a {thing.kind} has no wire-frame")
    curves = world_curves(things, camera)
    owner, pixels = _sampled(curves, camera)
    frames: list[list[Polyline]] = [[] for _ in things]
    starts = np.flatnonzero(np.diff(owner)) + 1
    if len(owner):
        for i, part in zip(owner[[0, *starts]], np.split(pixels, starts), strict=True):
            visible = bool(curves.visible[i])
            frames[int(curves.owner[i])] += [Polyline(p, visible) for p in finite_parts(part)]
    return tuple(tuple(frame) for frame in frames)


def finite_parts(pixels: Array) -> list[Array]:
    """The runs of two or more imaged points among pixels (N, 2) with NaN between them."""
    seen = np.isfinite(pixels[:, 0])
    if seen.all():
        return [pixels] if len(pixels) > 1 else []
    starts = np.flatnonzero(np.diff(seen.astype(int))) + 1
    parts = np.split(pixels, starts)
    return [part for part in parts if len(part) > 1 and np.isfinite(part[0, 0])]


def _sampled(curves: WorldCurves, camera: Camera) -> tuple[NDArray[np.intp], Array]:
    """The curve of every sample and its pixel, (S,) and (S, 2), in order along each curve."""
    owner, t = _first_samples(curves)
    pixels = _imaged(curves, owner, t, camera)
    for _ in range(ROUNDS):
        joined = np.flatnonzero(owner[1:] == owner[:-1])
        middles = 0.5 * (t[joined] + t[joined + 1])
        between = _imaged(curves, owner[joined], middles, camera)
        wanted = _wanted(pixels[joined], pixels[joined + 1], between)
        if not wanted.any():
            break
        places = joined[wanted] + 1
        t = np.insert(t, places, middles[wanted])
        pixels = np.insert(pixels, places, between[wanted], axis=0)
        owner = np.insert(owner, places, owner[places])
    return owner, pixels


def _first_samples(curves: WorldCurves) -> tuple[NDArray[np.intp], Array]:
    counts = np.where(curves.round, CIRCLE_SAMPLES, LINE_SAMPLES)
    owner = np.repeat(np.arange(len(counts)), counts)
    place = np.arange(len(owner)) - np.repeat(np.cumsum(counts) - counts, counts)
    share = place / np.maximum(counts[owner] - 1, 1)
    start, end = curves.ends[owner].T if len(owner) else np.zeros((2, 0))
    return owner, start + share * (end - start)


def _imaged(curves: WorldCurves, owner: NDArray[np.intp], t: Array, camera: Camera) -> Array:
    pixels = camera.project(curves.points(owner, t))
    inner = camera.intrinsics
    middle = np.array([inner.width, inner.height]) / 2
    reach = FARTHEST_PICTURES * max(inner.width, inner.height)
    # a comparison with NaN is false, so that what is not imaged stays NaN
    pixels[~(np.abs(pixels - middle) < reach).all(axis=1)] = np.nan
    return pixels


def _wanted(starts: Array, ends: Array, between: Array) -> Mask:
    """Which chords need their middle: bent ones, and those where the imaging begins or ends."""
    along = ends - starts
    bend = np.linalg.norm(between - 0.5 * (starts + ends), axis=1)
    chord = np.linalg.norm(along, axis=1)
    # along a straight line perspective shifts the middle, which needs no cut: only the part of the
    # shift across the chord counts
    across = _cross(along, between - starts) / np.maximum(chord, 1e-9)
    bent = np.abs(np.where(chord > 1e-9, across, bend)) > BEND_PIXELS
    seen = np.isfinite(starts[:, 0]).astype(int)
    count = seen + np.isfinite(between[:, 0]) + np.isfinite(ends[:, 0])
    cut = (count > 0) & (count < 3)
    wanted: Mask = bent | cut
    return wanted


def _cross(a: Array, b: Array) -> Array:
    product: Array = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    return product
