# SPDX-License-Identifier: GPL-3.0-or-later
"""Paths: judged by walking them pose by pose with nothing but the scene's clearance."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from monocell.core.errors import InCollision, InvalidValue, NoPath
from monocell.headless.robot import planning
from monocell.headless.robot.planning import plan_path, straight_motion
from monocell.headless.robot.scene import RobotScene
from monocell.headless.robot.shapes import table_top
from monocell.headless.robot.sweep import sweep_radii
from monocell.headless.robot.walk import walk

pytestmark = pytest.mark.robot


def test_the_straight_motion_reports_where_and_what_it_hits(cell, ends):
    motion = straight_motion(cell, *ends)
    assert not motion.free
    assert motion.first_trouble.gap.thing == "drum"
    assert 0 < motion.first_trouble.fraction < motion.worst.fraction < 1
    assert cell.in_collision(motion.first_trouble.joints)
    assert {"drum", "block", "tower"} <= set(motion.troubles)
    before = ends[0] + (ends[1] - ends[0]) * (motion.first_trouble.fraction - 0.01)
    assert not cell.in_collision(before)


def test_the_walk_finds_the_smallest_gaps_of_all_its_poses(cell, ends):
    waypoints = np.array([ends[0], cell.arm.rest])
    found = walk(cell, waypoints, [0.0] * len(cell.names), 0.0, step=0.05)
    poses = ends[0] + (cell.arm.rest - ends[0]) * np.linspace(0, 1, found.poses)[:, None]
    gaps = [cell.clearance(q) for q in poses]
    own = [cell.own_clearance(q).distance for q in poses]
    assert found.nearest.gap.distance == pytest.approx(min(g.distance for g in gaps), abs=1e-9)
    assert found.nearest_own.gap.distance == pytest.approx(min(own), abs=1e-9)
    assert cell.clearance(found.nearest.joints).distance == pytest.approx(
        found.nearest.gap.distance, abs=1e-9
    )


turns = st.lists(st.floats(-0.2, 0.2), min_size=7, max_size=7)


@settings(max_examples=60, deadline=None)
@given(st.lists(st.floats(-1.8, 1.8), min_size=7, max_size=7), turns)
def test_no_vertex_of_the_arm_moves_farther_than_the_sweep_bound(arm, swept, joints, turn):
    radii, meshes = swept
    before, after = (arm.parts(np.array(joints) + d) for d in (np.zeros(7), np.array(turn)))
    bound = float(radii @ np.abs(turn))
    for a, b, vertices in zip(before, after, meshes, strict=True):
        moved = a.world_from_mesh.apply(vertices) - b.world_from_mesh.apply(vertices)
        assert np.linalg.norm(moved, axis=1).max() <= bound + 1e-9


@pytest.fixture(scope="module")
def swept(arm):
    import trimesh

    with RobotScene(arm) as alone:
        radii = sweep_radii(alone)
    return radii, [trimesh.load_mesh(p.path).vertices[::7] for p in arm.parts(arm.rest)]


def test_a_path_keeps_what_it_promises_at_every_pose_and_between(cell, ends):
    plan = plan_path(cell, *ends)
    assert (plan.waypoints[0] == ends[0]).all() and (plan.waypoints[-1] == ends[1]).all()
    assert plan.attempts >= 1
    poses = plan.poses(step=0.004)
    assert np.abs(np.diff(poses, axis=0)).max() <= 0.004 + 1e-12
    for joints in poses:
        gap = cell.clearance(joints)
        # the path was judged at other poses than these
        assert gap.distance > plan.walk.assured_clearance > 0
        assert gap.distance > plan.needs[gap.thing] - plan.walk.between
    assert plan.walk.nearest.gap.distance >= 0.010


def test_the_same_call_gives_the_same_path_and_another_seed_another(cell, ends):
    first, again, other = (plan_path(cell, *ends, seed=seed) for seed in (1, 1, 2))
    assert np.array_equal(first.waypoints, again.waypoints)
    assert not np.array_equal(first.waypoints, other.waypoints)


def test_a_free_straight_motion_needs_no_search(cell, ends):
    lifted = ends[0] - [0.0, 0.5, 0, 0, 0, 0, 0]
    plan = plan_path(cell, ends[0], lifted)
    assert plan.attempts == 0 and len(plan.waypoints) == 2
    assert plan.length == pytest.approx(0.5)


def test_an_uncertain_object_is_kept_three_sigma_farther_away(cell, arm, ends, objects):
    plan = plan_path(cell, *ends)
    assert plan.needs["crate"] > plan.needs["block"] == 0.010
    assert "no uncertainty is known of block, drum, can, plate, tower" in plan.warnings[0]
    vague = [replace(o, covariance=np.eye(6 + len(o.size_names)) * 0.003**2) for o in objects]
    with RobotScene(arm, vague, table=table_top()) as unsure:
        wide = plan_path(unsure, *ends)
    assert wide.warnings == ()
    assert min(wide.needs[o.name] for o in objects) > 0.019
    assert min(unsure_gap(cell, q, wide) for q in wide.poses(0.02)) > -0.004


def unsure_gap(cell, joints, plan):
    gap = cell.clearance(joints)
    return gap.distance - plan.needs[gap.thing]


def test_a_start_or_goal_in_collision_is_refused_with_the_object_and_the_depth(cell, arm, ends):
    place = [0.55, 0.02, 0.26]
    inside = arm.joints_reaching(place, point_flange=[0, 0, 0.12], pointing=[0, 0, -1])
    with pytest.raises(InCollision, match=r"goal: ball is 20\.0 mm inside tower, and 10\.0 mm"):
        plan_path(cell, ends[0], inside)
    with pytest.raises(InCollision, match=r"start: ball is 20\.0 mm inside tower"):
        plan_path(cell, inside, ends[0])


def test_an_end_that_is_free_but_too_near_is_refused(cell, arm, ends):
    place = [0.55, 0.02, 0.285]
    near = arm.joints_reaching(place, point_flange=[0, 0, 0.12], pointing=[0, 0, -1])
    with pytest.raises(InCollision, match=r"ball is 5\.0 mm from tower, and 10\.0 mm are needed"):
        plan_path(cell, ends[0], near)
    assert plan_path(cell, near, arm.rest, safety=0.002).walk.free


def test_a_search_that_ends_empty_says_how_much_was_tried(cell, ends, monkeypatch):
    monkeypatch.setattr(planning, "MOST_TESTS", 1)
    with pytest.raises(NoPath, match=r"in 2 searches of 1 tests each"):
        plan_path(cell, *ends)


def test_a_path_that_fails_its_judgement_is_searched_anew(cell, ends, monkeypatch):
    # so coarse that edges jump through whole objects
    monkeypatch.setattr(planning, "ATTEMPTS", ((3.0, 0.0), (0.02, 0.0), (0.01, 0.004)))
    plan = plan_path(cell, *ends)
    assert plan.attempts > 1 and plan.walk.free
    monkeypatch.setattr(planning, "ATTEMPTS", ((3.0, 0.0),))
    with pytest.raises(NoPath, match=r"on the best one \w+ is .* are needed"):
        plan_path(cell, *ends)


def test_margins_of_things_that_are_not_there_are_refused(cell, ends):
    with pytest.raises(InvalidValue, match="margins: ghost is not in the scene; there is crate"):
        plan_path(cell, *ends, margins={"ghost": 0.01})
    with pytest.raises(InvalidValue, match=r"crate: -0\.01 m is not from 0 to 1 m"):
        plan_path(cell, *ends, margins={"crate": -0.01})
