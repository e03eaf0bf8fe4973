# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from monocell.core.pose import Pose

pytestmark = pytest.mark.blender

numbers = st.floats(-2.0, 2.0)
vectors = st.tuples(numbers, numbers, numbers)


@given(st.floats(0.01, 0.1), st.floats(0.0, 0.4))
def test_the_fingers_touch_the_ball_and_nothing_enters_it(radius, reach):
    from monocell.scene.gripper import gripper_blocks

    blocks = gripper_blocks(radius, reach)
    for block in blocks:
        assert (block.size > 0).all()
        middle, half = block.grip_from_block.translation, block.size / 2
        nearest = np.clip(0.0, middle - half, middle + half)
        assert np.linalg.norm(nearest) >= radius * (1 - 1e-12)
        if block.name.startswith("finger"):
            assert np.linalg.norm(nearest) == pytest.approx(radius)


@given(vectors, vectors, vectors)
def test_the_grip_is_at_the_ball_and_looks_away_from_the_flange(turn, place, centre):
    from monocell.scene.gripper import grip_frame

    flange = Pose.from_rotation_vector(turn, place)
    grip = grip_frame(np.array(centre), flange)
    assert grip.translation.tolist() == list(centre)
    behind = grip.inverse().apply(flange.translation)
    assert np.abs(behind[:2]).max() < 1e-9
    assert behind[2] <= 1e-6
