# SPDX-License-Identifier: GPL-3.0-or-later
"""A small synthetic job for the command line: ball pictures, a cell with picks, and the truth."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
from monocell.core import (
    Box,
    Camera,
    Cell,
    Cylinder,
    Distortion,
    Intrinsics,
    Pose,
    ReferencePlane,
    Sketch,
    SphereSighting,
)
from monocell.core.document.cell_file import write_cell
from monocell.core.picture.synthetic import Ball, Photographer, photograph

RADIUS = 0.04
LENS = Intrinsics(
    480, 360, 700.0, 698.0, 243.2, 177.4, Distortion("plumb_bob", [-0.15, 0.05, 4e-4, -3e-4, 0.0])
)
POSE = Pose.looking_at([1.5, -0.3, 0.9], [0.1, 0.0, 0.25], [0, 0, 1])
PLACES = np.array(
    [[0.05, -0.3, 0.1], [0.3, 0.22, 0.15], [-0.1, 0.1, 0.45], [0.35, -0.15, 0.4], [0, 0.33, 0.3]]
)
FLOOR = ReferencePlane("floor", [0, 0, 0], [0, 0, 1])
BLOCK = Box(
    "block",
    Pose.from_rotation_vector([0, 0, 0.4], [0.1, -0.1, 0.06]),
    size=[0.2, 0.15, 0.12],
    on="floor",
)
DRUM = Cylinder("drum", Pose(np.eye(3), [0.2, 0.2, 0.1]), radius=0.06, height=0.2, on="floor")


def write_job(folder: Path) -> None:
    """Pictures, `cell.cell.json` as a site would send it, `truth.cell.json` and `lens.json`."""
    camera = Camera(LENS, POSE)
    sightings = []
    for i, place in enumerate(PLACES):
        ball = Ball(tuple(POSE.apply(place)), RADIUS)
        picture = photograph(LENS, (ball,), Photographer(seed=i, supersampling=4))
        cv2.imwrite(str(folder / f"pose_{i}.png"), picture)
        sightings.append(SphereSighting(f"pose_{i}.png", place, RADIUS))
    truth = Cell(camera, "pose_0.png", tuple(sightings), (FLOOR,), (BLOCK, DRUM), folder=folder)
    write_cell(truth, folder / "truth.cell.json")
    given = replace(truth, camera=Camera(LENS), objects=(), sketches=picked(camera))
    write_cell(given, folder / "cell.cell.json")
    write_cell(Cell(Camera(LENS), folder=folder), folder / "lens.json")


def picked(camera: Camera) -> tuple[Sketch, Sketch]:
    """The exact pixels of corners and rims on the camera's side."""
    base = [0, 1, 3, 2]
    corners = camera.project(BLOCK.corners_world())
    eye = BLOCK.world_from_object.inverse().apply(camera.centre_world)
    far = int(
        np.argmax(np.linalg.norm(np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) - eye[:2], axis=1))
    )
    seen = [base[(far + i) % 4] for i in (1, 2, 3)]
    block = {"base": corners[seen].tolist(), "top": corners[[i + 4 for i in seen]].tolist()}
    towards = np.arctan2(*(camera.centre_world - DRUM.world_from_object.translation)[[1, 0]])
    drum = {
        "rim": camera.project(_rim(towards + np.radians([-65, 0, 65]), -1)).tolist(),
        "top": camera.project(_rim(towards + np.radians([-120, 0, 120]), 1)).tolist(),
    }
    return Sketch("block", "box", "floor", block), Sketch("drum", "cylinder", "floor", drum)


def _rim(angles, side):
    ring = DRUM.radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    level = np.full(len(angles), side * DRUM.height / 2)
    return DRUM.world_from_object.apply(np.column_stack([ring, level]))
