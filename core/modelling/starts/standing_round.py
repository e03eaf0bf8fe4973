# SPDX-License-Identifier: GPL-3.0-or-later
"""The rays of a round solid that stands on a plane in, every shape of it worth a descent out.

A few picks can fit two solids: a pick of the far circle may lie on its near or its far side. All
that fit are tried.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from ...arrays import Array

# guesses of an unknown height, in shares of the camera's height above the plane
HEIGHT_LADDER = (0.03, 0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 0.92)
# a cone's rims differ, so that its height has to be guessed closer
CONE_HEIGHTS = tuple(0.02 * 1.18**i for i in range(24))
# guesses of the distance when nothing measures it, in camera heights
DISTANCE_LADDER = (0.3, 0.6, 1.0, 1.6, 2.5, 4.0, 7.0)
# how far behind the picks of its rim the middle of a cone may be, in distances of these
MIDDLE_LADDER = (1.02, 1.05, 1.09, 1.14, 1.22)
# guesses of one radius of a cone from the other
TAPERS = (0.0, 0.4, 0.8, 1.3, 2.0)
DIRECTIONS = 8


@dataclass(frozen=True, eq=False)
class StandingRays:
    """Picks as seen from `origin` (3,) in the plane's frame.

    `near` (N, 2) are points of the circle on the plane, mapped onto it; `far` (of the other
    circle), `sides` and `apex` (N, 3) unit rays.
    """

    origin: Array
    near: Array
    far: Array
    sides: Array
    apex: Array


def cylinders_on(rays: StandingRays, known: Mapping[str, float]) -> Iterator[Array]:
    """(x, y, radius, height) in the plane's frame; `known` may hold `radius` and `height`."""
    radius = known.get("radius")
    if "height" in known:
        circle = np.concatenate([rays.near, _pierce(rays, rays.far, known["height"])])
        for base in _bases(rays, circle, radius):
            yield np.array([*base, known["height"]])
        return
    if len(rays.near) >= 3 or len(rays.sides) >= 2:
        for base in _bases(rays, rays.near, radius):
            for height in _heights(rays, base):
                yield np.array([*base, height])
    if len(rays.near) < 3:
        for height in np.array(HEIGHT_LADDER) * abs(rays.origin[2]):
            circle = np.concatenate([rays.near, _pierce(rays, rays.far, height)])
            for base in _bases(rays, circle, radius):
                yield np.array([*base, height])


def cones_on(rays: StandingRays, known: Mapping[str, float]) -> Iterator[Array]:
    """(x, y, near radius, far radius, height); `known` may hold `near`, `far` and `height`."""
    for x, y, near in _near_circles(rays, known):
        for height in _cone_heights(rays, np.array([x, y]), known):
            far = _around_at(rays, rays.far, np.array([x, y]), height)
            fars = [known.get("far", far)] if far is not None or "far" in known else None
            for taper in fars if fars is not None else [t * near for t in TAPERS]:
                yield np.array([x, y, near, taper, height])
    # the far circle at a height tells the middle, too
    if len(rays.far) >= 3:
        for height in _cone_heights(rays, None, known):
            circle = _circle(_pierce(rays, rays.far, height))
            if circle is not None:
                middle = circle[:2]
                near = np.linalg.norm(rays.near - middle, axis=1)
                radii = [float(np.median(near))] if len(near) else circle[2] * np.array(TAPERS[1:])
                for radius in radii:
                    yield np.array([*middle, known.get("near", radius), circle[2], height])


def _near_circles(rays: StandingRays, known: Mapping[str, float]) -> Iterator[Array]:
    if len(rays.near):
        yield from _bases(rays, rays.near, known.get("near"))
    if 0 < len(rays.near) < 3:
        # sides lean, so that they tell no wedge: the middle lies behind the picks, somewhere
        middle = rays.near.mean(axis=0) - rays.origin[:2]
        for share in MIDDLE_LADDER:
            centre = rays.origin[:2] + share * middle
            away = float(np.median(np.linalg.norm(rays.near - centre, axis=1)))
            yield np.array([*centre, known.get("near", away)])
    if len(rays.near) < 3 and len(rays.apex):
        # a point that stands upright over the middle, wherever its ray passes
        for height in np.array(HEIGHT_LADDER) * abs(rays.origin[2]):
            middle = _pierce(rays, rays.apex, height)
            if len(middle):
                away = np.linalg.norm(rays.near - middle[0], axis=1)
                radius = known.get("near", float(np.median(away)) if len(away) else height / 2)
                yield np.array([*middle[0], radius])


def _cone_heights(
    rays: StandingRays, middle: Array | None, known: Mapping[str, float]
) -> list[float]:
    if "height" in known:
        return [known["height"]]
    if len(rays.apex) and middle is not None:
        ray, away = rays.apex[0], middle - rays.origin[:2]
        flat = float(ray[:2] @ ray[:2])
        if flat > 1e-12:
            return [float(rays.origin[2] + ray[2] * (ray[:2] @ away) / flat)]
    return [share * abs(float(rays.origin[2])) for share in CONE_HEIGHTS]


def _around_at(rays: StandingRays, circle: Array, middle: Array, height: float) -> float | None:
    """The radius of a circle at a height about a known middle."""
    points = _pierce(rays, circle, height)
    return float(np.median(np.linalg.norm(points - middle, axis=1))) if len(points) else None


