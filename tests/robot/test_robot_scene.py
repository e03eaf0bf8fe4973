# SPDX-License-Identifier: GPL-3.0-or-later
"""Distances against geometry written out: boxes and cylinders are exact, hulls on the safe side."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from monocell.core import Box, Cylinder, Pose
from monocell.core.errors import InvalidValue

pytestmark = pytest.mark.robot

HALF = np.array([0.1, 0.05, 0.08])
TURNED = Pose.from_rotation_vector([0.4, -0.3, 1.1], [0.2, -0.1, 0.3])
places = st.lists(st.floats(-0.3, 0.3), min_size=3, max_size=3)
# a fold that lays the forearm on the upper arm's foot
FOLDED = (0.0, 2.09, 0.0, -2.09, 0.0, -1.5, 0.0)


def beyond_box(points, half=HALF):
    over = np.abs(points) - half
    return np.linalg.norm(np.maximum(over, 0), axis=-1) + np.minimum(over.max(axis=-1), 0)


def beyond_cylinder(points, radius, half):
    over = np.stack(
        [np.hypot(points[..., 0], points[..., 1]) - radius, np.abs(points[..., 2]) - half], axis=-1
    )
    return np.linalg.norm(np.maximum(over, 0), axis=-1) + np.minimum(over.max(axis=-1), 0)


@pytest.fixture(scope="module")
def probe():
    """A ball of 20 mm that measures its distance from an obstacle, from a point in its frame."""
    from monocell.headless.robot.bullet import pybullet
    from monocell.headless.robot.shapes import add_obstacle, add_sphere

    p = pybullet()
    client = p.connect(p.DIRECT)
    sphere = add_sphere(client, 0.02)
    bodies = {}

    def distance(thing, point):
        if thing.name not in bodies:
            bodies[thing.name] = add_obstacle(client, thing)
        at = thing.world_from_object.apply(point).tolist()
        p.resetBasePositionAndOrientation(sphere, at, [0, 0, 0, 1], physicsClientId=client)
        body = bodies[thing.name]
        return min(x[8] for x in p.getClosestPoints(sphere, body, 5.0, physicsClientId=client))

    yield distance
    p.disconnect(client)


@settings(max_examples=200, deadline=None)
@given(places)
def test_the_distance_to_a_box_is_exact_at_faces_edges_and_corners(probe, point):
    true = float(beyond_box(np.array(point))) - 0.02
    if true > 1e-4:
        assert probe(Box("box", TURNED, size=2 * HALF), point) == pytest.approx(true, abs=1e-9)


@settings(max_examples=200, deadline=None)
@given(places)
def test_the_distance_to_a_cylinder_is_never_more_than_a_fiftieth_of_a_millimetre_off(probe, point):
    true = float(beyond_cylinder(np.array(point), 0.06, 0.1)) - 0.02
    if true > 1e-4:
        thing = Cylinder("drum", TURNED, radius=0.06, height=0.2)
        assert probe(thing, point) == pytest.approx(true, abs=2e-5)


def test_the_stated_clearance_is_never_more_than_that_of_the_links_own_vertices(arm, objects):
    import trimesh
    from monocell.headless.robot.scene import RobotScene

    meshes = [trimesh.load_mesh(p.path).vertices for p in arm.parts(arm.rest)]
    random = np.random.default_rng(5)
    nearest = []
    with RobotScene(arm, [objects[0]]) as cell:
        for _ in range(40):
            joints = random.uniform(arm.lower, arm.upper)
            stated = cell.clearance(joints).distance
            object_from_world = objects[0].world_from_object.inverse()
            measured = min(
                beyond_box(
                    (object_from_world @ part.world_from_mesh).apply(vertices),
                    objects[0].half_extent,
                ).min()
                for part, vertices in zip(arm.parts(joints)[1:], meshes[1:], strict=True)
            )
            assert stated <= measured + 1e-6
            nearest.append(measured - stated)
    # without the ball the two would differ by little more than the 1 mm of the hulls
    assert 0.0008 < min(nearest) < 0.004


def test_the_nearest_thing_link_and_point_are_named(cell, arm):
    joints = arm.joints_reaching([0.55, 0.02, 0.3], point_flange=[0, 0, 0.12], pointing=[0, 0, -1])
    gap = cell.clearance(joints)
    assert (gap.link, gap.thing) == ("ball", "tower")
    assert gap.distance == pytest.approx(0.3 - 0.24 - 0.04, abs=1e-5)
    assert gap.at_world == pytest.approx([0.55, 0.02, 0.24], abs=1e-3)
    assert str(gap) == "ball is 20.0 mm from tower"


def test_overlap_is_a_collision_and_a_margin_makes_one_earlier(cell, arm):
    def above_tower(height):
        place = [0.55, 0.02, 0.24 + 0.04 + height]
        return arm.joints_reaching(place, point_flange=[0, 0, 0.12], pointing=[0, 0, -1])

    assert cell.in_collision(above_tower(-0.01))
    assert "10.0 mm inside tower" in str(cell.clearance(above_tower(-0.01)))
    assert not cell.in_collision(above_tower(0.01))
    assert cell.in_collision(above_tower(0.01), margin=0.011)
    assert not cell.in_collision(above_tower(0.01), margin=0.009)


def test_the_fast_answer_agrees_with_the_measured_one(cell, arm):
    random = np.random.default_rng(1)
    needs = [0.01] * len(cell.names)
    answers = []
    for _ in range(150):
        joints = random.uniform(arm.lower, arm.upper)
        near = cell.clearance(joints).distance < 0.01
        own = cell.own_clearance(joints).distance < 0.005
        answers.append(near or own)
        assert cell.blocked(joints, needs, 0.005) == answers[-1]
    assert 0.1 < np.mean(answers) < 0.9


def test_the_base_may_stand_on_its_table_and_the_rest_may_not_touch_it(cell, arm):
    assert not cell.in_collision(arm.rest)
    low = arm.joints_reaching([0.3, -0.45, 0.03], point_flange=[0, 0, 0.12], pointing=[0, 0, -1])
    gap = cell.clearance(low)
    assert gap.thing == "table" and gap.distance == pytest.approx(-0.01, abs=1e-5)


def test_the_arm_touching_itself_is_a_collision_without_any_obstacle(arm):
    from monocell.headless.robot.scene import RobotScene

    with RobotScene(arm) as alone:
        assert not alone.in_collision(arm.rest)
        assert alone.own_clearance(FOLDED).distance < 0
        assert alone.in_collision(FOLDED)


def test_closing_a_scene_takes_its_things_out_of_the_arms_world(arm, objects):
    from monocell.headless.robot.scene import RobotScene

    with RobotScene(arm, objects):
        pass
    with (
        RobotScene(arm) as alone,
        pytest.raises(InvalidValue, match="nothing that the arm could be near to"),
    ):
        alone.clearance(arm.rest)


def test_a_mesh_stands_in_for_its_convex_hull(arm):
    from monocell.headless.robot.environment import WorldMesh
    from monocell.headless.robot.scene import RobotScene
    from monocell.headless.robot.tessellation import triangles_of

    box = Box("box", Pose(np.eye(3), np.array([0.6, 0, 0.1])), size=np.array([0.1, 0.1, 0.2]))
    mesh = triangles_of(box)
    with RobotScene(arm, [box]) as exact:
        expected = exact.clearance(arm.rest).distance
    with RobotScene(arm, meshes=[WorldMesh("m", mesh.vertices, mesh.faces)]) as hulled:
        assert hulled.clearance(arm.rest).distance == pytest.approx(expected, abs=1e-6)


def test_two_things_of_one_name_are_refused(arm, objects):
    from monocell.headless.robot.scene import RobotScene

    with pytest.raises(InvalidValue, match="two things of the scene are called 'crate'"):
        RobotScene(arm, [objects[0], objects[0]])
