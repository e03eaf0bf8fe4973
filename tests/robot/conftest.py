# SPDX-License-Identifier: GPL-3.0-or-later
"""The cell that the robot tests share: the default arm with a ball, six objects, a table."""

from __future__ import annotations

import numpy as np
import pytest
from monocell.core import Appearance, Box, Cylinder, Pose


def standing(x, y, z, turn=0.0):
    return Pose.from_rotation_vector([0, 0, turn], [x, y, z])


def painted(*color):
    return Appearance(np.array(color))


@pytest.fixture(scope="session")
def objects():
    sigmas = np.array([1e-3] * 3 + [5e-4] * 3 + [8e-4] * 3)
    return (
        Box(
            "crate",
            standing(0.5, 0.18, 0.1, 0.3),
            size=np.array([0.2, 0.14, 0.2]),
            appearance=painted(0.55, 0.13, 0.06),
            covariance=np.diag(sigmas**2),
        ),
        Box("block", standing(0.62, -0.1, 0.06, -0.5), size=np.array([0.12, 0.1, 0.12])),
        Cylinder(
            "drum",
            standing(0.45, -0.28, 0.125),
            radius=0.06,
            height=0.25,
            appearance=painted(0.02, 0.1, 0.7),
        ),
        Cylinder("can", standing(0.38, 0.42, 0.06), radius=0.035, height=0.12),
        Box("plate", standing(0.7, 0.22, 0.025, 0.1), size=np.array([0.2, 0.12, 0.05])),
        Box("tower", standing(0.55, 0.02, 0.12, 0.8), size=np.array([0.08, 0.08, 0.24])),
    )


@pytest.fixture(scope="session")
def arm():
    from monocell.headless.robot.arm import Arm, HeldBall

    with Arm(ball=HeldBall(0.04, np.array([0.0, 0.0, 0.12]), 0.012)) as built:
        yield built


@pytest.fixture
def cell(arm, objects):
    from monocell.headless.robot.scene import RobotScene
    from monocell.headless.robot.shapes import table_top

    with RobotScene(arm, objects, table=table_top()) as built:
        yield built


@pytest.fixture(scope="session")
def ends(arm):
    """Joint angles to the right and to the left of the objects, the hand pointing down."""

    def at(x, y):
        return arm.joints_reaching([x, y, 0.13], point_flange=[0, 0, 0.12], pointing=[0, 0, -1])

    return at(0.35, -0.48), at(0.38, 0.56)