def _pierce(rays: StandingRays, through: Array, height: float) -> Array:
    """Where rays pierce the level of `height`, (N, 2), those that do in front."""
    with np.errstate(divide="ignore", invalid="ignore"):
        depth = (height - rays.origin[2]) / through[:, 2]
    met = (depth > 0) & np.isfinite(depth)
    return rays.origin[:2] + depth[met, None] * through[met, :2]


def _bases(rays: StandingRays, circle: Array, radius: float | None) -> Iterator[Array]:
    """Base circles (x, y, radius) from points on one circle and from the two sides."""
    wedge = _wedge(rays, circle)
    if len(circle) >= 3:
        fitted = _circle(circle)
        if fitted is not None:
            yield fitted if radius is None else np.array([*fitted[:2], radius])
    if wedge is not None:
        azimuth, sine = wedge
        for distance in _distances(rays, circle, azimuth, sine, radius):
            yield np.array([*(rays.origin[:2] + distance * azimuth), distance * sine])
    if len(circle) and (len(circle) < 3 or wedge is None):
        yield from _around(circle, radius, rays.origin)


def _wedge(rays: StandingRays, circle: Array) -> tuple[Array, float] | None:
    """The direction (2,) half way between the two sides, and the sine of half their angle."""
    flat = rays.sides[:, :2]
    flat = flat[np.linalg.norm(flat, axis=1) > 1e-9]
    if len(flat) < 2:
        return None
    middle = flat.mean(axis=0)
    if len(circle):
        middle = (circle - rays.origin[:2]).mean(axis=0)
    bearing = np.arctan2(middle[0] * flat[:, 1] - middle[1] * flat[:, 0], flat @ middle)
    left, right = bearing[bearing > 0], bearing[bearing <= 0]
    if not len(left) or not len(right):
        return None
    half = 0.5 * float(left.mean() - right.mean())
    absolute = np.arctan2(middle[1], middle[0]) + 0.5 * float(left.mean() + right.mean())
    return np.array([np.cos(absolute), np.sin(absolute)]), float(np.sin(half))


def _distances(
    rays: StandingRays, circle: Array, azimuth: Array, sine: float, radius: float | None
) -> list[float]:
    """Distances of an axis whose cylinder touches both sides of the wedge: radius = distance sine.

    A point q of the circle gives |q - D u|^2 = D^2 sine^2: on the near half, or on the far.
    """
    if radius is not None:
        return [radius / sine]
    if not len(circle):
        return [share * abs(rays.origin[2]) for share in DISTANCE_LADDER]
    q = circle - rays.origin[:2]
    along, cosine2 = q @ azimuth, 1 - sine**2
    root = np.sqrt(np.maximum(along**2 - cosine2 * (q * q).sum(1), 0.0))
    far, near = float(np.median(along - root)), float(np.median(along + root))
    return [d / cosine2 for d in (near, far) if d > 0]


def _circle(points: Array) -> Array | None:
    """(x, y, radius) of the circle nearest to points (N, 2) (Kasa 1976); None for a line."""
    if len(points) < 3:
        return None
    centre = points.mean(axis=0)
    q = points - centre
    scale = float(np.sqrt((q * q).sum(1).mean()))
    if scale < 1e-12:
        return None
    q = q / scale
    design = np.column_stack([2 * q, np.ones(len(q))])
    if np.linalg.cond(design) > 1e6:
        return None
    (x, y, rest), *_ = np.linalg.lstsq(design, (q * q).sum(1), rcond=None)
    return np.array([*(centre + scale * np.array([x, y])), scale * np.sqrt(rest + x * x + y * y)])


def _around(circle: Array, radius: float | None, origin: Array) -> Iterator[Array]:
    """Circles through the middle of a few points, in every direction and of several sizes."""
    middle = circle.mean(axis=0)
    spread = float(np.sqrt(((circle - middle) ** 2).sum(1).max()))
    away = float(np.linalg.norm(np.array([*middle, 0.0]) - origin))
    sizes = [radius] if radius is not None else [s * max(spread, 0.03 * away) for s in (1.0, 2.0)]
    for size in sizes:
        for i in range(DIRECTIONS):
            angle = 2 * np.pi * i / DIRECTIONS
            offset = np.sqrt(max(size**2 - spread**2, (0.1 * size) ** 2))
            yield np.array([*(middle + offset * np.array([np.cos(angle), np.sin(angle)])), size])


def _heights(rays: StandingRays, base: Array) -> list[float]:
    """The heights at which the far rays enter and leave the endless cylinder over the base."""
    o, d = rays.origin[:2] - base[:2], rays.far[:, :2]
    a = np.maximum((d * d).sum(1), 1e-18)
    b, c = d @ o, float(o @ o) - base[2] ** 2
    # a ray that passes the cylinder by counts where it is nearest
    root = np.sqrt(np.maximum(b * b - a * c, 0.0))
    levels = [rays.origin[2] + rays.far[:, 2] * (-b + sign * root) / a for sign in (-1.0, 1.0)]
    if len(rays.far) > 2:
        # with more picks the middle ones of both will do
        levels = [np.sort(level)[[0, len(level) // 2, -1]] for level in levels]
    # one pick may lie on the near side of the circle and the next on the far side
    return sorted({round(float(level), 4) for level in np.concatenate(levels)})
