# SPDX-License-Identifier: GPL-3.0-or-later
"""URDF, SDF and MJCF in the programs they are for: PyBullet, and MuJoCo where it is there."""

from __future__ import annotations

import math
import os

import numpy as np
import pytest
from monocell.core import (
    Box,
    Camera,
    Cell,
    Cone,
    Cylinder,
    Intrinsics,
    Motion,
    Pose,
    Prism,
    Sphere,
    Tube,
)
from monocell.core.formats.text_formats import write_text_format
from monocell.core.primitives import polygon_centre
from monocell.core.shape.mass import volume
from monocell.core.shape.pieces import pieces_of
from monocell.core.shape.tessellation import tessellated

CAMERA = Camera(
    Intrinsics(640, 480, 600.0, 580.0, 333.0, 230.0),
    Pose.looking_at([1.6, -1.3, 1.1], [0.3, 0, 0.1], [0, 0, 1]),
)
TURNED = Pose.from_rotation_vector([0.4, -0.3, 1.1], [0.5, 0.2, 0.3])
LEVEL = Pose.from_rotation_vector([0, 0, 0.5], [0.2, -0.4, 0.2])
CORNERS = np.array([[0, 0], [0.2, 0], [0.2, 0.05], [0.05, 0.05], [0.05, 0.15], [0, 0.15]])
SOLIDS = {
    "box": Box("Kiste ä", TURNED, size=[0.3, 0.2, 0.1]),
    "cylinder": Cylinder("drum", TURNED, radius=0.1, height=0.3),
    "sphere": Sphere("ball", TURNED, radius=0.07),
    "cone": Cone("cone", TURNED, radius=0.1, height=0.3),
    "frustum": Cone("frustum", TURNED, radius=0.1, top_radius=0.05, height=0.3),
    "tube": Tube("tube", TURNED, radius=0.1, inner_radius=0.08, height=0.3),
    "prism": Prism("ell", TURNED, polygon=CORNERS - polygon_centre(CORNERS), height=0.1),
}
HINGE = Motion(
    "attached",
    mass=2,
    to="chest",
    joint="hinge",
    axis=[1, 0, 0],
    point=[0, -0.1, -0.01],
    limits=(0, 1),
)
CHEST = (
    Box("chest", LEVEL, size=[0.3, 0.2, 0.2]),
    Box("lid", LEVEL @ Pose(np.eye(3), [0, 0, 0.11]), size=[0.3, 0.2, 0.02], motion=HINGE),
    Cone("hat", TURNED, radius=0.05, height=0.2, motion=Motion("movable", mass=1.5)),
)


@pytest.fixture
def bullet():
    from monocell.headless.robot.bullet import chatter_off, pybullet

    p = pybullet()
    with chatter_off():
        client = p.connect(p.DIRECT)
        yield p
        p.disconnect(client)


@pytest.fixture
def mujoco(monkeypatch):
    # which it reads once, when it is imported; its own choice needs a display
    if "MUJOCO_GL" not in os.environ:
        monkeypatch.setenv("MUJOCO_GL", "egl")
    return pytest.importorskip("mujoco", reason="no mujoco here: pip install mujoco")


def bounds(thing):
    points = thing.world_from_object.apply(tessellated(thing).vertices)
    return np.array([points.min(axis=0), points.max(axis=0)])


def nearest(bullet, body, link, point):
    """How far a body is from a point, seen by a ball of a millimetre."""
    ball = bullet.createCollisionShape(bullet.GEOM_SPHERE, radius=1e-3)
    probe = bullet.createMultiBody(0, ball, basePosition=list(point))
    found = bullet.getClosestPoints(probe, body, 1.0, linkIndexB=link)
    bullet.removeBody(probe)
    return min(contact[8] for contact in found) + 1e-3


@pytest.mark.robot
@pytest.mark.parametrize("kind", SOLIDS)
def test_a_urdf_in_bullet_is_the_solid_where_it_stands(bullet, kind, tmp_path):
    thing = SOLIDS[kind]
    write_text_format(Cell(CAMERA, objects=(thing,)), tmp_path / "cell.urdf")
    body = bullet.loadURDF(str(tmp_path / "cell.urdf"), useFixedBase=True)
    names = [bullet.getJointInfo(body, j)[12].decode() for j in range(bullet.getNumJoints(body))]
    link = names.index({"Kiste ä": "Kiste_a"}.get(thing.name, thing.name))
    for point in np.random.default_rng(2).uniform(-0.4, 0.4, (12, 3)) + TURNED.translation:
        wanted = distance(thing, TURNED.inverse().apply(point))
        if wanted > 0.01:
            # Bullet rounds edges and hulls by a margin of a millimetre
            assert nearest(bullet, body, link, point) == pytest.approx(wanted, abs=2e-3)


