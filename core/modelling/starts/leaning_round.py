# SPDX-License-Identifier: GPL-3.0-or-later
"""The rays of a round solid that lies, leans or floats in, every place of it worth a descent out.

Both ends lie in the plane of sight through their middles, so that little is open: the depth, and
how the axis is turned in that plane. A ladder of both is held against the picks at once.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ...arrays import Array
from .held import Held
from .orientations import orientations, turned_to
from .seen import HEIGHT, Seen
from .trials import Trials

DEPTHS = (0.6, 0.72, 0.82, 0.9, 0.96, 1.0, 1.04, 1.1, 1.2, 1.35, 1.6)
RADII = (0.7, 1.0, 1.5)
# heights in radii, when only one end is picked
SLENDERNESS = (1.0, 3.0, 8.0)
ACROSS = 24
TAPER, WALL = 0.7, 0.75
AXIS = np.array([0.0, 0.0, 1.0])


def round_places(seen: Seen, held: Held, known: Mapping[int, float]) -> Trials:
    """Guesses (M,) of a round solid of which a rim or the top is picked."""
    first = _middle(seen.rim)
    second = _middle(seen.top if len(seen.top) else seen.points)
    directions = _directions(held, first, second)
    spread = _spread(seen, known)
    one = first if first is not None else second
    assert one is not None
    depths = np.array(_depths(one, seen, held, known, spread))
    depths = (depths[:, None] * DEPTHS).ravel()
    radii = [known[0]] if 0 in known else [share * spread for share in RADII]
    parts = []
    for radius in radii:
        size = np.full(len(depths), radius) if 0 in known else radius * depths
        parts.append(_at_depths(seen, held, known, directions, depths, size, (first, second)))
    return Trials.joined(parts)


def _at_depths(
    seen: Seen,
    held: Held,
    known: Mapping[int, float],
    directions: Array,
    depths: Array,
    radii: Array,
    ends: tuple[Array | None, Array | None],
) -> Trials:
    """All directions with all depths; the other end is where the axis comes nearest to its ray."""
    count, tries = len(directions), len(depths)
    axes = np.repeat(directions, tries, axis=0)
    depth, radius = np.tile(depths, count), np.tile(radii, count)
    first, second = ends
    if first is None:
        assert second is not None
        heights = _heights(known, radius, held)
        tops = seen.origin + np.tile(depth, len(heights) // len(depth))[:, None] * second
        axes, radius = _spun(axes, radius, heights)
        middles = tops - heights[:, None] / 2 * axes
    else:
        bases = seen.origin + depth[:, None] * first
        if second is None:
            heights = _heights(known, radius, held)
            bases = np.tile(bases, (len(heights) // len(depth), 1))
            axes, radius = _spun(axes, radius, heights)
        else:
            heights = _length_to_ray(bases - seen.origin, axes, second)
            if HEIGHT[held.kind] in known:
                heights = np.full(len(heights), known[HEIGHT[held.kind]])
        # the axis points from the base to the top, whatever was tried
        axes, heights = axes * np.sign(heights)[:, None], np.abs(heights)
        middles = bases + heights[:, None] / 2 * axes
    parameters = _parameters(held, known, radius, np.maximum(heights, 1e-4))
    rotations = np.array([turned_to(AXIS, axis) for axis in directions])
    turns = np.tile(np.repeat(rotations, tries, axis=0), (len(axes) // (count * tries), 1, 1))
    flipped = (turns[:, :, 2] * axes).sum(axis=1) < 0
    # half a turn about its own x, so that z points the other way
    turns[flipped] *= [1.0, -1.0, -1.0]
    return Trials(turns, middles, parameters)


def _spun(axes: Array, radii: Array, heights: Array) -> tuple[Array, Array]:
    times = len(heights) // len(axes)
    return np.tile(axes, (times, 1)), np.tile(radii, times)


def _heights(known: Mapping[int, float], radii: Array, held: Held) -> Array:
    height = known.get(HEIGHT[held.kind])
    if height is not None:
        return np.full(len(radii), height)
    return np.concatenate([share * radii for share in SLENDERNESS])


def _parameters(held: Held, known: Mapping[int, float], radii: Array, heights: Array) -> Array:
    parameters = np.empty((len(radii), held.parameters))
    parameters[:, 0] = radii
    if held.kind == "cone":
        parameters[:, 1] = TAPER * radii
    if held.kind == "tube":
        parameters[:, 1] = WALL * radii
    parameters[:, HEIGHT[held.kind]] = heights
    for i, value in known.items():
        parameters[:, i] = value
    return parameters


def _directions(held: Held, first: Array | None, second: Array | None) -> Array:
    """Unit axes (M, 3): those that what holds it allows, or that the picture does."""
    allowed = orientations(held)[:, :, 2]
    if first is None or second is None:
        return allowed
    across = np.cross(first, second)
    length = float(np.linalg.norm(across))
    if length < 1e-6 or len(allowed) <= 2:
        return allowed
    across = across / length
    if len(allowed) > ACROSS:
        # free: any turn in the plane of sight through both ends
        middle = (first + second) / np.linalg.norm(first + second)
        angle = np.pi * (np.arange(ACROSS) + 0.5) / ACROSS
        other = np.cross(across, middle)
        return np.cos(angle)[:, None] * middle + np.sin(angle)[:, None] * other
    # the middle of what was picked of a circle is not quite its centre: the neighbours, too
    off = np.abs(allowed @ across)
    return allowed[np.argsort(off)[: len(allowed) // 2 + 1]]


def _length_to_ray(bases: Array, axes: Array, ray: Array) -> Array:
    """How far along `axes` from `bases` (as seen from the eye) the ray comes nearest, (M,)."""
    across = np.eye(3) - np.outer(ray, ray)
    along, gap = axes @ across, bases @ across
    length: Array = -(along * gap).sum(axis=1) / np.maximum((along**2).sum(axis=1), 1e-9)
    return length


def _middle(rays: Array) -> Array | None:
    if not len(rays):
        return None
    middle = rays.mean(axis=0)
    unit: Array = middle / np.linalg.norm(middle)
    return unit


def _spread(seen: Seen, known: Mapping[int, float]) -> float:
    """The radius over the distance, from how far apart picks of one rim or the sides are."""
    angles = [_widest(rays) / 2 for rays in (seen.rim, seen.top, seen.sides) if len(rays) > 1]
    return max([*angles, 0.005]) if angles else 0.05


def _widest(rays: Array) -> float:
    return float(np.arccos(np.clip((rays @ rays.T).min(), -1.0, 1.0)))


def _depths(
    ray: Array, seen: Seen, held: Held, known: Mapping[int, float], spread: float
) -> list[float]:
    """How far away an end may be: where its ray comes to what holds the solid."""
    found = [known[0] / spread] if 0 in known else []
    for grip in held.grips:
        if grip.kind in ("parallel", "perpendicular"):
            continue
        gap = grip.to.point - seen.origin
        if grip.to.kind == "plane":
            height, drop = float(grip.to.direction @ gap), float(grip.to.direction @ ray)
            # its middle is about a radius above the plane
            found += [height / (drop - s) for s in (spread, 0.0) if height * (drop - s) > 0][:1]
        else:
            out = np.cross(gap, grip.to.direction) if grip.to.kind == "line" else gap
            along = np.cross(ray, grip.to.direction) if grip.to.kind == "line" else ray
            found.append(float(along @ out / max(float(along @ along), 1e-9)))
    positive = [depth for depth in found if depth > 0]
    return positive or [1.0]
