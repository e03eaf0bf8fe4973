# SPDX-License-Identifier: GPL-3.0-or-later
"""URDF, SDF, MJCF and MoveIt scenes hold what the cell does: shapes, places, joints, the camera."""

from __future__ import annotations

import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from drawn import poses
from drawn_cells import cells
from format_readers import floats, read_mjcf, read_obj, read_scene, read_sdf, read_urdf
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from monocell.core import (
    Appearance,
    Box,
    Camera,
    Cell,
    Composite,
    Cone,
    Cylinder,
    Distortion,
    Intrinsics,
    Motion,
    Pose,
    Prism,
    Sphere,
    Tube,
)
from monocell.core.errors import DocumentError, InvalidValue
from monocell.core.formats.identifiers import identifiers
from monocell.core.formats.link_tree import links_of
from monocell.core.formats.text_formats import WRITERS, write_text_format
from monocell.core.rotation import roll_pitch_yaw
from monocell.core.shape.mass import volume
from monocell.core.shape.pieces import pieces_of

READERS = {
    ".urdf": lambda path: read_urdf(path)[0],
    ".sdf": lambda path: read_sdf(path)[0],
    ".xml": lambda path: read_mjcf(path)[0],
    ".scene": read_scene,
}
FORMATS = pytest.mark.parametrize("ending", READERS)
CAMERA = Camera(
    Intrinsics(640, 480, 600.0, 605.0, 330.0, 236.0),
    Pose.looking_at([1.0, -1.0, 1.0], [0, 0, 0], [0, 0, 1]),
)
ELL = np.array([[-0.1, -0.1], [0.2, -0.1], [-0.1, 0.2]])
# how much larger than the solid its pieces are
TOO_LARGE = {"cone": 0.002, "tube": 0.01, "prism": 1e-9}


def at(*place, turn=(0.0, 0.0, 0.0)):
    return Pose.from_rotation_vector(turn, place)


CHEST = (
    Box("chest", at(0.5, 0.2, 0.1, turn=(0, 0, 0.3)), size=[0.3, 0.2, 0.2]),
    Box(
        "lid",
        at(0.5, 0.2, 0.21, turn=(0, 0, 0.3)),
        size=[0.3, 0.2, 0.02],
        motion=Motion(
            "attached",
            mass=2.0,
            to="chest",
            joint="hinge",
            axis=[1.0, 0, 0],
            point=[0, -0.1, -0.01],
            limits=(0.0, 1.5),
        ),
    ),
    Sphere(
        "knob",
        at(0.5, 0.3, 0.23),
        radius=0.01,
        motion=Motion("attached", to="lid", joint="fixed", mass=0.1),
    ),
    Cylinder(
        "drawer",
        at(0.4, 0.2, 0.05),
        radius=0.04,
        height=0.1,
        motion=Motion("attached", to="chest", joint="slider", axis=[0, 1.0, 0], density=500.0),
    ),
    Cone("cup", at(0.1, 0.4, 0.1), radius=0.05, height=0.2, motion=Motion("movable", mass=1.5)),
)


def written(cell, folder, ending):
    path = Path(folder) / f"my cell{ending}"
    return path, write_text_format(cell, path)


def assert_same(thing, shapes):
    """The shapes read back are the object."""
    tolerance = 1e-6 * max(1.0, np.abs(thing.world_from_object.translation).max())
    tolerance = max(tolerance, 1e-9 * thing.half_extent.max())
    if shapes[0].kind != "mesh":
        (shape,) = shapes
        wanted = thing.sizes if thing.kind != "cone" else [thing.radius, thing.height]
        assert shape.kind == thing.kind
        np.testing.assert_allclose(shape.sizes, wanted, rtol=1e-11)
        far = np.abs(shape.world_from_shape.matrix() - thing.world_from_object.matrix()).max()
        assert far < tolerance
        return
    wanted = np.concatenate(pieces_of(thing).corners())
    found = np.concatenate([shape.corners_world() for shape in shapes])
    np.testing.assert_allclose(found, thing.world_from_object.apply(wanted), atol=tolerance)
    # and its pieces, which face outwards, fill it and hardly more
    filled = sum(shape.volume() for shape in shapes)
    assert 1 - 1e-9 <= filled / volume(thing) < 1 + TOO_LARGE[thing.kind]


