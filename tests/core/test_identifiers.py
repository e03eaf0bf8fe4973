# SPDX-License-Identifier: GPL-3.0-or-later
"""Names and angles as robot formats want them."""

from __future__ import annotations

import numpy as np
from drawn import poses
from hypothesis import given, settings
from hypothesis import strategies as st
from monocell.core import Pose
from monocell.core.formats.identifiers import identifiers
from monocell.core.rotation import roll_pitch_yaw


@settings(max_examples=60, deadline=None)
@given(poses())
def test_roll_pitch_and_yaw_are_the_rotation_at_a_quarter_turn_of_pitch_too(pose):
    quarter = Pose.from_rotation_vector([0, np.pi / 2, 0], np.zeros(3))
    for one in (pose, quarter @ pose, quarter):
        roll, pitch, yaw = roll_pitch_yaw(one.rotation)
        turns = [
            Pose.from_rotation_vector(v, np.zeros(3))
            for v in ([0, 0, yaw], [0, pitch, 0], [roll, 0, 0])
        ]
        found = (turns[0] @ turns[1] @ turns[2]).rotation
        assert np.abs(found - one.rotation).max() < 1e-12


@settings(max_examples=60, deadline=None)
@given(st.lists(st.text(min_size=1, max_size=6), unique=True, max_size=8))
def test_names_become_plain_and_stay_apart_even_where_case_does_not_count(names):
    found = identifiers(names, ("world",))
    assert len({name.lower() for name in (*found, "world")}) == len(names) + 1
    assert all(name.isascii() and name.isidentifier() for name in found)


def test_a_name_that_is_plain_keeps_itself_whoever_comes_before_it():
    assert identifiers(["a b", "a_b", "A_B", "world"], ("world",)) == (
        "a_b_2",
        "a_b",
        "A_B_3",
        "world_2",
    )
