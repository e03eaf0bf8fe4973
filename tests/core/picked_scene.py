# SPDX-License-Identifier: GPL-3.0-or-later
"""Cameras, planes and objects of known size, and the exact pixels a perfect operator would pick."""

from __future__ import annotations

import numpy as np
from monocell.core import Box, Camera, Cylinder, Distortion, Intrinsics, Pose, ReferencePlane

LENSES = {
    "none": (),
    "plumb_bob": (-0.28, 0.09, 0.0006, -0.0004, -0.01),
    "rational_polynomial": (0.3, -0.2, 0.0005, -0.0003, 0.02, 0.5, -0.1, 0.01),
    "equidistant": (-0.02, 0.004, -0.001, 0.0002),
}
FLOOR = ReferencePlane("floor", np.zeros(3), np.array([0.0, 0.0, 1.0]))
WALL = ReferencePlane("wall", np.array([-0.4, 0.1, 0.0]), np.array([1.0, -0.3, 0.1]))
RAMP = ReferencePlane("ramp", np.array([0.1, 0.0, 0.05]), np.array([0.2, -0.1, 1.0]))
PLANES = (FLOOR, WALL, RAMP)
POSE = Pose.looking_at([1.2, -1.0, 1.1], [0.0, 0.0, 0.1], [0.0, 0.0, 1.0])
# 1 to 2 milliradians and 1 to 2 mm, not independent of each other
TWIST_COVARIANCE = np.diag([1e-6, 2e-6, 3e-6, 1e-6, 2e-6, 3e-6]) + 5e-7
# base corners of `Box.corners_world` in order round the base, from the corner that x and y leave
ROUND = [0, 1, 3, 2]


def camera(model="plumb_bob", pose=POSE, covariance=None):
    lens = Distortion(model, np.array(LENSES[model]))
    return Camera(Intrinsics(1280, 960, 1000.0, 990.0, 650.3, 470.8, lens), pose, covariance)


def box_on(plane, x=0.1, y=0.05, yaw=0.3, size=(0.2, 0.1, 0.15)):
    standing = Pose.from_rotation_vector([0, 0, yaw], [x, y, size[2] / 2])
    return Box("block", plane.world_from_plane @ standing, size=np.array(size), on=plane.name)


def box_picks(box, cam, base=3, top=(0, 2)):
    pixels = cam.project(box.corners_world())
    above = [pixels[ROUND[i] + 4].tolist() if i in top else None for i in range(4)]
    return {"base": [pixels[ROUND[i]].tolist() for i in range(base)], "top": above}


def cylinder_on(plane, x=-0.1, y=0.1, radius=0.1, height=0.25):
    standing = Pose(np.eye(3), np.array([x, y, height / 2]))
    return Cylinder(
        "drum", plane.world_from_plane @ standing, radius=radius, height=height, on=plane.name
    )


def rim_points(cylinder, angles, level):
    """World points at angles (N,) from the side that faces `POSE`, at -1 or +1 half heights."""
    eye = cylinder.world_from_object.inverse().apply(POSE.inverse().translation)
    turned = np.arctan2(eye[1], eye[0]) + np.asarray(angles, dtype=float)
    local = np.stack(
        [
            cylinder.radius * np.cos(turned),
            cylinder.radius * np.sin(turned),
            np.full_like(turned, level * cylinder.height / 2),
        ],
        axis=1,
    )
    return cylinder.world_from_object.apply(local)


def limb(cylinder):
    """The angle from the facing side to where sight touches the cylinder."""
    eye = cylinder.world_from_object.inverse().apply(POSE.inverse().translation)
    return float(np.arccos(cylinder.radius / np.hypot(eye[0], eye[1])))


def cylinder_picks(cylinder, cam, rim=(-0.8, -0.2, 0.3, 0.9), top=(-1.0, 0.4, 2.5), sides=()):
    touching = [side * limb(cylinder) for side, _ in sides]
    side_points = [
        rim_points(cylinder, [angle], level)[0]
        for angle, (_, level) in zip(touching, sides, strict=True)
    ]
    worlds = {
        "rim": rim_points(cylinder, rim, -1.0),
        "top": rim_points(cylinder, top, 1.0),
        "sides": np.array(side_points).reshape(-1, 3),
    }
    return {role: cam.project(points).tolist() for role, points in worlds.items() if len(points)}


def noisy(picks, rng, sigma):
    """The same picks with a hand that trembles by `sigma` pixels."""
    return {
        role: [
            None if p is None else (np.array(p) + rng.normal(0, sigma, 2)).tolist() for p in pixels
        ]
        for role, pixels in picks.items()
    }


def deviation(solved, truth):
    """Rotation vector in the world, centre and sizes of one object minus another's."""
    turned = Pose(solved.world_from_object.rotation @ truth.world_from_object.rotation.T, [0, 0, 0])
    moved = solved.world_from_object.translation - truth.world_from_object.translation
    return np.concatenate([turned.rotation_vector(), moved, solved.sizes - truth.sizes])
