# SPDX-License-Identifier: GPL-3.0-or-later
"""The demo's pictures: the true cell in, rendered photographs with the robot's positions out."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ...core.arrays import Array
from ...core.camera import Camera
from ...core.mesh_part import MeshPart
from ...core.pose import Pose
from ...core.primitives import Primitive
from ...core.sighting import SphereSighting
from ..told import progress
from .plan_of_cell import BALL_COLOR, BALL_RADIUS

PICTURE = "cell.png"
# the arm's meshes, the ball's centre (3,) and the flange's pose, in the world
Held = tuple[tuple[MeshPart, ...], Array, Pose]


def photograph_sightings(
    camera: Camera,
    out: Path,
    held: Sequence[Held],
) -> tuple[SphereSighting, ...]:
    """One picture for each place the ball is held at: arm, centre (3,) and pose of the flange."""
    from ...scene.stage import Stage
    from ...scene.work_cell import Ball, WorkCell

    sightings = []
    first_parts, first_centre, first_flange = held[0]
    ball = Ball(first_centre, BALL_RADIUS, BALL_COLOR, first_flange)
    with Stage(WorkCell(camera, ball=ball, parts=first_parts)) as stage:
        for i, (parts, centre, flange) in enumerate(held):
            name = f"pose_{i:02d}.png"
            progress(f"rendering {name} ({i + 1} of {len(held)})")
            stage.move(parts, Ball(centre, BALL_RADIUS, BALL_COLOR, flange))
            stage.render(out / name)
            sightings.append(SphereSighting(name, centre, BALL_RADIUS))
    return tuple(sightings)


def photograph_cell(
    camera: Camera,
    objects: Sequence[Primitive],
    parts: tuple[MeshPart, ...],
    path: Path,
) -> None:
    """One picture of the cell with objects and the arm, from any camera."""
    from ...scene.stage import Stage
    from ...scene.work_cell import WorkCell

    progress(f"rendering {path.name}")
    with Stage(WorkCell(camera, tuple(objects), parts=parts)) as stage:
        stage.render(path)


def other_side(camera: Camera) -> Camera:
    """A camera on the other side of the cell, with a perfect lens."""
    eye = camera.centre_world * np.array([0.75, -1.25, 0.85])
    pose = Pose.looking_at(eye, [0.5, 0.02, 0.12], [0.0, 0.0, 1.0])
    return Camera(camera.intrinsics.undistorted(), pose)
