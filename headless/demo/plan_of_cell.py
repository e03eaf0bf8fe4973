# SPDX-License-Identifier: GPL-3.0-or-later
"""The demo's work cell as it truly is: camera, arm, table, objects, and where the ball is held."""

from __future__ import annotations

import numpy as np

from ...core.appearance import Appearance
from ...core.arrays import Array
from ...core.camera import Camera
from ...core.distortion import Distortion
from ...core.intrinsics import Intrinsics
from ...core.pose import Pose
from ...core.primitives import Box, Cylinder, Primitive
from ...core.reference import ReferencePlane

FLOOR = ReferencePlane("table", np.zeros(3), np.array([0.0, 0.0, 1.0]))
BALL_RADIUS = 0.04
BALL_COLOR = np.array([0.06, 0.42, 0.05])
# the ball's centre in the flange frame, metres: beyond a short parallel gripper
BALL_IN_FLANGE = np.array([0.0, 0.0, 0.19])
STEM_RADIUS = 0.045
# where the arm holds the ball, in the world: spread over the work space, neither in line nor in one
# plane
BALL_POSITIONS = np.array(
    [
        [0.62, -0.42, 0.18],
        [0.70, 0.02, 0.12],
        [0.52, 0.45, 0.22],
        [0.40, -0.30, 0.55],
        [0.66, 0.25, 0.46],
        [0.48, 0.05, 0.72],
        [0.72, -0.20, 0.36],
        [0.42, 0.50, 0.58],
    ]
)
# name, kind, sizes in mm (x, y, z or radius, height), place on the table in m, turn in deg, colour
OBJECTS = (
    ("crate", "box", (180, 120, 110), (0.62, -0.34), 24.0, (0.02, 0.22, 0.62)),
    ("drum", "cylinder", (55, 150), (0.66, -0.06), 0.0, (0.72, 0.42, 0.02)),
    ("block", "box", (90, 70, 60), (0.82, -0.20), -35.0, (0.62, 0.05, 0.04)),
    ("tower", "box", (85, 85, 230), (0.50, 0.20), 12.0, (0.10, 0.45, 0.16)),
    ("can", "cylinder", (34, 105), (0.76, 0.14), 0.0, (0.55, 0.56, 0.58)),
    ("carton", "box", (150, 95, 80), (0.66, 0.42), -14.0, (0.45, 0.27, 0.12)),
    ("puck", "cylinder", (60, 45), (0.42, -0.12), 0.0, (0.26, 0.06, 0.40)),
)


def true_camera() -> Camera:
    """A lens with some distortion, 2.2 m from the cell, its principal point off the middle."""
    intrinsics = Intrinsics(
        1280,
        960,
        1210.0,
        1207.0,
        646.3,
        474.1,
        Distortion("plumb_bob", np.array([-0.12, 0.05, 0.0004, -0.0003, 0.0])),
    )
    eye, target = np.array([2.0, -0.95, 1.1]), np.array([0.42, 0.06, 0.22])
    return Camera(intrinsics, Pose.looking_at(eye, target, [0.0, 0.0, 1.0]))


def true_objects() -> tuple[Primitive, ...]:
    """The objects that the operator will find standing on the table."""
    return tuple(_object(*row) for row in OBJECTS)


def table_box() -> Box:
    """The table as an obstacle: its top is the plane z = 0."""
    size = np.array([1.6, 1.5, 0.05])
    place = Pose(np.eye(3), np.array([0.35, 0.0, -size[2] / 2]))
    return Box("table", place, size=size)


def _object(
    name: str,
    kind: str,
    millimetres: tuple[float, ...],
    place: tuple[float, float],
    degrees: float,
    color: tuple[float, float, float],
) -> Primitive:
    sizes = np.array(millimetres) / 1000
    position = np.array([*place, sizes[-1] / 2])
    pose = Pose.from_rotation_vector([0, 0, np.radians(degrees)], position)
    look = Appearance(np.array(color))
    if kind == "box":
        return Box(name, pose, on=FLOOR.name, appearance=look, size=sizes)
    return Cylinder(
        name, pose, on=FLOOR.name, appearance=look, radius=sizes[0], height=float(sizes[1])
    )


def ball_positions() -> Array:
    """Where the arm is asked to hold the ball, (8, 3) in metres."""
    return BALL_POSITIONS
