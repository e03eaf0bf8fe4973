# SPDX-License-Identifier: GPL-3.0-or-later
"""What people use instead, on the same balls: centres in, poses by frames, P3P and PnP out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import cv2
import numpy as np

from ..arrays import Array
from ..errors import DegeneratePositions, InvalidValue, NotConverged
from ..pose import Pose
from .frames import pose_from_triads
from .seen import Seen
from .three_depths import depths_of_three

MOST_COMPARED = 40


@dataclass(frozen=True, eq=False)
class PoseCandidate:
    """A pose, and the root mean square of how far it puts the targets from where they were found.

    `camera_from_base` is from the world, or from the flange that a camera is mounted on.
    """

    camera_from_base: Pose
    off_pixels: float


def baseline_poses(method: str, balls: Sequence[Seen]) -> tuple[PoseCandidate, ...]:
    """The candidates of a baseline, the closest first: up to four for `p3p`, one for the others.

    - `frames`: triads on the three centres of the widest triangle (paper eq. 1-8)
    - `p3p`: depths from the distances of the same three (eq. 9-15), from their directions alone
    - `pnp`: SQPnP (Terzakis and Lourakis 2020) on the directions of all centres

    Raises NotConverged when a method has no answer, InvalidValue for targets whose place is not
    known, and for points where a method needs balls.
    """
    if any(ball.place.offset is None for ball in balls):
        raise InvalidValue(
            f"{method}: a baseline needs the targets' places, and an offset is unknown; give "
            "center, or use the method joint"
        )
    if method == "frames":
        balls = [ball for ball in balls if ball.is_ball]
        if len(balls) < 3:
            raise InvalidValue(
                f"frames: the paper's frames need three balls, there are {len(balls)}; points have "
                "no depth"
            )
    world = np.array([ball.place.in_base() for ball in balls])
    camera = np.array([ball.hint.centre_camera for ball in balls])
    poses = {"frames": _frames, "p3p": _p3p, "pnp": _pnp}[method](world, camera)
    candidates = [PoseCandidate(pose, _off(balls, pose)) for pose in poses]
    if not candidates:
        raise NotConverged(f"{method}: the balls found fit no pose; check the positions")
    return tuple(sorted(candidates, key=lambda c: c.off_pixels))


def _frames(world: Array, camera: Array) -> list[Pose]:
    three = _widest(world)
    return [pose_from_triads(world[three], camera[three])]


def _p3p(world: Array, camera: Array) -> list[Pose]:
    three = _widest(world)
    rays = camera[three] / np.linalg.norm(camera[three], axis=1)[:, None]
    poses = []
    for depths in depths_of_three(rays, world[three]):
        try:
            poses.append(pose_from_triads(world[three], rays * depths[:, None]))
        except DegeneratePositions:
            continue
    return poses


def _pnp(world: Array, camera: Array) -> list[Pose]:
    plane = camera[:, :2] / camera[:, 2:]
    done, rotation, translation = cv2.solvePnP(
        world, plane, np.eye(3), np.zeros(0), flags=cv2.SOLVEPNP_SQPNP
    )
    return [Pose.from_rotation_vector(rotation.ravel(), translation.ravel())] if done else []


def _widest(world: Array) -> list[int]:
    """The three points that span the widest triangle."""
    # of many positions a part of them spreads as wide
    chosen = np.linspace(0, len(world) - 1, min(len(world), MOST_COMPARED)).round().astype(int)
    triples = [tuple(chosen[list(t)]) for t in combinations(range(len(chosen)), 3)]
    a, b, c = (world[[t[i] for t in triples]] for i in range(3))
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    return [int(i) for i in triples[int(np.argmax(areas))]]


def _off(balls: Sequence[Seen], pose: Pose) -> float:
    offs = [ball.off_pixels(pose.apply(ball.place.in_base())) for ball in balls]
    return float(np.sqrt(np.mean(np.square(offs))))
