# SPDX-License-Identifier: GPL-3.0-or-later
"""Exact volume, centre of mass and inertia of the solids, filled evenly."""

from __future__ import annotations

import numpy as np

from ..arrays import Array
from ..primitives import Box, Cone, Cylinder, Primitive, Prism, Sphere, Tube
from .polygons import polygon_area


def volume(thing: Primitive) -> float:
    """The volume in cubic metres. Raises TypeError for a kind that is none of ours."""
    if isinstance(thing, Box):
        return float(np.prod(thing.size))
    if isinstance(thing, Sphere):
        return float(4 / 3 * np.pi * thing.radius**3)
    if isinstance(thing, Cylinder):
        return float(np.pi * thing.radius**2 * thing.height)
    if isinstance(thing, Tube):
        return float(np.pi * (thing.radius**2 - thing.inner_radius**2) * thing.height)
    if isinstance(thing, Cone):
        low, high = thing.radius, thing.top_radius
        return float(np.pi / 3 * thing.height * (low**2 + low * high + high**2))
    if isinstance(thing, Prism):
        return polygon_area(thing.polygon) * thing.height
    raise TypeError(f"{thing.kind}: its volume is not known")


def centre_of_mass(thing: Primitive) -> Array:
    """The centre of mass (3,) in the object's frame, metres: the origin, but for a cone."""
    if not isinstance(thing, Cone):
        return np.zeros(3)
    low, high = thing.radius, thing.top_radius
    up = (low**2 + 2 * low * high + 3 * high**2) / (low**2 + low * high + high**2) / 4
    return np.array([0.0, 0.0, (up - 0.5) * thing.height])


def inertia(thing: Primitive) -> Array:
    """The inertia (3, 3) of a mass of 1 kg about the centre of mass, in the object's axes, m^2.

    Raises TypeError for a kind that is none of ours.
    """
    xx, yy, zz, xy = _second_moments(thing)
    return np.array([[yy + zz, -xy, 0.0], [-xy, xx + zz, 0.0], [0.0, 0.0, xx + yy]])


def _second_moments(thing: Primitive) -> tuple[float, float, float, float]:
    """The means of x^2, y^2, z^2 and x y about the centre of mass."""
    if isinstance(thing, Box):
        xx, yy, zz = thing.size**2 / 12
        return float(xx), float(yy), float(zz), 0.0
    if isinstance(thing, Sphere):
        return (thing.radius**2 / 5,) * 3 + (0.0,)
    if isinstance(thing, Prism):
        return _prism_moments(thing)
    if isinstance(thing, Cone):
        return _cone_moments(thing)
    if isinstance(thing, Cylinder | Tube):
        inner = thing.inner_radius if isinstance(thing, Tube) else 0.0
        across = (thing.radius**2 + inner**2) / 4
        return across, across, thing.height**2 / 12, 0.0
    raise TypeError(f"{thing.kind}: its inertia is not known")


def _cone_moments(cone: Cone) -> tuple[float, float, float, float]:
    low, high = cone.radius, cone.top_radius
    # integrals of r^2, r^2 s^2 and r^4 over the way s up, with r going evenly from low to high
    area = (low**2 + low * high + high**2) / 3
    second = (low**2 + 3 * low * high + 6 * high**2) / 30
    fourth = sum(low**i * high ** (4 - i) for i in range(5)) / 5
    middle = float(centre_of_mass(cone)[2]) / cone.height + 0.5
    across = fourth / area / 4
    return across, across, cone.height**2 * (second / area - middle**2), 0.0


def _prism_moments(prism: Prism) -> tuple[float, float, float, float]:
    polygon, after = prism.polygon, np.roll(prism.polygon, -1, axis=0)
    cross = _fans(polygon)
    squares = ((polygon**2 + polygon * after + after**2) * cross[:, None]).sum(axis=0) / 6
    mixed = 2 * polygon * polygon[:, ::-1] + 2 * after * after[:, ::-1]
    mixed = mixed[:, 0] + polygon[:, 0] * after[:, 1] + after[:, 0] * polygon[:, 1]
    xx, yy = squares / cross.sum()
    xy = float((mixed * cross).sum() / 12 / cross.sum())
    return float(xx), float(yy), prism.height**2 / 12, xy


def _fans(polygon: Array) -> Array:
    """Twice the signed area of the triangle from the origin to each side, (N,)."""
    after = np.roll(polygon, -1, axis=0)
    double: Array = polygon[:, 0] * after[:, 1] - polygon[:, 1] * after[:, 0]
    return double
