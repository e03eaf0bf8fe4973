# SPDX-License-Identifier: GPL-3.0-or-later
"""Solving many objects tells how far it has come, and can be ended."""

from dataclasses import replace

import numpy as np
import pytest
from monocell.core import Box, Camera, Cell, Intrinsics, Pose, ReferencePlane
from monocell.core.modelling.solve import model

CAMERA = Camera(
    Intrinsics(800, 600, 760.0, 757.0, 411.3, 292.8),
    Pose.looking_at([1.15, -0.85, 0.8], [0.34, 0.0, 0.06], [0, 0, 1.0]),
)


@pytest.fixture
def cell():
    boxes = []
    for i in range(4):
        box = Box(
            f"b{i}", Pose(np.eye(3), [0.1 + 0.15 * i, 0, 0.02]), size=[0.05, 0.06, 0.04], on="floor"
        )
        pixels = CAMERA.project(box.corners_world())
        picks = {"base": pixels[[0, 1, 3]].tolist(), "top": [None, pixels[5].tolist(), None, None]}
        boxes.append(replace(box, picks=picks))
    floor = ReferencePlane("floor", [0, 0, 0], [0, 0, 1])
    return Cell(CAMERA, references=(floor,), objects=tuple(boxes))


def test_each_object_is_told_once(cell):
    told = []
    model(cell, watch=told.append)
    assert told == ["b0", "b1", "b2", "b3"]


def test_what_the_watcher_raises_ends_the_work(cell):
    told = []

    def stop(name):
        told.append(name)
        if name == "b1":
            raise InterruptedError

    with pytest.raises(InterruptedError):
        model(cell, watch=stop)
    assert told == ["b0", "b1"]
