# SPDX-License-Identifier: GPL-3.0-or-later
"""How far any point of the arm can move while its joints do: a bound, for proofs between samples.

Turning joint i by d moves nothing by more than `radii[i] * |d|`, whatever the other joints do.
"""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from ...core.arrays import Array
from .arm import Arm
from .bullet import pybullet

if TYPE_CHECKING:
    from .scene import RobotScene


def sweep_radii(scene: RobotScene) -> Array:
    """For each joint (n,) the metres per radian that it can move any point of the arm at most.

    The sum of the lengths between the joints further out and the size of the link there; 1 for a
    sliding joint.
    """
    arm = scene.arm
    scene.place(arm.rest)
    # Bullet refreshes the boxes around its bodies only here
    pybullet().performCollisionDetection(physicsClientId=arm.client)
    sizes = _sizes(scene)
    radii = [
        max(_lengths(arm, i, link) + size for link, size in sizes[i]) for i in range(len(sizes))
    ]
    return np.where(arm.slides, 1.0, radii)


def _sizes(scene: RobotScene) -> list[list[tuple[int, float]]]:
    """For each joint, the links it moves and how far each reaches from its own origin."""
    arm, p = scene.arm, pybullet()
    reaches: dict[int, float] = {}
    for part in scene.parts:
        link = part.link if part.body == arm.body else arm.flange
        box: Any = p.getAABB(part.body, part.link, physicsClientId=arm.client)
        corners = np.array(list(product(*zip(*box, strict=True))))
        far = np.linalg.norm(corners - arm.world_from_link(link).translation, axis=1).max()
        reaches[link] = max(reaches.get(link, 0.0), float(far))
    return [
        [(link, far) for link, far in reaches.items() if joint in arm.chain(link)]
        for joint in arm.moving
    ]


def _lengths(arm: Arm, joint: int, link: int) -> float:
    """The way from a joint's origin along the origins of the links to that of `link`, at most."""
    chain = arm.chain(link)
    outward = chain[chain.index(arm.moving[joint]) :]
    origins = np.array([arm.world_from_link(k).translation for k in outward])
    slides = [arm.moving.index(k) for k in outward[1:] if k in arm.moving]
    travel = sum(float(max(abs(arm.lower[k]), abs(arm.upper[k]))) for k in slides if arm.slides[k])
    return float(np.linalg.norm(np.diff(origins, axis=0), axis=1).sum()) + travel
