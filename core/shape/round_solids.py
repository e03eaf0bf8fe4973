# SPDX-License-Identifier: GPL-3.0-or-later
"""Cylinders, cones, tubes and spheres as seen from an eye point: rims and exact silhouettes.

Sight touches a side whose outward normal at angle a is (cos a, sin a, slope) where
`normal . eye = middle radius`: two lines, not a polygon's guess of them.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..arrays import Array
from .curve_set import CurveRow, CurveSet, Vector, curve_set

# an arc shorter than this (in radians) is a touching point
SHORTEST_ARC = 1e-9
NOTHING = (0.0, 0.0, 0.0)
X, Y = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)


def cylinder_curves(parameters: Array, eye: Array) -> CurveSet:
    """Of (radius, height): `base rim`, `top rim` and the silhouettes `side-`, `side+`."""
    radius, height = parameters
    rows = _outside(radius, radius, height, eye, (0, 0, 1))
    return curve_set(list(rows), 2)


def cone_curves(parameters: Array, eye: Array) -> CurveSet:
    """Of (radius, top_radius, height), named as a cylinder's."""
    radius, top, height = parameters
    return curve_set(list(_outside(radius, top, height, eye, (0, 1, 2))), 3)


def tube_curves(parameters: Array, eye: Array) -> CurveSet:
    """Of (radius, inner_radius, height): a cylinder's curves and `base hole`, `top hole`."""
    radius, inner, height = parameters
    rows = [*_outside(radius, radius, height, eye, (0, 0, 2))]
    for side, name in ((-1.0, "base hole"), (1.0, "top hole")):
        near = side * eye[2] > height / 2
        far_arc = _seen_through(inner, height, eye, side)
        if near:
            arcs = [(-np.pi, np.pi, True)]
        else:
            middle = float(np.arctan2(eye[1], eye[0])) + np.pi
            arcs = [
                (middle - far_arc, middle + far_arc, True),
                (middle + far_arc, middle + 2 * np.pi - far_arc, False),
            ]
        rows += [
            _rim(name, inner, side, height, (1, 2), (start, end), seen, not near)
            for start, end, seen in arcs
            if end - start > SHORTEST_ARC
        ]
    return curve_set(rows, 3)


def sphere_curves(parameters: Array, eye: Array) -> CurveSet:
    """Of (radius,): the circle where sight touches, `outline`; none from inside."""
    radius, away = float(parameters[0]), float(np.linalg.norm(eye))
    if away <= abs(radius):
        return curve_set([], 1)
    towards = eye / away
    across = np.cross(towards, np.eye(3)[int(np.argmin(np.abs(towards)))])
    across = across / np.linalg.norm(across)
    ring = float(np.sqrt(1 - (radius / away) ** 2))
    # a touching point is the radius times its outward normal, and follows the radius along that
    middle, first, second = (
        towards * (radius / away),
        across * ring,
        np.cross(towards, across) * ring,
    )
    by = {0: (middle, first, second)}
    places = radius * middle, radius * first, radius * second
    return curve_set([CurveRow("outline", *places, by, True, (-np.pi, np.pi), True, True)], 1)


def _outside(
    radius: float, top: float, height: float, eye: Array, places: tuple[int, int, int]
) -> Iterator[CurveRow]:
    """The rims and silhouettes of a cone whose radii and height are parameters `places`."""
    limb, facing = _limb(radius, top, height, eye)
    for side, name, ring, place in (
        (-1.0, "base rim", radius, places[0]),
        (1.0, "top rim", top, places[1]),
    ):
        if ring == 0.0:
            continue
        end_seen = bool(side * eye[2] > height / 2)
        arcs = [
            (facing - limb, facing + limb, True, not end_seen),
            (facing + limb, facing + 2 * np.pi - limb, end_seen, end_seen),
        ]
        for start, end, seen, outline in arcs:
            if end - start > SHORTEST_ARC:
                yield _rim(
                    name, ring, side, height, (place, places[2]), (start, end), seen, outline
                )
    if 0.0 < limb < np.pi:
        for turn, name in ((-limb, "side-"), (limb, "side+")):
            yield _side(name, facing + turn, radius, top, height, places)


def _limb(radius: float, top: float, height: float, eye: Array) -> tuple[float, float]:
    """Half the angle over which the side faces the eye (0 to pi), and the angle it centres on."""
    distance, facing = float(np.hypot(eye[0], eye[1])), float(np.arctan2(eye[1], eye[0]))
    slope = (radius - top) / height
    reach = (radius + top) / 2 - slope * eye[2]
    if abs(reach) >= distance:
        return (0.0 if reach > 0 else np.pi), facing
    return float(np.arccos(reach / distance)), facing


def _rim(
    name: str,
    ring: float,
    side: float,
    height: float,
    places: tuple[int, int],
    ends: tuple[float, float],
    visible: bool,
    outline: bool,
) -> CurveRow:
    by = {places[0]: (NOTHING, X, Y), places[1]: ((0.0, 0.0, side / 2), NOTHING, NOTHING)}
    level = (0.0, 0.0, side * height / 2)
    return CurveRow(name, level, (ring, 0, 0), (0, ring, 0), by, True, ends, visible, outline)


def _side(
    name: str, angle: float, radius: float, top: float, height: float, places: tuple[int, int, int]
) -> CurveRow:
    """The touching line at `angle`, from the base (t = -1) to the top (t = 1)."""
    out = np.array([np.cos(angle), np.sin(angle), 0.0])
    base, upper, tall = places
    by: dict[int, tuple[Vector, Vector, Vector]] = {
        base: (out / 2, -out / 2, NOTHING),
        upper: (out / 2, out / 2, NOTHING),
        tall: (NOTHING, (0.0, 0.0, 0.5), NOTHING),
    }
    if base == upper:
        by[base] = (out, np.zeros(3), NOTHING)
    along = (top - radius) / 2 * out + [0.0, 0.0, height / 2]
    middle = (radius + top) / 2 * out
    return CurveRow(name, middle, along, NOTHING, by, False, (-1.0, 1.0), True, True)


def _seen_through(inner: float, height: float, eye: Array, side: float) -> float:
    """Half the arc of the far hole's rim, opposite the eye, that is seen through the near hole."""
    above = -side * eye[2]
    if above <= height / 2:
        return 0.0
    share, distance = height / (above + height / 2), float(np.hypot(eye[0], eye[1]))
    rest = 1 - share
    if distance < 1e-12:
        return np.pi
    # the crossing of the near plane, rest * rim point + share * eye, lies within the hole
    cosine = (inner**2 * (1 - rest**2) - (share * distance) ** 2) / (
        2 * share * rest * inner * distance
    )
    return float(np.pi - np.arccos(np.clip(cosine, -1.0, 1.0)))
