# SPDX-License-Identifier: GPL-3.0-or-later
"""Boxes and prisms as seen from an eye point: their straight edges."""

from __future__ import annotations

import numpy as np

from ..arrays import Array
from .curve_set import CurveSet


def box_curves(parameters: Array, eye: Array) -> CurveSet:
    """The twelve edges of a box (size_x, size_y, size_z), named by their two faces (`x+top`)."""
    half = parameters / 2
    facing = np.stack([-eye > half, eye > half], axis=1)
    beside = facing[BOX_FACES[:, :, 0], BOX_FACES[:, :, 1]]
    return CurveSet(
        BOX_NAMES,
        BOX_MIDDLES * half,
        BOX_AXES * half,
        np.zeros((12, 3)),
        BOX_MIDDLES_BY,
        BOX_AXES_BY,
        np.zeros((12, 3, 3)),
        np.zeros(12, dtype=bool),
        np.tile([-1.0, 1.0], (12, 1)),
        beside.any(axis=1),
        beside[:, 0] != beside[:, 1],
    )


def prism_curves(parameters: Array, eye: Array) -> CurveSet:
    """The edges of a prism (height, x0, y0, x1, ...): `edge0`.. upright, `side0-base`, `side0-top`.

    Side i reaches from corner i to the next. Parts that another part of a non-convex prism hides
    are not known here.
    """
    half, corners = parameters[0] / 2, parameters[1:].reshape(-1, 2)
    count = len(corners)
    after = np.roll(corners, -1, axis=0)
    along = after - corners
    outward = np.stack([along[:, 1], -along[:, 0]], axis=1)
    sides = ((eye[:2] - corners) * outward).sum(axis=1) > 0
    ends = np.array([-eye[2] > half, eye[2] > half])
    # upright edge i lies between side i - 1 and side i
    beside = np.concatenate(
        [
            np.stack([np.roll(sides, 1), sides], axis=1),
            np.stack([np.full(count, ends[0]), sides], axis=1),
            np.stack([np.full(count, ends[1]), sides], axis=1),
        ]
    )
    origin, first = np.zeros((3, count, 3)), np.zeros((3, count, 3))
    origin[0, :, :2], first[0, :, 2] = corners, half
    origin[1:, :, :2], first[1:, :, :2] = (corners + after) / 2, along / 2
    origin[1, :, 2], origin[2, :, 2] = -half, half
    names = (
        *(f"edge{i}" for i in range(count)),
        *(f"side{i}-base" for i in range(count)),
        *(f"side{i}-top" for i in range(count)),
    )
    return CurveSet(
        names,
        origin.reshape(-1, 3),
        first.reshape(-1, 3),
        np.zeros((3 * count, 3)),
        *_prism_derivatives(count),
        np.zeros((3 * count, 3, 1 + 2 * count)),
        np.zeros(3 * count, dtype=bool),
        np.tile([-1.0, 1.0], (3 * count, 1)),
        beside.any(axis=1),
        beside[:, 0] != beside[:, 1],
    )


def _prism_derivatives(count: int) -> tuple[Array, Array]:
    """How middles and half edges (3 N, 3, 1 + 2 N) move with the height and the corners."""
    origin = np.zeros((3, count, 3, 1 + 2 * count))
    first = np.zeros((3, count, 3, 1 + 2 * count))
    first[0, :, 2, 0] = 0.5
    origin[1, :, 2, 0], origin[2, :, 2, 0] = -0.5, 0.5
    for i in range(count):
        j = (i + 1) % count
        for axis in range(2):
            here, there = 1 + 2 * i + axis, 1 + 2 * j + axis
            origin[0, i, axis, here] = 1.0
            origin[1:, i, axis, [here, there]] = 0.5
            first[1:, i, axis, here], first[1:, i, axis, there] = -0.5, 0.5
    whole = (3 * count, 3, 1 + 2 * count)
    return origin.reshape(whole), first.reshape(whole)


def _box_edges() -> tuple[Array, Array, Array, tuple[str, ...]]:
    """Middles and axes (12, 3) in half sizes, the faces beside (12, 2, axis and side), names."""
    middles, axes, faces, names = [], [], [], []
    labels = (("x-", "x+"), ("y-", "y+"), ("base", "top"))
    for axis in range(3):
        one, other = (i for i in range(3) if i != axis)
        for a in (0, 1):
            for b in (0, 1):
                middle = np.zeros(3)
                middle[one], middle[other] = 2 * a - 1, 2 * b - 1
                middles.append(middle)
                axes.append(np.eye(3)[axis])
                faces.append([(one, a), (other, b)])
                names.append(labels[one][a] + labels[other][b])
    return np.array(middles), np.array(axes), np.array(faces), tuple(names)


BOX_MIDDLES, BOX_AXES, BOX_FACES, BOX_NAMES = _box_edges()
BOX_MIDDLES_BY = 0.5 * BOX_MIDDLES[:, :, None] * np.eye(3)
BOX_AXES_BY = 0.5 * BOX_AXES[:, :, None] * np.eye(3)
