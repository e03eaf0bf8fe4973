# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest
from monocell.core.urdf_chain import read_urdf_chain

pytestmark = pytest.mark.robot


@pytest.fixture(scope="module")
def arm():
    from monocell.headless.robot.arm import Arm

    with Arm() as made:
        yield made


def test_the_chain_puts_the_flange_where_pybullet_does(arm):
    chain = read_urdf_chain(arm.urdf)
    rng = np.random.default_rng(5)
    limits = np.array([joint.limits for joint in chain.moving])
    for _ in range(20):
        joints = rng.uniform(limits[:, 0], limits[:, 1])
        ours, theirs = chain.base_from_flange(joints), arm.world_from_flange(joints)
        # bullet keeps its numbers in single precision here and there
        assert np.allclose(ours.matrix(), theirs.matrix(), atol=1e-6)
