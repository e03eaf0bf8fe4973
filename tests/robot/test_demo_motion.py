# SPDX-License-Identifier: GPL-3.0-or-later
"""Motions worth planning: both ends free, the straight way blocked; and none where none is."""

from __future__ import annotations

from itertools import islice

import numpy as np
import pytest
from monocell.core import Box, Pose
from monocell.core.errors import InvalidValue, NoPath
from monocell.headless.robot.demo_motion import blocked_motion, blocked_motions
from monocell.headless.robot.planning import plan_path
from monocell.headless.robot.scene import RobotScene

pytestmark = pytest.mark.robot


def test_the_straight_motion_hits_a_named_object_between_two_free_ends(cell):
    for motion in islice(blocked_motions(cell, ["tower", "drum"]), 3):
        assert motion.straight.worst.gap.thing in ("tower", "drum")
        assert motion.straight.worst.gap.distance <= -0.010
        assert cell.in_collision(motion.straight.worst.joints)
        for end in (motion.start, motion.goal):
            assert not cell.in_collision(end, margin=0.010)


def test_there_is_a_way_round_for_the_first_motion(cell):
    motion = blocked_motion(cell)
    plan = plan_path(cell, motion.start, motion.goal)
    assert plan.attempts > 0 and plan.walk.free


def test_the_same_scene_gives_the_same_motion(cell):
    first, again = blocked_motion(cell), blocked_motion(cell)
    assert np.array_equal(first.start, again.start) and np.array_equal(first.goal, again.goal)


def test_objects_out_of_reach_block_nothing_and_it_is_said(arm):
    far = Box("far", Pose(np.eye(3), np.array([3.0, 0, 0.1])), size=np.array([0.2, 0.2, 0.2]))
    with RobotScene(arm, [far]) as scene, pytest.raises(NoPath, match="hits any of far by 10 mm"):
        blocked_motion(scene)


def test_a_name_that_is_no_object_is_refused(cell):
    with pytest.raises(InvalidValue, match="no object of the scene is called 'table'"):
        blocked_motion(cell, ["table"])
