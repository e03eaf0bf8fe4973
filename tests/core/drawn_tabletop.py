# SPDX-License-Identifier: GPL-3.0-or-later
"""Boxes and cylinders on a table, drawn by casting rays: a camera and things in, a picture out."""

import cv2
import numpy as np
from monocell.core import Box, Camera, Cylinder, Intrinsics, Pose, ReferencePlane
from monocell.core.modelling.solid import Solid
from monocell.core.shape.hits import face_names, seen_map

FINER = 4
TABLE = ReferencePlane("table", np.zeros(3), np.array([0.0, 0.0, 1.0]))
TABLE_COLOR = (0.30, 0.33, 0.36)


def camera(width=400, height=300):
    """Looks down at the table from 1.1 m."""
    pose = Pose.looking_at([0.75, -0.45, 0.65], [0.0, 0.0, 0.05], [0, 0, 1])
    return Camera(
        Intrinsics(width, height, 480, 480, width / 2 - 0.5, height / 2 - 0.5),
        pose,
        np.diag([1e-4] * 3 + [2e-4] * 3) ** 2,
    )


def box(name="crate", at=(0.0, -0.12), size=(0.12, 0.16, 0.10), turn=0.4, **more):
    pose = Pose.from_rotation_vector([0, 0, turn], [*at, size[2] / 2])
    return Box(name, pose, size=np.array(size), on="table", **more)


def can(name="can", at=(0.02, 0.12), radius=0.05, height=0.12, **more):
    pose = Pose(np.eye(3), np.array([*at, height / 2]))
    return Cylinder(name, pose, radius=radius, height=height, on="table", **more)


def picture(things, seen_by, colors, noise=1.0, seed=0):
    """(H, W, 3) 8 bits: every face one colour, blurred and sampled as a sensor does."""
    lens = seen_by.intrinsics
    fine = Camera(
        Intrinsics(
            lens.width * FINER,
            lens.height * FINER,
            lens.fx * FINER,
            lens.fy * FINER,
            (lens.cx + 0.5) * FINER - 0.5,
            (lens.cy + 0.5) * FINER - 0.5,
        ),
        seen_by.pose,
    )
    seen = seen_map(things, fine)
    light = np.broadcast_to(np.array(TABLE_COLOR), (*seen.owner.shape, 3)).copy()
    for i, thing in enumerate(things):
        for j, _ in enumerate(face_names(thing)):
            shade = 0.45 + 0.55 * ((2 * j + 3) % 7) / 7
            light[(seen.owner == i) & (seen.face == j)] = np.array(colors[i]) * shade
    small = cv2.resize(light, (lens.width, lens.height), interpolation=cv2.INTER_AREA)
    blurred = cv2.GaussianBlur(small, (0, 0), 0.6)
    encoded = np.where(
        blurred <= 0.0031308, 12.92 * blurred, 1.055 * np.maximum(blurred, 0) ** (1 / 2.4) - 0.055
    )
    noisy = 255 * encoded + np.random.default_rng(seed).normal(0, noise, encoded.shape)
    return np.clip(np.rint(noisy), 0, 255).astype(np.uint8)


def rough(thing, shift=(0.008, -0.006), shares=(1.07, 0.94, 1.06), turn=0.04):
    """The thing elsewhere on the table, of other sizes."""
    solid = Solid.of(thing)
    parameters = solid.parameters * np.array(shares[: len(solid.parameters)])
    up = (parameters[-1] - solid.parameters[-1]) / 2
    step = np.concatenate([[0, 0, turn, *shift, up], parameters - solid.parameters])
    return solid.moved(step).applied(thing)
