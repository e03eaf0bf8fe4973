# SPDX-License-Identifier: GPL-3.0-or-later
"""The camera and the chest with its lid and drawer that the tests of robot formats share."""

from __future__ import annotations

from pathlib import Path

from monocell.core import Box, Camera, Cone, Cylinder, Intrinsics, Motion, Pose, Sphere
from monocell.core.formats.text_formats import write_text_format

CAMERA = Camera(
    Intrinsics(640, 480, 600.0, 605.0, 330.0, 236.0),
    Pose.looking_at([1.0, -1.0, 1.0], [0, 0, 0], [0, 0, 1]),
)


def at(*place, turn=(0.0, 0.0, 0.0)):
    return Pose.from_rotation_vector(turn, place)


CHEST = (
    Box("chest", at(0.5, 0.2, 0.1, turn=(0, 0, 0.3)), size=[0.3, 0.2, 0.2]),
    Box(
        "lid",
        at(0.5, 0.2, 0.21, turn=(0, 0, 0.3)),
        size=[0.3, 0.2, 0.02],
        motion=Motion(
            "attached",
            mass=2.0,
            to="chest",
            joint="hinge",
            axis=[1.0, 0, 0],
            point=[0, -0.1, -0.01],
            limits=(0.0, 1.5),
        ),
    ),
    Sphere(
        "knob",
        at(0.5, 0.3, 0.23),
        radius=0.01,
        motion=Motion("attached", to="lid", joint="fixed", mass=0.1),
    ),
    Cylinder(
        "drawer",
        at(0.4, 0.2, 0.05),
        radius=0.04,
        height=0.1,
        motion=Motion("attached", to="chest", joint="slider", axis=[0, 1.0, 0], density=500.0),
    ),
    Cone("cup", at(0.1, 0.4, 0.1), radius=0.05, height=0.2, motion=Motion("movable", mass=1.5)),
)


def written(cell, folder, ending):
    path = Path(folder) / f"my cell{ending}"
    return path, write_text_format(cell, path)