@FORMATS
@settings(max_examples=12, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(cell=cells())
def test_any_cell_survives_in_its_geometry(ending, cell):
    with tempfile.TemporaryDirectory() as folder:
        path, _ = written(cell, folder, ending)
        found = READERS[ending](path)
    own = names_in(cell, ending)
    assert set(own) <= set(found)
    for name, thing in own.items():
        assert_same(thing, found[name])


def names_in(cell, ending):
    if ending == ".scene":
        names = identifiers([thing.name for thing in cell.objects])
        return dict(zip(names, cell.objects, strict=True))
    return {link.name: link.thing for link in links_of(cell)[0]}


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


@FORMATS
def test_names_with_spaces_and_of_other_scripts_are_told_in_full(ending, tmp_path):
    things = tuple(
        Box(name, at(0.1 * i, 0, 0), size=[0.1] * 3)
        for i, name in enumerate(
            ["Kiste 1", "Kiste-1", "箱", "箱子", "crate_joint", "crate", "a--b"]
        )
    )
    path, _ = written(Cell(CAMERA, objects=things), tmp_path, ending)
    found = READERS[ending](path)
    for name, thing in names_in(Cell(CAMERA, objects=things), ending).items():
        assert_same(thing, found[name])
    if ending != ".scene":
        text = path.read_text(encoding="utf-8")
        assert "<!-- 箱, a box" in text and "<!-- a- -b, a box" in text


@FORMATS
def test_an_empty_cell_without_a_camera_pose_is_a_file_all_the_same(ending, tmp_path):
    path, told = written(Cell(Camera(CAMERA.intrinsics)), tmp_path, ending)
    assert not any(READERS[ending](path).values()) and told == ()
    assert [file.name for file in tmp_path.iterdir()] == [path.name]


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
    from format_readers import sdf_pose

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


def test_colours_are_encoded_as_programs_show_them(tmp_path):
    cell = Cell(
        CAMERA,
        objects=(
            Sphere("s", at(0, 0, 0), radius=1, appearance=Appearance(np.array([0.0, 0.2159, 1]))),
        ),
    )
    path, _ = written(cell, tmp_path, ".urdf")
    assert 'rgba="0 0.502 1 1"' in path.read_text()


def test_the_error_of_an_object_stands_above_it(tmp_path):
    sigmas = np.array([1e-3] * 3 + [5e-4, 6e-4, 7e-4] + [8e-4] * 3)
    cell = Cell(CAMERA, objects=(replace(CHEST[0], covariance=np.diag(sigmas**2)),))
    for ending in (".urdf", ".sdf", ".xml"):
        text = written(cell, tmp_path, ending)[0].read_text(encoding="utf-8")
        assert "position ± 0.5 0.6 0.7 mm, rotation ± 0.057 0.057 0.057 degrees" in text
        assert "size_x 300.0 ± 0.8 mm" in text


def test_meshes_lie_beside_the_document_and_the_visual_one_lies_on_the_surface(tmp_path):
    things = (
        Tube("pipe", at(0, 0, 0), radius=0.1, inner_radius=0.05, height=0.2),
        Prism("flap", at(1, 0, 0), polygon=ELL, height=0.02),
    )
    written(Cell(CAMERA, objects=things), tmp_path, ".urdf")
    files = {file.name for file in (tmp_path / "my_cell_meshes").iterdir()}
    assert files == {
        "pipe_visual.obj",
        "pipe_piece0.obj",
        "flap_visual.obj",
        "flap_piece0.obj",
    }
    vertices, _ = read_obj(tmp_path / "my_cell_meshes" / "pipe_visual.obj")
    away = np.linalg.norm(vertices[:, :2], axis=1)
    assert set(away.round(9)) == {0.05, 0.1}


def test_masses_that_are_given_twice_leave_what_was_there(tmp_path):
    group = Composite("both", ("chest", "lid"), Motion("movable", mass=3.0))
    cell = Cell(CAMERA, objects=CHEST[:3], composites=(group,))
    path = tmp_path / "my cell.urdf"
    path.write_text("old")
    with pytest.raises(InvalidValue, match="lid has a mass of its own"):
        write_text_format(cell, path)
    with pytest.raises(DocumentError, match=r"the folder .* is not there; make it first"):
        write_text_format(Cell(CAMERA), tmp_path / "no" / "cell.urdf")
    assert [file.name for file in tmp_path.iterdir()] == ["my cell.urdf"]
    assert path.read_text() == "old"


def test_every_ending_has_a_reader_here():
    assert set(WRITERS) - set(READERS) == {".world", ".mjcf"}
