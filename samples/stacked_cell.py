# SPDX-License-Identifier: GPL-3.0-or-later
"""Sample 03 as it truly is: nothing goes in; camera, lab, ball places and printed things come out.

A can stands on a carton; a block of wood, a cone and a ball stand on the table.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from monocell.core.camera import Camera
from monocell.core.distortion import Distortion
from monocell.core.intrinsics import Intrinsics
from monocell.core.pose import Pose
from monocell.core.primitives import Box, Cone, Cylinder, Primitive, Sphere
from monocell.core.reference import ReferencePlane
from monocell.scene.work_cell import Lab

TABLE = ReferencePlane("table", np.zeros(3), np.array([0.0, 0.0, 1.0]))
# where the arm holds the ball: spread over work space and picture, neither in line nor in a plane
BALL_POSITIONS = np.array(
    [
        [0.72, 0.38, 0.16],
        [0.74, -0.05, 0.14],
        [0.54, -0.44, 0.22],
        [0.46, 0.46, 0.44],
        [0.66, -0.25, 0.46],
        [0.50, -0.05, 0.66],
        [0.70, 0.18, 0.36],
        [0.44, -0.46, 0.58],
    ]
)
CARTON = np.array([0.24, 0.17, 0.11])
CARTON_PLACE, CARTON_DEGREES = (0.64, 0.06), -8.0
CAN_RADIUS, CAN_HEIGHT, CAN_ON_CARTON = 0.041, 0.115, (-0.058, -0.020)
BLOCK, BLOCK_PLACE, BLOCK_DEGREES = np.array([0.16, 0.07, 0.06]), (0.70, -0.26), 14.0
CONE_RADIUS, CONE_HEIGHT, CONE_PLACE = 0.055, 0.15, (0.42, 0.36)
BALL_RADIUS, BALL_PLACE = 0.045, (0.92, -0.08)


@dataclass(frozen=True, eq=False)
class Ink:
    """The mean colour (3,) of a thing in linear light, which is what its truth states."""

    carton: tuple[float, float, float] = (0.47, 0.30, 0.16)
    can: tuple[float, float, float] = (0.03, 0.20, 0.22)
    block: tuple[float, float, float] = (0.50, 0.29, 0.12)
    cone: tuple[float, float, float] = (0.82, 0.16, 0.02)
    ball: tuple[float, float, float] = (0.45, 0.02, 0.05)


def true_camera() -> Camera:
    """A lens with some distortion, 1.7 m from the cell, its principal point off the middle."""
    lens = Distortion("plumb_bob", np.array([-0.15, 0.06, 0.0003, -0.0005, 0.0]))
    inner = Intrinsics(1280, 960, 1184.0, 1181.0, 633.8, 486.5, lens)
    pose = Pose.looking_at([1.72, 0.80, 0.98], [0.50, -0.02, 0.17], [0.0, 0.0, 1.0])
    return Camera(inner, pose)


def lab() -> Lab:
    """A light bench before a warm wall."""
    return Lab(
        table_dark=np.array([0.34, 0.33, 0.30]),
        table_light=np.array([0.46, 0.45, 0.41]),
        grain=np.array([34.0, 1.3, 1.0]),
        wall=np.array([0.60, 0.585, 0.55]),
        dado=np.array([0.15, 0.19, 0.15]),
        lamp_size=0.7,
    )


def true_objects() -> tuple[Primitive, ...]:
    """The five things, without their looks; the can is said to stand on the carton's top."""
    carton = Box("carton", _standing(*CARTON_PLACE, CARTON[2], CARTON_DEGREES),
                 on=TABLE.name, size=CARTON)  # fmt: skip
    on_top = Pose(np.eye(3), np.array([*CAN_ON_CARTON, (CARTON[2] + CAN_HEIGHT) / 2]))
    can = Cylinder("can", carton.world_from_object @ on_top, on="carton.top",
                   radius=CAN_RADIUS, height=CAN_HEIGHT)  # fmt: skip
    block = Box("block", _standing(*BLOCK_PLACE, BLOCK[2], BLOCK_DEGREES),
                on=TABLE.name, size=BLOCK)  # fmt: skip
    cone = Cone("cone", _standing(*CONE_PLACE, CONE_HEIGHT), on=TABLE.name,
                radius=CONE_RADIUS, top_radius=0.0, height=CONE_HEIGHT)  # fmt: skip
    ball = Sphere("ball", _standing(*BALL_PLACE, 2 * BALL_RADIUS), on=TABLE.name,
                  radius=BALL_RADIUS)  # fmt: skip
    return carton, can, block, cone, ball


def _standing(x: float, y: float, height: float, degrees: float = 0.0) -> Pose:
    return Pose.from_rotation_vector([0, 0, np.radians(degrees)], [x, y, height / 2])
