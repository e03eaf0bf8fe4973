# SPDX-License-Identifier: GPL-3.0-or-later
"""Joints, masses and the camera in URDF, SDF and MJCF are those of the cell."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from format_cells import CAMERA, CHEST, at, written
from format_readers import floats, read_mjcf, read_sdf, read_urdf, sdf_pose
from monocell.core import Box, Cell, Composite, Distortion, Motion


def test_a_urdf_has_the_joints_with_their_limits_where_they_are(tmp_path):
    path, told = written(Cell(CAMERA, objects=CHEST), tmp_path, ".urdf")
    joints = read_urdf(path)[1]
    kinds = {name: (kind, parent) for name, (kind, parent, _, _) in joints.items()}
    assert kinds == {
        "chest": ("fixed", "world"),
        "lid": ("revolute", "chest"),
        "knob": ("fixed", "lid"),
        "drawer": ("prismatic", "chest"),
        "cup": ("fixed", "world"),
        "camera_optical_frame": ("fixed", "world"),
    }
    lid = joints["lid"][3]
    assert floats(lid.find("axis").get("xyz")).tolist() == [1, 0, 0]
    assert [float(lid.find("limit").get(k)) for k in ("lower", "upper")] == [0, 1.5]
    hinge = CHEST[1].world_from_object.apply([0, -0.1, -0.01])
    np.testing.assert_allclose(joints["lid"][2].translation, hinge, atol=1e-9)
    np.testing.assert_allclose(
        joints["camera_optical_frame"][2].matrix(), CAMERA.pose.inverse().matrix(), atol=1e-9
    )
    assert told == ("cup: stands fixed in URDF, which holds nothing that is free",)


def test_a_hinge_without_limits_turns_on_and_on_in_urdf(tmp_path):
    motion = replace(CHEST[1].motion, limits=None)
    things = (CHEST[0], replace(CHEST[1], motion=motion))
    path, _ = written(Cell(CAMERA, objects=things), tmp_path, ".urdf")
    kind, _, _, joint = read_urdf(path)[1]["lid"]
    assert kind == "continuous" and joint.find("limit").get("lower") is None


def test_an_sdf_has_what_stands_as_static_models_and_what_moves_with_its_joints(tmp_path):
    path, _ = written(Cell(CAMERA, objects=CHEST), tmp_path, ".sdf")
    _, models, _ = read_sdf(path)
    static = {name for name, model in models.items() if model.findtext("static") == "true"}
    assert static == {"chest", "camera"} and set(models) == static | {"lid", "drawer", "cup"}
    assert [link.get("name") for link in models["lid"].findall("link")] == ["lid", "knob"]
    joints = {
        joint.get("name"): (joint.get("type"), joint.findtext("parent"), joint.findtext("child"))
        for model in models.values()
        for joint in model.findall("joint")
    }
    assert joints == {
        "lid_joint": ("revolute", "world", "lid"),
        "knob_joint": ("fixed", "lid", "knob"),
        "drawer_joint": ("prismatic", "world", "drawer"),
    }
    limit = models["lid"].find("joint/axis/limit")
    assert [float(value.text) for value in limit] == [0, 1.5]


def test_masses_and_moments_are_those_of_the_solids(tmp_path):
    path, _ = written(Cell(CAMERA, objects=CHEST), tmp_path, ".xml")
    bodies = read_mjcf(path)[1]
    cup = bodies["cup"].find("inertial")
    # a cone's centre of mass is a quarter of its height above the base
    assert floats(cup.get("pos")).tolist() == pytest.approx([0, 0, 0.05 - 0.1])
    assert float(cup.get("mass")) == 1.5
    across = 1.5 * (3 / 20 * 0.05**2 + 3 / 80 * 0.2**2)
    about = 1.5 * 3 / 10 * 0.05**2
    wanted = [across, across, about, 0, 0, 0]
    np.testing.assert_allclose(floats(cup.get("fullinertia")), wanted, atol=1e-12)
    assert float(bodies["drawer"].find("inertial").get("mass")) == pytest.approx(
        500 * np.pi * 0.04**2 * 0.1
    )
    assert bodies["chest"].find("inertial") is None
    assert bodies["cup"].find("freejoint") is not None
    knob = bodies["lid"].find("body")
    assert knob.get("name") == "knob" and knob.find("joint") is None


def test_the_parts_of_a_composite_that_moves_are_one_body_of_its_mass(tmp_path):
    things = (CHEST[0], Box("board", at(0.5, 0.2, 0.3), size=[0.3, 0.1, 0.02]))
    group = Composite("both", ("chest", "board"), Motion("movable", mass=3.0))
    cell = Cell(CAMERA, objects=things, composites=(group,))
    path, _ = written(cell, tmp_path, ".sdf")
    (model,) = (m for name, m in read_sdf(path)[1].items() if name != "camera")
    weights = [float(mass.text) for mass in model.findall("link/inertial/mass")]
    assert len(weights) == 2 and sum(weights) == pytest.approx(3.0)
    assert model.find("joint").get("type") == "fixed" and model.find("static") is None


def test_a_missing_density_is_told_once(tmp_path):
    cell = Cell(CAMERA, objects=(Box("box", at(0, 0, 0), size=[1] * 3, motion=Motion("movable")),))
    told = written(cell, tmp_path, ".sdf")[1]
    assert told == (
        "no mass or density is given of box: taken as 1000 kg/m^3, the density of water",
    )


def test_the_sdf_camera_sees_each_point_at_its_pixel(tmp_path):
    path, _ = written(Cell(CAMERA), tmp_path, ".sdf")
    model = read_sdf(path)[1]["camera"]
    sensor = sdf_pose(model).inverse()
    inside = model.find("link/sensor/camera")
    i = {e.tag: float(e.text) for e in inside.find("lens/intrinsics") if e.tag in "fx fy cx cy"}
    forward, left, up = sensor.apply([0.1, 0.05, 0.02])
    # SDF's camera looks along x, z up; its pixels count from the corner
    u = i["cx"] - i["fx"] * left / forward - 0.5
    v = i["cy"] - i["fy"] * up / forward - 0.5
    np.testing.assert_allclose([u, v], CAMERA.project([[0.1, 0.05, 0.02]])[0], atol=1e-6)
    wide = float(inside.findtext("horizontal_fov"))
    assert wide == pytest.approx(2 * np.arctan(320 / 600))


def test_the_lens_is_kept_in_sdf_where_it_can_be_and_told_where_not(tmp_path):
    for model, coefficients, kept in (
        ("plumb_bob", [-0.28, 0.09, 0.0006, -0.0004, -0.01], True),
        ("equidistant", [0.1, 0.0, 0.0, 0.0], False),
    ):
        lens = replace(CAMERA.intrinsics, distortion=Distortion(model, coefficients))
        cell = Cell(replace(CAMERA, intrinsics=lens))
        path, told = written(cell, tmp_path, ".sdf")
        distortion = read_sdf(path)[1]["camera"].find("link/sensor/camera/distortion")
        if kept:
            assert told == () and float(distortion.findtext("p2")) == -0.0004
        else:
            assert distortion is None and "equidistant is left out" in told[0]
        assert "is left out" in written(cell, tmp_path, ".xml")[1][0]