def distance(thing, point):
    """From a point in the object's frame to its surface, by a fine mesh of points on it."""
    shape = tessellated(thing)
    corners = shape.vertices[shape.triangles]
    steps = np.linspace(0, 1, 25 if len(corners) < 1000 else 3)
    a, b = (grid.ravel() for grid in np.meshgrid(steps, steps))
    a, b = a[a + b <= 1], b[a + b <= 1]
    spread = corners[:, None, 0] * (1 - a - b)[:, None]
    spread = spread + corners[:, None, 1] * a[:, None] + corners[:, None, 2] * b[:, None]
    return float(np.linalg.norm(spread.reshape(-1, 3) - point, axis=1).min())


@pytest.mark.robot
def test_boxes_cylinders_and_balls_are_exact_in_urdf_and_sdf_and_mjcf(bullet, tmp_path):
    things = [SOLIDS[kind] for kind in ("box", "cylinder", "sphere")]
    halves = {"box": [0.3, 0.2, 0.1], "sphere": [0.07]}
    for ending, load in (
        (".urdf", lambda path: [bullet.loadURDF(path, useFixedBase=True)]),
        (".sdf", bullet.loadSDF),
        (".xml", bullet.loadMJCF),
    ):
        for thing in things:
            path = tmp_path / f"{thing.kind}{ending}"
            write_text_format(Cell(Camera(CAMERA.intrinsics), objects=(thing,)), path)
            shapes = []
            for body in load(str(path)):
                for link in range(-1, bullet.getNumJoints(body)):
                    for shape in bullet.getCollisionShapeData(body, link):
                        shapes.append((body, link, shape))
            ((body, link, shape),) = shapes
            at, turn = bullet_pose(bullet, body, link, shape)
            np.testing.assert_allclose(at, TURNED.translation, atol=1e-6)
            assert thing.kind == "sphere" or abs(turn).max() < 1e-6
            if thing.kind in halves:
                size = shape[3][: len(halves[thing.kind])]
                np.testing.assert_allclose(size, halves[thing.kind], rtol=1e-6)
            elif ending == ".xml":
                assert shape[3][0] == pytest.approx(0.3) and shape[3][1] == pytest.approx(0.1)
            low, high = bullet.getAABB(body, link)
            slack = 0.06 if thing.kind == "cylinder" else 2.5e-3
            np.testing.assert_allclose([low, high], bounds(thing), atol=slack)


def bullet_pose(bullet, body, link, shape):
    """Where a collision shape stands, and how it is turned away from the truth."""
    if link == -1:
        at, turn = bullet.getBasePositionAndOrientation(body)
    else:
        at, turn = bullet.getLinkState(body, link, computeForwardKinematics=1)[:2]
    at, turn = bullet.multiplyTransforms(at, turn, shape[5], shape[6])
    matrix = np.array(bullet.getMatrixFromQuaternion(turn)).reshape(3, 3)
    return at, matrix - TURNED.rotation


@pytest.mark.robot
def test_a_hinge_in_bullet_turns_the_lid_about_its_edge(bullet, tmp_path):
    write_text_format(Cell(CAMERA, objects=CHEST), tmp_path / "cell.urdf")
    body = bullet.loadURDF(str(tmp_path / "cell.urdf"), useFixedBase=True)
    joints = {bullet.getJointInfo(body, j)[12].decode(): j for j in range(4)}
    info = bullet.getJointInfo(body, joints["lid"])
    assert info[2] == bullet.JOINT_REVOLUTE and (info[8], info[9]) == (0, 1)
    bullet.resetJointState(body, joints["lid"], math.pi / 4)
    at = bullet.getLinkState(body, joints["lid"], computeForwardKinematics=1)[0]
    turned = Pose.from_rotation_vector([math.pi / 4, 0, 0], np.zeros(3)).apply([0, 0.1, 0.01])
    wanted = CHEST[1].world_from_object.apply(turned + HINGE.point)
    np.testing.assert_allclose(at, wanted, atol=1e-6)
    assert bullet.getDynamicsInfo(body, joints["lid"])[0] == 2
    masses = bullet.getDynamicsInfo(body, joints["hat"])
    assert masses[0] == 1.5


