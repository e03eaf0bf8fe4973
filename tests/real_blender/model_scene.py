# SPDX-License-Identifier: GPL-3.0-or-later
"""A bench with a ball, a wedge, a crate and a can on it: truth, picture, and where to click."""

from __future__ import annotations

import bench_cell
import cv2
import numpy as np
from monocell.core import Box, Cylinder, Pose
from monocell.core.primitives import Prism, Sphere
from monocell.core.shape.hits import seen_map

BALL = Sphere("ball", Pose(np.eye(3), [0.18, 0.14, 0.06]), radius=0.06)
WEDGE = Prism(
    "wedge",
    Pose.from_rotation_vector([0, 0, 0.5], [0.5, 0.2, 0.04]),
    polygon=[[-0.08, -0.05], [0.08, -0.05], [0.0, 0.1]],
    height=0.08,
)
CRATE = Box(
    "crate", Pose.from_rotation_vector([0, 0, 0.35], [0.36, -0.1, 0.06]), size=[0.2, 0.14, 0.12]
)
CAN = Cylinder("can", Pose(np.eye(3), [0.36, -0.1, 0.16]), radius=0.045, height=0.08)
THINGS = (BALL, WEDGE, CRATE, CAN)
COLORS = ((40, 150, 230), (70, 170, 60), (50, 70, 200), (200, 150, 60))


def draw_scene(path, *, chequered=True):
    """The things in plain colours, every face in its own shade, through the true lens."""
    i = bench_cell.INTRINSICS
    seen = seen_map(THINGS, bench_cell.CAMERA)
    v, u = np.mgrid[: i.height, : i.width]
    origin, rays = bench_cell.CAMERA.rays_world(np.stack([u.ravel(), v.ravel()], 1))
    floor = (origin - rays * (origin[2] / np.minimum(rays[:, 2:], -1e-9)))[:, :2]
    chequer = (np.floor(floor / 0.1).sum(axis=1) % 2).reshape(i.height, i.width, 1)
    picture = 165 + 16 * chequered * chequer * [1.0, 1.05, 1.1]
    for index, color in enumerate(COLORS):
        here = seen.owner == index
        shade = np.array([1.0, 0.62, 0.8, 0.5, 0.55, 1.15])[seen.face[here] % 6]
        picture[here] = shade[:, None] * color
    image = np.clip(picture, 0, 255).astype(np.uint8)
    cv2.imwrite(str(path), cv2.GaussianBlur(image, (0, 0), 0.6))


def clicks():
    """Pixels of the undistorted view for every step of the session."""
    corners = CRATE.corners_world()
    wedge = WEDGE.world_from_object
    low, high = (np.column_stack([WEDGE.polygon, np.full(3, z)]) for z in (-0.04, 0.04))
    return {
        "ball": _view(_limb(BALL, [0.3, 2.4, 4.5])),
        "wedge": _view([*wedge.apply(low), wedge.apply(high)[1]]),
        "crate": _view(corners[[0, 1, 3]]),
        "crate_top": _view(
            [corners[[4, 5]].mean(axis=0) * 0.7 + corners[[6, 7]].mean(axis=0) * 0.3]
        ),
        "can": _view([*_rim(CAN, -1, [-1.3, 0.0, 1.3]), *_rim(CAN, 1, [0.2])]),
    }


def _rim(thing, side, angles):
    eye = bench_cell.POSE.inverse().translation - thing.world_from_object.translation
    at = np.arctan2(eye[1], eye[0]) + np.array(angles)
    ring = np.stack([np.cos(at), np.sin(at), np.zeros(len(at))], axis=1) * thing.radius
    ring[:, 2] = side * thing.height / 2
    return thing.world_from_object.apply(ring)


def _limb(ball, angles):
    """World points of the circle in which the cone of sight touches a ball."""
    eye = bench_cell.POSE.inverse().translation
    towards = ball.world_from_object.translation - eye
    away = float(np.linalg.norm(towards))
    axis = towards / away
    one = np.cross(axis, [0, 0, 1.0])
    one = one / np.linalg.norm(one)
    at = np.array(angles)[:, None]
    ring = np.cos(at) * one + np.sin(at) * np.cross(axis, one)
    reach = ball.radius * np.sqrt(1 - (ball.radius / away) ** 2)
    return eye + axis * (away - ball.radius**2 / away) + reach * ring


def _view(points):
    i = bench_cell.INTRINSICS
    pixels = bench_cell.CAMERA.project(np.array(points))
    return i.undistorted().project(i.rays(pixels)).tolist()
