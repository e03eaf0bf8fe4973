# SPDX-License-Identifier: GPL-3.0-or-later
"""Where rays run inside a solid: a solid and rays in its own frame in, where they go in and out.

A solid is cut from slabs, cones and polygons. Each of these turns a ray into the stretches of it
that lie inside, and cutting is the intersection of stretches: no ray slips through between two
faces, as it can where every face is asked by itself.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..primitives import Box, Cone, Cylinder, Primitive, Prism, Sphere, Tube

Faces = NDArray[np.int16]
BOX_FACES = ("x-", "x+", "y-", "y+", "base", "top")


@dataclass(frozen=True, eq=False)
class Stretch:
    """Of each ray the part inside, (N,) from `enter` to `leave` in lengths of the ray.

    There is none where `enter` is not below `leave`. `way_in` and `way_out` (N,) are the indices of
    the faces passed there, in the order of `face_names`.
    """

    enter: Array
    leave: Array
    way_in: Faces
    way_out: Faces

    def cut(self, other: Stretch) -> Stretch:
        """The part that lies inside both."""
        later, sooner = other.enter > self.enter, other.leave < self.leave
        return Stretch(
            np.where(later, other.enter, self.enter),
            np.where(sooner, other.leave, self.leave),
            np.where(later, other.way_in, self.way_in),
            np.where(sooner, other.way_out, self.way_out),
        )


def face_names(thing: Primitive) -> tuple[str, ...]:
    """The faces of a solid by the names they have as features; curved ones are `side`.

    The inner wall of a tube is `inside`, and a sphere has one face, `surface`.
    """
    if isinstance(thing, Box):
        return BOX_FACES
    if isinstance(thing, Sphere):
        return ("surface",)
    if isinstance(thing, Prism):
        return (*(f"side{i}" for i in range(len(thing.polygon))), "base", "top")
    if isinstance(thing, Tube):
        return ("side", "base", "top", "inside")
    pointed = isinstance(thing, Cone) and thing.top_radius == 0
    return ("side", "base") if pointed else ("side", "base", "top")


def stretches(thing: Primitive, origin: Array, rays: Array) -> list[Stretch]:
    """The parts inside a solid of rays (N, 3) from `origin` (3,), both in the object's frame.

    One for a convex solid, more for a tube and a prism, in order along each ray.
    """
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        if isinstance(thing, Box):
            return [_box(thing, origin, rays)]
        if isinstance(thing, Sphere):
            return [_ball(thing.radius, origin, rays)]
        if isinstance(thing, Prism):
            return _prism(thing, origin, rays)
        if isinstance(thing, Tube):
            return _tube(thing, origin, rays)
        if isinstance(thing, Cone):
            return [_frustum(thing.radius, thing.top_radius, thing.height, origin, rays)]
        if isinstance(thing, Cylinder):
            return [_frustum(thing.radius, thing.radius, thing.height, origin, rays)]
    raise TypeError(f"{thing.kind}: no rays are cast at this kind")


def _box(box: Box, origin: Array, rays: Array) -> Stretch:
    x, y, z = (_slab(box.half_extent[i], origin[i], rays[:, i], 2 * i, 2 * i + 1) for i in range(3))
    return x.cut(y).cut(z)


def _slab(half: float, origin: float, along: Array, low: int, high: int) -> Stretch:
    """Between the planes at -half and +half, whose faces are `low` and `high`."""
    # a ray along the planes gives infinities of the right signs, but 0 / 0 on a plane itself
    ends = np.stack([(-half - origin) / along, (half - origin) / along])
    if abs(origin) == half:
        ends[:, along == 0] = np.array([[-np.inf], [np.inf]])
    upwards = along > 0
    return Stretch(
        ends.min(axis=0),
        ends.max(axis=0),
        np.where(upwards, low, high).astype(np.int16),
        np.where(upwards, high, low).astype(np.int16),
    )


def _ball(radius: float, origin: Array, rays: Array) -> Stretch:
    square = np.einsum("ij,ij->i", rays, rays)
    # the distance of the line from the centre, rather than a difference of large squares
    aside = np.cross(rays, origin)
    root = np.sqrt(square * radius**2 - np.einsum("ij,ij->i", aside, aside))
    nearest = -(rays @ origin) / square
    return _closed(nearest - root / square, nearest + root / square, 0)


def _frustum(low: float, high: float, height: float, origin: Array, rays: Array) -> Stretch:
    ends = _slab(height / 2, origin[2], rays[:, 2], 1, 2)
    return _cone((low + high) / 2, (high - low) / height, origin, rays, 0).cut(ends)


def _tube(tube: Tube, origin: Array, rays: Array) -> list[Stretch]:
    """The wall before the hollow, and the wall behind it."""
    solid = _frustum(tube.radius, tube.radius, tube.height, origin, rays)
    hollow = _cone(tube.inner_radius, 0.0, origin, rays, 3)
    # a ray that misses the hollow has all of the solid before it
    missed = ~(hollow.enter < hollow.leave)
    first = Stretch(
        np.full(len(rays), -np.inf), np.where(missed, np.inf, hollow.enter), *_face(rays, 3)
    )
    second = Stretch(
        np.where(missed, np.inf, hollow.leave), np.full(len(rays), np.inf), *_face(rays, 3)
    )
    return [solid.cut(first), solid.cut(second)]


def _cone(middle: float, slope: float, origin: Array, rays: Array, face: int) -> Stretch:
    """Inside x^2 + y^2 = r^2 with r = middle + slope z, where r is not negative.

    `a t^2 + 2 b t + c <= 0`; the discriminant is written so that no large squares cancel.
    """
    (x, y), along = rays[:, :2].T, slope * rays[:, 2]
    radius = middle + slope * origin[2]
    a = x * x + y * y - along * along
    b = x * origin[0] + y * origin[1] - radius * along
    c = origin[0] ** 2 + origin[1] ** 2 - radius**2
    across = origin[0] * y - origin[1] * x
    run = (radius * x - origin[0] * along) ** 2 + (radius * y - origin[1] * along) ** 2
    discriminant = run - across * across
    # Citardauq: neither root is the difference of two large numbers
    q = -(b + np.copysign(np.sqrt(discriminant), b))
    ends = np.sort(np.stack([q / a, c / q]), axis=0)
    # along a side, or within the cone's opening, a ray leaves but once: the other end is infinite
    opens = (a < 0) & (along > 0)
    closes = (a < 0) & ~(along > 0)
    enter = np.where(opens, ends[1], np.where(closes, -np.inf, ends[0]))
    leave = np.where(closes, ends[0], np.where(opens, np.inf, ends[1]))
    parallel = (a == 0) & (b == 0)
    return _closed(
        np.where(parallel, -np.inf if c <= 0 else np.inf, enter),
        np.where(parallel, np.inf if c <= 0 else -np.inf, leave),
        face,
    )


def _prism(prism: Prism, origin: Array, rays: Array) -> list[Stretch]:
    sides = len(prism.polygon)
    ends = _slab(prism.height / 2, origin[2], rays[:, 2], sides, sides + 1)
    return [between.cut(ends) for between in _polygon(prism.polygon, origin[:2], rays[:, :2])]


def _polygon(corners: Array, origin: Array, rays: Array) -> list[Stretch]:
    """A line enters and leaves a simple polygon by turns where it crosses the sides."""
    after = np.roll(corners, -1, axis=0)
    # on which side of the line each corner lies: neighbours agree on theirs, so none is passed by
    left = _cross(rays[:, None], corners - origin) > 0
    crossed = left != np.roll(left, -1, axis=1)
    edges = after - corners
    where = _cross(corners - origin, edges) / _cross(rays[:, None], edges)
    where = np.where(crossed, where, np.inf)
    order = np.argsort(where, axis=1)
    where = np.take_along_axis(where, order, axis=1)
    order = order.astype(np.int16)
    upright = (rays == 0).all(axis=1)
    inside = _inside(corners, origin)
    parts = []
    for k in range(0, len(corners) - 1, 2):
        enter, leave = where[:, k].copy(), where[:, k + 1].copy()
        if k == 0:
            enter[upright & inside], leave[upright & inside] = -np.inf, np.inf
        parts.append(Stretch(enter, leave, order[:, k], order[:, k + 1]))
    return parts


def _inside(corners: Array, point: Array) -> bool:
    after = np.roll(corners, -1, axis=0)
    spans = (corners[:, 1] > point[1]) != (after[:, 1] > point[1])
    slope = (after - corners)[spans]
    at = corners[spans, 0] + (point[1] - corners[spans, 1]) * slope[:, 0] / slope[:, 1]
    return bool((at > point[0]).sum() % 2)


def _cross(a: Array, b: Array) -> Array:
    cross: Array = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    return cross


def _closed(enter: Array, leave: Array, face: int) -> Stretch:
    return Stretch(enter, leave, *_face(enter, face))


def _face(rays: Array, face: int) -> tuple[Faces, Faces]:
    faces = np.full(len(rays), face, dtype=np.int16)
    return faces, faces
