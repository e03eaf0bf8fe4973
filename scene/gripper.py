# SPDX-License-Identifier: GPL-3.0-or-later
"""A parallel gripper that holds the ball: blocks and their places, from flange, ball and radius."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..core.arrays import Array
from ..core.pose import Pose

# fingers grip a ball of any size alike: these are parts of the ball's radius
FINGER_WIDTH = 0.55
FINGER_THICKNESS = 0.28
FINGER_BEYOND = 0.25
PALM_GAP = 0.45
# and these are metres
PALM_SIZE = (0.105, 0.062)
COUPLER_RADIUS, COUPLER_LENGTH = 0.036, 0.022


@dataclass(frozen=True, eq=False)
class Block:
    """A box (full `size` (3,)) or, when `round`, an upright cylinder of that bounding box."""

    name: str
    size: Array
    grip_from_block: Pose
    metal: bool
    round: bool = False


def grip_frame(center_world: Array, world_from_flange: Pose) -> Pose:
    """`world_from_grip`: origin in the ball's centre, z away from the flange, x across fingers."""
    along = center_world - world_from_flange.translation
    if np.linalg.norm(along) < 1e-6:
        along = world_from_flange.rotation[:, 2]
    z = along / np.linalg.norm(along)
    # the flange's own x where it can be, else its y: the fingers turn with the flange
    side = world_from_flange.rotation[:, 0]
    if abs(side @ z) > 0.9:
        side = world_from_flange.rotation[:, 1]
    x = side - (side @ z) * z
    x = x / np.linalg.norm(x)
    return Pose(np.stack([x, np.cross(z, x), z], axis=1), center_world)


def gripper_blocks(radius: float, reach: float) -> tuple[Block, ...]:
    """The blocks of a gripper on a ball of `radius`, `reach` metres from the flange, in its frame.

    The fingers touch the ball and do not enter it.
    """
    palm_end = -radius * (1 + PALM_GAP)
    thick, width = FINGER_THICKNESS * radius, FINGER_WIDTH * radius
    top, tip = palm_end - 0.004, FINGER_BEYOND * radius
    fingers = [
        Block(
            f"finger {side}",
            np.array([thick, width, tip - top]),
            _at(sign * (radius + thick / 2), 0.0, (tip + top) / 2),
            metal=False,
        )
        for side, sign in (("left", -1.0), ("right", 1.0))
    ]
    body = -reach + COUPLER_LENGTH
    if palm_end - body < 0.01:
        return tuple(fingers)
    palm_width = max(PALM_SIZE[0], 2 * (radius + thick))
    palm = Block(
        "palm",
        np.array([palm_width, PALM_SIZE[1], palm_end - body]),
        _at(0.0, 0.0, (palm_end + body) / 2),
        metal=False,
    )
    coupler = Block(
        "coupler",
        np.array([2 * COUPLER_RADIUS, 2 * COUPLER_RADIUS, COUPLER_LENGTH]),
        _at(0.0, 0.0, body - COUPLER_LENGTH / 2),
        metal=True,
        round=True,
    )
    return (*fingers, palm, coupler)


def _at(x: float, y: float, z: float) -> Pose:
    return Pose(np.eye(3), np.array([x, y, z]))
