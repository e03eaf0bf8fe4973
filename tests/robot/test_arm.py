# SPDX-License-Identifier: GPL-3.0-or-later
"""The arm against a URDF reader of the test's own, and its inverse against its forward."""

from __future__ import annotations

import subprocess
import sys
import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from monocell.core import Pose
from monocell.core.errors import DocumentError, InvalidValue, Unreachable

pytestmark = pytest.mark.robot

MOVED_BASE = Pose.from_rotation_vector([0.1, -0.2, 0.7], [0.3, -0.4, 0.5])
AWKWARD = """<robot name="r">
<link name="foot"><inertial><origin xyz="0.1 0.2 0.3" rpy="0.3 0.2 0.1"/><mass value="1"/>
<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
<visual><origin xyz="0.5 0 0.1" rpy="0.2 0.3 0.4"/><geometry><box size="0.1 0.2 0.3"/></geometry>
<material name="grey"><color rgba="0.5 0.5 0.5 1"/></material></visual></link>
<link name="hand"><inertial><origin xyz="-0.1 0.2 0.1" rpy="0.5 0.2 0.1"/><mass value="1"/>
<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
<visual><origin xyz="0 0.4 0.1" rpy="0.2 0 0.4"/><geometry><cylinder radius="0.1" length="0.3"/>
</geometry></visual></link>
<joint name="turn" type="continuous"><parent link="foot"/><child link="hand"/>
<origin xyz="1 0 0" rpy="0.1 0.2 0.3"/><axis xyz="0 0.6 0.8"/></joint></robot>"""


def origin(element):
    if element is None:
        return np.eye(4)
    roll, pitch, yaw = map(float, element.get("rpy", "0 0 0").split())
    turns = [Pose.from_rotation_vector(v, [0, 0, 0]) for v in np.diag([roll, pitch, yaw])]
    matrix = (turns[2] @ turns[1] @ turns[0]).matrix()
    matrix[:3, 3] = list(map(float, element.get("xyz", "0 0 0").split()))
    return matrix


def own_forward(urdf, joints, base):
    """World poses (4, 4) of all links by name: the URDF specification, written out."""
    root = ElementTree.fromstring(urdf)
    frames = {root.find("link").get("name"): base.matrix()}
    for joint, angle in zip(root.findall("joint"), joints, strict=True):
        axis = np.array(list(map(float, joint.find("axis").get("xyz").split())))
        turn = Pose.from_rotation_vector(axis * angle, [0, 0, 0]).matrix()
        parent = frames[joint.find("parent").get("link")]
        frames[joint.find("child").get("link")] = parent @ origin(joint.find("origin")) @ turn
    return frames


def own_visuals(urdf, frames):
    root = ElementTree.fromstring(urdf)
    return [
        frames[link.get("name")] @ origin(visual.find("origin"))
        for link in root.findall("link")
        for visual in link.findall("visual")
    ]


@pytest.fixture(scope="module")
def moved_arm():
    from monocell.headless.robot.arm import Arm

    with Arm(world_from_base=MOVED_BASE) as built:
        yield built


@pytest.fixture(scope="module")
def awkward_arm(tmp_path_factory):
    from monocell.headless.robot.arm import Arm

    path = tmp_path_factory.mktemp("urdf") / "awkward.urdf"
    path.write_text(AWKWARD)
    with Arm(path, MOVED_BASE) as built:
        yield built


angles = st.lists(st.floats(-2, 2), min_size=7, max_size=7)


@settings(max_examples=40, deadline=None)
@given(angles)
def test_the_flange_is_where_the_urdf_puts_it(moved_arm, joints):
    frames = own_forward(moved_arm.urdf.read_text(), joints, MOVED_BASE)
    flange = moved_arm.world_from_flange(joints).matrix()
    assert np.abs(flange - frames["lbr_iiwa_link_7"]).max() < 1e-9


@settings(max_examples=20, deadline=None)
@given(angles)
def test_every_visual_mesh_stands_where_the_urdf_puts_it(moved_arm, joints):
    urdf = moved_arm.urdf.read_text()
    expected = own_visuals(urdf, own_forward(urdf, joints, MOVED_BASE))
    parts = moved_arm.parts(joints)
    assert [p.path.name for p in parts] == [f"link_{i}.obj" for i in range(8)]
    for part, matrix in zip(parts, expected, strict=True):
        assert np.abs(part.world_from_mesh.matrix() - matrix).max() < 1e-9


@settings(max_examples=20, deadline=None)
@given(st.floats(-6, 6))
def test_inertial_frames_do_not_move_links_or_visuals(awkward_arm, angle):
    frames = own_forward(AWKWARD, [angle], MOVED_BASE)
    assert np.abs(awkward_arm.world_from_flange([angle]).matrix() - frames["hand"]).max() < 1e-6
    for part, matrix in zip(awkward_arm.parts([angle]), own_visuals(AWKWARD, frames), strict=True):
        assert np.abs(part.world_from_mesh.matrix() - matrix).max() < 1e-6


def test_primitive_visuals_become_meshes_of_their_size(awkward_arm):
    import trimesh

    box, cylinder = (trimesh.load_mesh(part.path) for part in awkward_arm.parts([0.0]))
    assert box.extents == pytest.approx([0.1, 0.2, 0.3])
    assert cylinder.extents == pytest.approx([0.2, 0.2, 0.3], abs=1e-3)


