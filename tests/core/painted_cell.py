# SPDX-License-Identifier: GPL-3.0-or-later
"""Cells whose picture is known exactly: each pixel by its own ray, its face's chart and a paint."""

from __future__ import annotations

import numpy as np
from monocell.core.camera import Camera
from monocell.core.cell import Cell
from monocell.core.distortion import Distortion
from monocell.core.intrinsics import Intrinsics
from monocell.core.look.textures import eight_bit_srgb
from monocell.core.pose import Pose
from monocell.core.primitives import Box, Cylinder, Sphere
from monocell.core.shape.charts import chart_of
from monocell.core.shape.hits import face_names, seen_map

LENS = Distortion("plumb_bob", np.array([-0.25, 0.08, 0.001, -0.0007, 0.0]))
# the principal point is well off the middle: a texture that forgot it would be far off
INNER = Intrinsics(480, 360, 500.0, 497.0, 270.0, 150.0, LENS)
CAMERA = Camera(INNER, Pose.looking_at([1.2, -0.8, 0.9], [0.0, 0.0, 0.1], [0, 0, 1]))
BACKGROUND = np.array([0.02, 0.9, 0.9])


def crate(**given):
    pose = Pose.from_rotation_vector([0, 0, 0.3], [0.0, 0.0, 0.12])
    return Box("crate", pose, size=[0.30, 0.36, 0.24], **given)


def drum(**given):
    return Cylinder("drum", Pose(np.eye(3), np.array([0, 0, 0.15])), radius=0.12, height=0.3,
                    **given)  # fmt: skip


def ball(**given):
    return Sphere("ball", Pose(np.eye(3), np.array([0, 0, 0.15])), radius=0.13, **given)


def waves(st, size):
    """A smooth print of three colours, the same in all places of the same (s, t)."""
    s, t = (np.asarray(st) * size).T
    red = 0.45 + 0.25 * np.sin(40 * s)
    green = 0.40 + 0.25 * np.sin(40 * t + 1.0)
    blue = 0.35 + 0.2 * np.sin(30 * (s + t))
    return np.stack([red, green, blue], axis=1)


def face_size(thing, face):
    """Roughly how long a face is along s and t at its middle, metres."""
    chart, step = chart_of(thing, face), 1e-6
    ends = [
        chart.points(np.array([[0.5, 0.5]]) + sign * np.array([axis]) * step)
        for axis in ([1, 0], [0, 1])
        for sign in (1, -1)
    ]
    return [np.linalg.norm(ends[i] - ends[i + 1]) / (2 * step) for i in (0, 2)]


def photograph(things, paint, camera=CAMERA, side=3):
    """An 8-bit picture (H, W, 3) BGR: `paint(thing, face, st)` gives linear red, green, blue."""
    inner = camera.intrinsics
    total = np.zeros((inner.height, inner.width, 3))
    for dv in (np.arange(side) + 0.5) / side - 0.5:
        for du in (np.arange(side) + 0.5) / side - 0.5:
            moved = Intrinsics(
                inner.width, inner.height, inner.fx, inner.fy, inner.cx - du, inner.cy - dv,
                inner.distortion,
            )  # fmt: skip
            total += _light(things, paint, Camera(moved, camera.pose))
    return np.ascontiguousarray(eight_bit_srgb((total / side**2).astype(np.float32))[..., ::-1])


def cell_of(*things, camera=CAMERA):
    return Cell(camera, "cell.png", objects=things)


def _light(things, paint, camera):
    seen = seen_map(things, camera)
    light = np.tile(BACKGROUND, (*seen.owner.shape, 1))
    rows, columns = np.nonzero(seen.owner >= 0)
    origin, rays = camera.rays_world(np.stack([columns, rows], 1))
    points = origin + seen.depth[rows, columns][:, None] * rays
    owner, face = seen.owner[rows, columns], seen.face[rows, columns]
    for index, thing in enumerate(things):
        for number, name in enumerate(face_names(thing)):
            here = (owner == index) & (face == number)
            own = thing.world_from_object.inverse().apply(points[here])
            st = chart_of(thing, name).coordinates(own)
            light[rows[here], columns[here]] = paint(thing, name, st)
    return light
