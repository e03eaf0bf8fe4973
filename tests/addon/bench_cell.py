# SPDX-License-Identifier: GPL-3.0-or-later
"""A bench with a box and a drum, its true camera, and a cell document with ball pictures of it."""

from __future__ import annotations

import cv2
import numpy as np
from monocell.core import (
    Appearance,
    Box,
    Camera,
    Cell,
    Cylinder,
    Distortion,
    Intrinsics,
    Pose,
    ReferencePlane,
    SphereSighting,
)
from monocell.core.document.cell_file import write_cell
from monocell.core.picture.synthetic import Ball, photograph

LENS = Distortion("plumb_bob", np.array([-0.22, 0.07, 0.0006, -0.0004, -0.01]))
INTRINSICS = Intrinsics(800, 600, 760.0, 757.0, 411.3, 292.8, LENS)
POSE = Pose.looking_at([1.15, -0.85, 0.8], [0.34, 0.0, 0.06], [0, 0, 1.0])
# 0.3 milliradians and 0.5 mm
COVARIANCE = np.diag([9e-8] * 3 + [2.5e-7] * 3)
CAMERA = Camera(INTRINSICS, POSE, COVARIANCE)
FLOOR = ReferencePlane("floor", [0, 0, 0], [0, 0, 1])
BOX = Box(
    "box",
    Pose.from_rotation_vector([0, 0, 0.35], [0.36, -0.1, 0.06]),
    size=[0.2, 0.14, 0.12],
    on="floor",
    appearance=Appearance([0.6, 0.08, 0.05]),
)
DRUM = Cylinder(
    "drum",
    Pose(np.eye(3), [0.34, 0.2, 0.09]),
    radius=0.06,
    height=0.18,
    on="floor",
    appearance=Appearance([0.05, 0.2, 0.5]),
)
RADIUS = 0.04
CENTRES = np.array(
    [[0.2, -0.2, 0.1], [0.55, -0.15, 0.12], [0.5, 0.2, 0.1], [0.2, 0.15, 0.3], [0.4, -0.05, 0.4]]
)
# base corners in order round the base; the eighth corner is above the second of them
ROUND = [0, 1, 3]


def box_picks(noise=0.0):
    """Three base corners and the top corner above the second, as the lens images them."""
    pixels = CAMERA.project(BOX.corners_world())
    pixels = pixels + np.random.default_rng(3).uniform(-noise, noise, pixels.shape)
    return {
        "base": [pixels[i].tolist() for i in ROUND],
        "top": [None, pixels[5].tolist(), None, None],
    }


def drum_picks(tops=1):
    """Three points of the base rim and some of the top rim, all on the side that is seen."""
    eye = POSE.inverse().translation - DRUM.world_from_object.translation
    angles = np.arctan2(eye[1], eye[0]) + np.array([-1.3, 0.0, 1.3, 0.2, 1.6][: 3 + tops])
    x, y = DRUM.radius * np.cos(angles), DRUM.radius * np.sin(angles)
    z = np.array([-0.5, -0.5, -0.5, 0.5, 0.5][: 3 + tops]) * DRUM.height
    pixels = CAMERA.project(DRUM.world_from_object.apply(np.stack([x, y, z], axis=1)))
    return {"rim": pixels[:3].tolist(), "top": pixels[3:].tolist()}


def cell_of(*, calibrated=True, folder):
    """The cell without objects."""
    sightings = [
        SphereSighting(f"ball_{i}.png", centre, RADIUS) for i, centre in enumerate(CENTRES)
    ]
    return Cell(
        CAMERA if calibrated else Camera(INTRINSICS),
        picture="bench.png",
        sightings=tuple(sightings),
        references=(FLOOR,),
        folder=folder,
    )


def write_bench(folder, *, calibrated=True, balls=True):
    """Document and pictures into a folder; returns the document's path."""
    plain = photograph(INTRINSICS, ())
    cv2.imwrite(str(folder / "bench.png"), plain)
    for i, centre in enumerate(CENTRES if balls else ()):
        ball = Ball(tuple(POSE.apply(centre)), RADIUS)
        cv2.imwrite(str(folder / f"ball_{i}.png"), photograph(INTRINSICS, (ball,)))
    path = folder / "bench.cell.json"
    write_cell(cell_of(calibrated=calibrated, folder=folder), path)
    return path


def ros_camera():
    """The camera as ROS writes it."""
    i = INTRINSICS
    return (
        f"image_width: {i.width}\nimage_height: {i.height}\n"
        f"camera_matrix: {{rows: 3, cols: 3, data: {i.matrix().ravel().tolist()}}}\n"
        "distortion_model: plumb_bob\ndistortion_coefficients: "
        f"{{rows: 1, cols: 5, data: {i.distortion.coefficients.tolist()}}}\n"
    )
