# SPDX-License-Identifier: GPL-3.0-or-later
"""A cell with a reference made in every way there is, each through exact picks or numbers."""

from __future__ import annotations

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
    Sphere,
)
from monocell.core.reference import PendingReference
from monocell.core.references.sources import (
    AlongDirection,
    FacingCamera,
    FeatureOf,
    Intersection,
    Parallel,
    PickedPoints,
    ThroughPoints,
    Upright,
)

LENS = Intrinsics(
    1280,
    960,
    1000.0,
    990.0,
    650.3,
    470.8,
    Distortion("plumb_bob", [-0.28, 0.09, 0.0006, -0.0004, -0.01]),
)
POSE = Pose.looking_at([1.6, -1.1, 1.2], [0.0, 0.0, 0.15], [0.0, 0.0, 1.0])
TWIST_COVARIANCE = np.diag([1e-6, 2e-6, 1.5e-6, 4e-6, 3e-6, 6e-6]) + 5e-7
CAMERA = Camera(LENS, POSE, TWIST_COVARIANCE)
FLOOR_COVARIANCE = np.diag([4e-6, 9e-6, 0, 0, 0, 1e-6])
FLOOR = ReferencePlane("floor", [0, 0, 0], [0, 0, 1], covariance=FLOOR_COVARIANCE)
CRATE = Box(
    "crate",
    Pose.from_rotation_vector([0, 0, 0.4], [0.2, -0.1, 0.1]),
    size=[0.3, 0.25, 0.2],
    on="floor",
    covariance=np.diag([1e-6, 2e-6, 3e-6, 1e-6, 2e-6, 3e-6, 1e-6, 2e-6, 4e-6]) + 2e-7,
    by_camera=0.05 * np.random.default_rng(5).normal(size=(9, 6)),
)
DRUM = Cylinder(
    "drum",
    Pose.from_rotation_vector([0.5, 0.2, 0.0], [-0.1, 0.3, 0.25]),
    radius=0.08,
    height=0.3,
    covariance=np.diag([1e-6, 2e-6, 3e-6, 1e-6, 2e-6, 3e-6, 1e-6, 2e-6]) + 2e-7,
    by_camera=0.05 * np.random.default_rng(6).normal(size=(8, 6)),
)
BALL = Sphere("ball", Pose(np.eye(3), [0.1, 0.4, 0.5]), radius=0.05, covariance=1e-6 * np.eye(7))
SHELF = np.array([[-0.3, -0.2, 0.4], [0.3, -0.3, 0.4], [0.2, 0.4, 0.5], [-0.3, 0.3, 0.43]])
SHELF_SIGMA = np.array([1e-3, 2e-3, 1e-3, 3e-3])
# four corners of a slanted board, 0.2 m wide at its foot, on the plane 0.3 x + z = 0.35
BOARD = np.array([[-0.2, -0.2, 0.41], [0.3, -0.2, 0.26], [0.3, 0.3, 0.26], [-0.2, 0.3, 0.41]])
WALL_FOOT = np.array([[-0.3, -0.4, 0.0], [-0.3, 0.1, 0.0], [-0.3, 0.4, 0.0]])
SOURCES = {
    "shelf": ("plane", ThroughPoints(SHELF[:3], SHELF_SIGMA[:3])),
    "board": ("plane", PickedPoints(CAMERA.project(BOARD), BOARD[:, 2], "floor")),
    "lid": ("plane", FeatureOf("crate.top")),
    "sheet": ("plane", FacingCamera("drum.axis")),
    "wall": ("plane", Upright(CAMERA.project(WALL_FOOT), "floor")),
    "loft": ("plane", Parallel("board", 0.25, 2e-3)),
    "rail": ("line", ThroughPoints(SHELF[:2], SHELF_SIGMA[:2])),
    "post": ("line", Upright(CAMERA.project([[0.3, 0.35, 0.0]]), "floor")),
    "rim": ("line", FeatureOf("crate.x+top")),
    "spine": ("line", FeatureOf("drum.axis")),
    "crease": ("line", Intersection(("wall", "board"))),
    "seam": ("line", Intersection(("crate.top", "crate.x+"))),
    "string": ("line", AlongDirection("ball.centre", [0, 0, 1], tilt_sigma=2e-3)),
    "nail": ("line", AlongDirection([0.1, 0.2, 0.3], "wall", 1e-3)),
    "sight": ("plane", FacingCamera("post")),
}


def referenced_cell(camera=CAMERA, sources=SOURCES, floor=FLOOR, things=(CRATE, DRUM, BALL)):
    """The cell with these references pending, and the floor given in the world."""
    pending = [PendingReference(name, kind, source) for name, (kind, source) in sources.items()]
    return Cell(camera, references=(floor, *pending), objects=things)


def way_of(reference):
    return reference.normal if isinstance(reference, ReferencePlane) else reference.direction


def tangent(reference, truth):
    """How far a reference is from another: rotation vector, and motion of the other's point."""
    turn = np.cross(way_of(truth), way_of(reference))
    gap, way = reference.point - truth.point, way_of(reference)
    along = way * (way @ gap)
    # the nearest point of it, as a motion along a plane or line changes nothing
    return np.concatenate([turn, along if isinstance(truth, ReferencePlane) else gap - along])