def test_urdf_colours_arrive_in_linear_light(moved_arm, awkward_arm):
    orange = moved_arm.parts(moved_arm.rest)[3].color
    assert orange == pytest.approx([1.0, 0.1500, 0.0030], abs=1e-3)
    assert awkward_arm.parts([0.0])[0].color == pytest.approx([0.2140] * 3, abs=1e-3)


def test_a_continuous_joint_turns_freely(awkward_arm):
    assert awkward_arm.lower[0] < -np.pi and awkward_arm.upper[0] > np.pi


@settings(max_examples=20, deadline=None)
@given(angles, st.lists(st.floats(-0.3, 0.3), min_size=3, max_size=3))
def test_the_jacobian_is_the_derivative_of_forward_kinematics(moved_arm, joints, point):
    q, h = np.array(joints), 1e-5
    moves, turns = moved_arm.jacobian(q, moved_arm.world_from_flange(q).apply(point))
    for i, step in enumerate(np.eye(7) * h):
        ahead, behind = (moved_arm.world_from_flange(q + s * step) for s in (1, -1))
        moved = (ahead.apply(point) - behind.apply(point)) / (2 * h)
        turned = (ahead @ behind.inverse()).rotation_vector() / (2 * h)
        assert moves[:, i] == pytest.approx(moved, abs=1e-6)
        assert turns[:, i] == pytest.approx(turned, abs=1e-6)


@settings(max_examples=25, deadline=None)
@given(st.lists(st.floats(0.02, 0.98), min_size=7, max_size=7))
def test_joints_reaching_a_reachable_pose_reach_it_within_their_limits(arm, parts):
    target = arm.world_from_flange(arm.lower + np.array(parts) * (arm.upper - arm.lower))
    joints = arm.joints_reaching(target)
    found = arm.world_from_flange(joints)
    assert np.linalg.norm(found.translation - target.translation) < 1e-4
    assert (found @ target.inverse()).rotation_vector() == pytest.approx(np.zeros(3), abs=1e-3)
    assert (joints >= arm.lower).all() and (joints <= arm.upper).all()


@settings(max_examples=25, deadline=None)
@given(st.floats(-2.5, 2.5), st.floats(0.45, 0.65), st.floats(0.05, 0.4))
def test_the_ball_is_carried_to_its_place_with_the_hand_pointing_down(arm, turn, away, height):
    place = [away * np.cos(turn), away * np.sin(turn), height]
    joints = arm.joints_reaching(place, point_flange=[0, 0, 0.12], pointing=[0, 0, -2.0])
    assert arm.ball_center(joints) == pytest.approx(place, abs=1e-4)
    assert arm.world_from_flange(joints).rotation[:, 2] == pytest.approx([0, 0, -1], abs=1e-3)


def test_the_same_seed_gives_the_same_joints(arm):
    first, again = (arm.joints_reaching([0.1, -0.5, 0.7], seed=3) for _ in range(2))
    assert (first == again).all()


def test_answers_that_are_not_accepted_are_passed_over(arm):
    refused = []

    def second(joints):
        refused.append(joints)
        return len(refused) > 1

    joints = arm.joints_reaching([0.4, 0.1, 0.5], accept=second)
    assert len(refused) == 2 and np.abs(joints - refused[0]).max() > 0.1
    with pytest.raises(Unreachable, match=r"without touching: \d+ of 48 starts reached it"):
        arm.joints_reaching([0.4, 0.1, 0.5], accept=lambda joints: False)


def test_a_place_out_of_reach_is_refused_with_how_far_it_is_missed(arm):
    # the shoulder is 0.36 m up, and from there to the flange it is 0.901 m at most
    with pytest.raises(Unreachable, match=r"\(2\.000, 0\.000, 0\.000\) m .* misses by 1131\.\d mm"):
        arm.joints_reaching([2.0, 0, 0])


def test_joints_outside_their_limits_are_refused_by_name(arm):
    with pytest.raises(InvalidValue, match=r"joints\[1\]: 2\.5000 .* lbr_iiwa_joint_2's limits"):
        arm.world_from_flange([0, 2.5, 0, 0, 0, 0, 0])
    with pytest.raises(InvalidValue, match=r"expected shape \(7\), got \(6,\)"):
        arm.parts(np.zeros(6))


def test_a_pose_and_a_direction_together_are_refused(arm):
    with pytest.raises(InvalidValue, match="the pose says already"):
        arm.joints_reaching(Pose.identity(), pointing=[0, 0, 1])


def test_a_missing_or_broken_urdf_is_refused(tmp_path):
    from monocell.headless.robot.arm import Arm

    with pytest.raises(DocumentError, match="no such URDF"):
        Arm(tmp_path / "none.urdf")
    broken = tmp_path / "broken.urdf"
    broken.write_text("<robot")
    with pytest.raises(DocumentError, match=r"broken\.urdf: PyBullet can't load"):
        Arm(broken)
    with pytest.raises(DocumentError, match=r"no link is called 'claw'; there is lbr_iiwa_link_0"):
        Arm(flange="claw")


def test_an_arm_without_a_ball_has_no_ball_centre(moved_arm):
    with pytest.raises(InvalidValue, match="holds no ball"):
        moved_arm.ball_center(moved_arm.rest)


def test_pybullets_banner_stays_off_standard_output():
    code = "from monocell.headless.robot.bullet import pybullet; pybullet(); print('mine')"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "mine\n"