@pytest.mark.parametrize("ending", [".xml", ".urdf"])
def test_mujoco_has_every_solid_where_it_stands(mujoco, ending, tmp_path):
    model, data = loaded(mujoco, tuple(SOLIDS.values()), tmp_path / f"cell{ending}")
    names = [thing.name if thing.name != "Kiste ä" else "Kiste_a" for thing in SOLIDS.values()]
    if ending == ".urdf":
        # MuJoCo joins what is fixed to the world with it
        assert model.ngeom == sum(pieces_count(thing) for thing in SOLIDS.values())
        return
    for thing, name in zip(SOLIDS.values(), names, strict=True):
        body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, name)
        points = np.concatenate([corners(model, data, g) for g in geoms(model, body)])
        if thing.kind in ("box", "cylinder", "sphere"):
            (geom,) = geoms(model, body)
            wanted = {"box": [0.15, 0.1, 0.05], "cylinder": [0.1, 0.15], "sphere": [0.07]}
            size = model.geom_size[geom][: len(wanted[thing.kind])]
            np.testing.assert_allclose(size, wanted[thing.kind], rtol=1e-9)
            np.testing.assert_allclose(data.geom_xpos[geom], TURNED.translation, atol=1e-9)
            rotation = data.geom_xmat[geom].reshape(3, 3)
            assert thing.kind == "sphere" or np.abs(rotation - TURNED.rotation).max() < 1e-9
        else:
            wanted = TURNED.apply(np.concatenate(pieces_of(thing).corners()))
            box = [wanted.min(axis=0), wanted.max(axis=0)]
            np.testing.assert_allclose([points.min(axis=0), points.max(axis=0)], box, atol=1e-6)


def loaded(mujoco, things, path):
    write_text_format(Cell(CAMERA, objects=things), path)
    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return model, data


def pieces_count(thing):
    exact = thing.kind in ("box", "cylinder", "sphere")
    return 1 if exact else len(pieces_of(thing).placed)


def geoms(model, body):
    return [i for i in range(model.ngeom) if model.geom_bodyid[i] == body]


def corners(model, data, geom):
    number = model.geom_dataid[geom]
    if number < 0:
        return np.zeros((0, 3))
    start = model.mesh_vertadr[number]
    points = model.mesh_vert[start : start + model.mesh_vertnum[number]]
    return points @ data.geom_xmat[geom].reshape(3, 3).T + data.geom_xpos[geom]


def test_mujoco_moves_what_moves_with_its_mass_and_moments(mujoco, tmp_path):
    model, data = loaded(mujoco, CHEST, tmp_path / "cell.xml")
    assert model.njnt == 2
    hinge = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, "lid_joint")
    assert model.jnt_range[hinge].tolist() == [0, 1]
    hat = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, "hat")
    assert model.body_mass[hat] == 1.5
    moments = 1.5 * np.array([3 / 20 * 0.05**2 + 3 / 80 * 0.2**2] * 2 + [3 / 10 * 0.05**2])
    np.testing.assert_allclose(sorted(model.body_inertia[hat]), sorted(moments), rtol=1e-9)
    data.qpos[model.jnt_qposadr[hinge]] = 0.7
    mujoco.mj_forward(model, data)
    lid = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_GEOM, "lid")
    turned = Pose.from_rotation_vector([0.7, 0, 0], np.zeros(3)).apply([0, 0.1, 0.01])
    wanted = CHEST[1].world_from_object.apply(turned + HINGE.point)
    np.testing.assert_allclose(data.geom_xpos[lid], wanted, atol=1e-9)


def test_mujoco_renders_the_cell_s_camera_at_its_pixels(mujoco, tmp_path):
    ball = Sphere("ball", Pose(np.eye(3), [0.35, 0.1, 0.2]), radius=0.03)
    model, data = loaded(mujoco, (ball,), tmp_path / "cell.xml")
    model.vis.global_.offwidth, model.vis.global_.offheight = 640, 480
    try:
        renderer = mujoco.Renderer(model, 480, 640)
    except Exception as error:
        pytest.skip(f"MuJoCo can't render here: {error}")
    renderer.enable_segmentation_rendering()
    renderer.update_scene(data, "camera")
    seen = np.argwhere(renderer.render()[..., 0] == 0)
    renderer.close()
    assert len(seen) > 200
    middle = CAMERA.project([[0.35, 0.1, 0.2]])[0]
    # a ball's outline is centred a little beside its centre
    np.testing.assert_allclose(seen.mean(axis=0)[::-1], middle, atol=0.15)


def test_volumes_of_the_truth_are_not_all_alike():
    assert len({round(volume(thing), 6) for thing in SOLIDS.values()}) == len(SOLIDS)
