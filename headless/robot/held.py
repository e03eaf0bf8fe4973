# SPDX-License-Identifier: GPL-3.0-or-later
"""The ball in the flange, and its stem, as collision bodies that go where the arm goes."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...core.arrays import Array
from ...core.pose import Pose
from ...core.rotation import rotation_from_vector
from .arm import Arm
from .bullet import position_and_quaternion, pybullet
from .shapes import add_rod, add_sphere


class HeldBodies:
    """The bodies of `arm.ball` in the arm's world; none when it holds no ball."""

    def __init__(self, arm: Arm) -> None:
        self._arm = arm
        self._p: Any = pybullet()
        self.bodies: tuple[int, ...] = ()
        self._offsets: list[tuple[list[float], list[float]]] = []
        self._stem: int | None = None
        ball = arm.ball
        if ball is None:
            return
        self._hold(add_sphere(arm.client, ball.radius), Pose(np.eye(3), ball.center_flange))
        length = float(np.linalg.norm(ball.center_flange))
        if ball.stem_radius is not None and length > ball.radius:
            self._stem = add_rod(arm.client, ball.stem_radius, length)
            along = _turn_from_z(ball.center_flange / length)
            self._hold(self._stem, Pose(along, ball.center_flange / 2))
        self.follow()

    def follow(self) -> None:
        """Move the bodies to where the flange is now."""
        if not self.bodies:
            return
        client = self._arm.client
        state = self._p.getLinkState(
            self._arm.body, self._arm.flange, computeForwardKinematics=1, physicsClientId=client
        )
        for body, offset in zip(self.bodies, self._offsets, strict=True):
            place = self._p.multiplyTransforms(state[4], state[5], *offset)
            self._p.resetBasePositionAndOrientation(body, *place, physicsClientId=client)

    def touches(self, body: int, link: int) -> bool:
        """Whether a held body is meant to touch the link: the flange, for the stem the one before.

        The flange frame may lie deep in the wrist, and the stem starts there.
        """
        flange = self._arm.flange
        if body == self._stem:
            return self._arm.neighbours(link, flange)
        return self._arm.carrier(link) == self._arm.carrier(flange)

    def _hold(self, body: int, flange_from_body: Pose) -> None:
        self.bodies = (*self.bodies, body)
        self._offsets.append(position_and_quaternion(flange_from_body))


def _turn_from_z(direction: Array) -> Array:
    """A rotation (3, 3) that takes z to a unit direction."""
    axis = np.cross([0.0, 0.0, 1.0], direction)
    sine, cosine = float(np.linalg.norm(axis)), float(direction[2])
    if sine < 1e-12:
        return np.diag([1.0, np.sign(cosine), np.sign(cosine)])
    return rotation_from_vector(axis / sine * np.arctan2(sine, cosine))
