# SPDX-License-Identifier: GPL-3.0-or-later
"""Kalibr, COLMAP, fSpy, ViSP and nerfstudio files give the camera they mean; writing reads back."""

from __future__ import annotations

import json
import math

import cv2
import numpy as np
import pytest
from drawn import lenses
from hypothesis import given, settings
from hypothesis import strategies as st
from monocell.core import Camera, Distortion, Intrinsics, Pose
from monocell.core.document.camera_file import read_camera, write_camera
from monocell.core.document.entries import camera_entry
from monocell.core.errors import DocumentError, InvalidValue

KALIBR = """cam0:
  cam_overlaps: []
  camera_model: pinhole
  distortion_coeffs: [-0.28, 0.09, 0.0006, -0.0004]
  distortion_model: radtan
  intrinsics: [1200.0, 1195.0, 652.3, 471.8]
  resolution: [1280, 960]
  rostopic: /cam0/image_raw
"""
VISP = """<?xml version="1.0"?>
<root>
  <!--vpCameraParameters-->
  <camera>
    <name>Camera</name>
    <image_width>1280</image_width>
    <image_height>960</image_height>
    <model>
      <type>perspectiveProjWithoutDistortion</type>
      <px>1190.0</px><py>1190.0</py><u0>650.0</u0><v0>470.0</v0>
    </model>
    <model>
      <type>perspectiveProjWithDistortion</type>
      <px>1200.0</px><py>1195.0</py><u0>652.3</u0><v0>471.8</v0>
      <kud>-0.25</kud><kdu>0.26</kdu>
    </model>
  </camera>
</root>
"""
FSPY = {
    "principalPoint": {"x": 0.02, "y": 0.03},
    "viewTransform": {"rows": []},
    "cameraTransform": {"rows": []},
    "horizontalFieldOfView": 2 * math.atan(1 / 1.875),
    "verticalFieldOfView": 0.77,
    "vanishingPoints": [],
    "vanishingPointAxes": [],
    "relativeFocalLength": 1.875,
    "imageWidth": 1280,
    "imageHeight": 960,
}
NERF = {
    "camera_model": "OPENCV",
    "fl_x": 1200.0,
    "fl_y": 1195.0,
    "cx": 652.8,
    "cy": 472.3,
    "w": 1280,
    "h": 960,
    "k1": -0.28,
    "k2": 0.09,
    "p1": 0.0006,
    "p2": -0.0004,
    "frames": [{"file_path": "a.png", "transform_matrix": []}],
}
COLMAP = {
    "SIMPLE_PINHOLE": ("1200 652.8 472.3", "none", []),
    "PINHOLE": ("1200 1195 652.8 472.3", "none", []),
    "SIMPLE_RADIAL": ("1200 652.8 472.3 -0.2", "plumb_bob", [-0.2, 0, 0, 0, 0]),
    "RADIAL": ("1200 652.8 472.3 -0.2 0.1", "plumb_bob", [-0.2, 0.1, 0, 0, 0]),
    "OPENCV": (
        "1200 1195 652.8 472.3 -0.2 0.1 0.001 0.002",
        "plumb_bob",
        [-0.2, 0.1, 0.001, 0.002, 0],
    ),
    "OPENCV_FISHEYE": (
        "1200 1195 652.8 472.3 0.1 0.2 0.3 0.4",
        "equidistant",
        [0.1, 0.2, 0.3, 0.4],
    ),
    "FULL_OPENCV": (
        "1200 1195 652.8 472.3 0.1 0.2 0.001 0.002 0.3 0.4 0.5 0.6",
        "rational_polynomial",
        [0.1, 0.2, 0.001, 0.002, 0.3, 0.4, 0.5, 0.6],
    ),
    "SIMPLE_RADIAL_FISHEYE": ("1200 652.8 472.3 0.1", "equidistant", [0.1, 0, 0, 0]),
    "RADIAL_FISHEYE": ("1200 652.8 472.3 0.1 0.2", "equidistant", [0.1, 0.2, 0, 0]),
}


def read(tmp_path, name, content):
    path = tmp_path / name
    path.write_text(content if isinstance(content, str) else json.dumps(content))
    return read_camera(path)


def is_lens(camera, model, coefficients, fx=1200.0, fy=1195.0, cx=652.3, cy=471.8):
    lens = camera.intrinsics
    assert (lens.width, lens.height) == (1280, 960)
    np.testing.assert_allclose([lens.fx, lens.fy, lens.cx, lens.cy], [fx, fy, cx, cy], rtol=1e-12)
    assert lens.distortion.model == model
    np.testing.assert_array_equal(lens.distortion.coefficients, coefficients)
    assert camera.camera_from_world is None


def test_a_kalibr_chain_of_one_camera_is_read(tmp_path):
    brown = [-0.28, 0.09, 0.0006, -0.0004, 0.0]
    is_lens(read(tmp_path, "camchain.yaml", KALIBR), "plumb_bob", brown)
    fisheye = KALIBR.replace("radtan", "equidistant")
    is_lens(read(tmp_path, "camchain.yaml", fisheye), "equidistant", brown[:4])


@pytest.mark.parametrize("model", COLMAP)
def test_every_colmap_model_is_read_from_its_corner_to_our_centre(tmp_path, model):
    parameters, ours, coefficients = COLMAP[model]
    text = f"# Camera list\n#   CAMERA_ID, MODEL, ...\n1 {model} 1280 960 {parameters}\n"
    fy = 1195.0 if len(parameters.split()) > 3 and parameters.split()[1] == "1195" else 1200.0
    is_lens(read(tmp_path, "cameras.txt", text), ours, coefficients, fy=fy)


def test_colmap_s_middle_of_a_picture_is_ours(tmp_path):
    # a camera that looks straight ahead has its principal point in the middle of the picture:
    # at 2, 1.5 from the corner of 4 x 3 pixels, at 1.5, 1 from the centre of the first
    lens = read(tmp_path, "cameras.txt", "1 PINHOLE 4 3 5 5 2 1.5\n").intrinsics
    assert (lens.cx, lens.cy) == ((lens.width - 1) / 2, (lens.height - 1) / 2)


def test_fspy_s_middle_of_a_picture_is_ours_and_its_y_points_up(tmp_path):
    middle = FSPY | {"principalPoint": {"x": 0.0, "y": 0.0}}
    lens = read(tmp_path, "a.json", middle).intrinsics
    assert (lens.cx, lens.cy) == (639.5, 479.5)
    is_lens(read(tmp_path, "a.json", FSPY), "none", [], 1200, 1200, 652.3, 460.3)


def test_fspy_measures_along_the_longer_side_of_an_upright_picture(tmp_path):
    upright = FSPY | {"imageWidth": 960, "imageHeight": 1280}
    lens = read(tmp_path, "a.json", upright).intrinsics
    np.testing.assert_allclose([lens.fx, lens.cx, lens.cy], [1200, 492.3, 620.3])
    without = {k: v for k, v in upright.items() if k != "relativeFocalLength"}
    np.testing.assert_allclose(read(tmp_path, "a.json", without).intrinsics.fx, 1200)


def test_visp_s_distorted_model_wins_over_its_plain_one(tmp_path):
    is_lens(read(tmp_path, "camera.xml", VISP), "plumb_bob", [-0.25, 0, 0, 0, 0])
    plain = VISP[: VISP.index("    <model>\n      <type>perspectiveProjWithD")] + "</camera></root>"
    is_lens(read(tmp_path, "camera.xml", plain), "none", [], 1190, 1190, 650, 470)


def test_a_nerfstudio_file_is_read_from_its_corner_to_our_centre(tmp_path):
    brown = [-0.28, 0.09, 0.0006, -0.0004, 0.0]
    is_lens(read(tmp_path, "transforms.json", NERF), "plumb_bob", brown)
    fisheye = NERF | {"camera_model": "OPENCV_FISHEYE", "p1": 0, "p2": 0, "k3": 0.01, "k4": 0}
    is_lens(read(tmp_path, "transforms.json", fisheye), "equidistant", [-0.28, 0.09, 0.01, 0.0])


def test_a_nerfstudio_file_may_state_angles_alone(tmp_path):
    angle = 2 * math.atan(1280 / 2 / 1200)
    lens = read(tmp_path, "t.json", {"camera_angle_x": angle, "w": 1280, "h": 960}).intrinsics
    np.testing.assert_allclose([lens.fx, lens.fy, lens.cx, lens.cy], [1200, 1200, 639.5, 479.5])


@pytest.mark.parametrize(
    ("name", "content", "told"),
    [
        ("a.yaml", KALIBR + KALIBR.replace("cam0", "cam1"), "holds cam0, cam1; keep the one"),
        ("a.yaml", KALIBR.replace("pinhole", "omni"), "cam0.camera_model: 'omni' is not supp"),
        ("a.yaml", KALIBR.replace("radtan", "fov"), "'fov' is none of radtan"),
        ("a.yaml", KALIBR.replace(", -0.0004]", "]"), "coeffs: expected 4 numbers, got 3"),
        ("a.yaml", KALIBR + "  colour: blue\n", "cam0.colour: unknown key"),
        ("a.yaml", KALIBR.replace("1200.0", "-3"), "fx: must be above zero"),
        ("a.txt", "1 PINHOLE 4 3 5 5 2 1.5\n2 PINHOLE 4 3 5 5 2 1.5", "holds 2 cameras"),
        ("a.txt", "1 THIN_PRISM_FISHEYE 4 3 5 5 2 1.5", "THIN_PRISM_FISHEYE: this camera model"),
        ("a.txt", "1 PINHOLE 4 3 5 5 2", "PINHOLE: expected 4 parameters, got 3"),
        ("a.txt", "1 PINHOLE 4 3 5 5 2 x", "PINHOLE: its parameters are not all numbers"),
        ("a.txt", "1 PINHOLE 4 3 5 5 2 nan", "cy: must be finite"),
        ("a.json", FSPY | {"colour": 1}, "colour: unknown key"),
        ("a.json", FSPY | {"principalPoint": [1, 2]}, "principalPoint: expected an object"),
        ("a.json", FSPY | {"imageWidth": 3.5}, "imageWidth: expected a whole number"),
        ("a.json", FSPY | {"relativeFocalLength": 0}, "fx: must be above zero"),
        ("a.xml", VISP.replace("<px>1200.0</px>", ""), "px: is missing"),
        ("a.xml", VISP.replace("1280", "wide"), "image_width: expected a number, got 'wide'"),
        ("a.xml", VISP.replace("<kud>-0.25</kud>", "<kud>nan</kud>"), "kud: expected a finite"),
        ("a.xml", VISP.replace("</root>", ""), "is not XML"),
        ("a.xml", VISP.replace("<root>", "<!DOCTYPE x><root>"), "needs no DOCTYPE"),
        ("a.xml", VISP.replace("perspectiveProjWith", "Other"), "is not supported, only"),
        ("a.json", NERF | {"camera_model": "EQUIRECTANGULAR"}, "'EQUIRECTANGULAR' is none of"),
        ("a.json", NERF | {"k4": 0.1}, "k4: 0.1 has no place in OPENCV"),
        ("a.json", NERF | {"w": "wide"}, "w: expected a number, got 'wide'"),
        ("a.json", NERF | {"frames": [{"fl_x": 3}]}, "every frame has a camera of its own"),
        ("a.json", {"frames": [], "w": 3, "h": 4}, "fl_x: is missing"),
        ("a.json", {"frames": [], "w": 3}, "h: is missing"),
    ],
)
def test_a_broken_file_of_another_format_says_why(tmp_path, capfd, name, content, told):
    with pytest.raises(DocumentError) as refusal:
        read(tmp_path, name, content)
    assert told in str(refusal.value)
    assert str(refusal.value).startswith(f"{tmp_path / name}: ")
    assert "\n" not in str(refusal.value)
    assert capfd.readouterr().err == ""


@pytest.mark.parametrize("ending", ["json", "yaml", "yml"])
@settings(max_examples=25, deadline=None)
@given(lens=lenses())
def test_a_written_camera_reads_back_in_every_digit(tmp_path_factory, ending, lens):
    path = tmp_path_factory.mktemp("cameras") / f"camera.{ending}"
    write_camera(Camera(lens), path)
    back = read_camera(path).intrinsics
    assert (back.width, back.height) == (lens.width, lens.height)
    np.testing.assert_array_equal(back.matrix(), lens.matrix())
    if back.distortion.model == lens.distortion.model:
        np.testing.assert_array_equal(back.distortion.coefficients, lens.distortion.coefficients)
    else:
        # a polynomial whose coefficients are all zero is a perfect lens, and is read as one
        assert back.distortion.model == "none"
        assert not lens.distortion.coefficients.any()


def test_opencv_itself_reads_what_is_written_for_it(tmp_path):
    lens = Intrinsics(
        64, 48, 1 / 3, 2e-5 + 50, 3.1, 4.7, Distortion("plumb_bob", [0.1, 0, 0, 0, 1])
    )
    write_camera(Camera(lens), tmp_path / "a.yml")
    storage = cv2.FileStorage(str(tmp_path / "a.yml"), cv2.FILE_STORAGE_READ)
    np.testing.assert_array_equal(storage.getNode("camera_matrix").mat(), lens.matrix())


def test_a_pose_survives_in_our_json_and_is_refused_elsewhere(tmp_path):
    lens = Intrinsics(64, 48, 50, 50, 31.5, 23.5)
    camera = Camera(lens, Pose.from_rotation_vector([0.1, 0.2, 0.3], [1, 2, 3]), np.eye(6) * 1e-6)
    write_camera(camera, tmp_path / "a.json")
    back = read_camera(tmp_path / "a.json")
    np.testing.assert_array_equal(back.pose.matrix(), camera.pose.matrix())
    np.testing.assert_array_equal(back.covariance, camera.covariance)
    for name in ("a.yaml", "a.yml"):
        with pytest.raises(DocumentError, match=r"can't hold the pose; write \.json"):
            write_camera(camera, tmp_path / name)
        assert not (tmp_path / name).exists()


@pytest.mark.parametrize(
    ("name", "form", "told"),
    [
        ("a.txt", None, "ends in .json"),
        ("a", None, "ends in .json"),
        ("a.json", "ros", "can't end like this"),
        ("a.yaml", "json", "can't end like this"),
        ("a.yaml", "colmap", "is no form of a camera file"),
        ("no/a.yaml", None, "the folder"),
    ],
)
def test_a_camera_is_not_written_where_it_would_not_read_back(tmp_path, name, form, told):
    camera = Camera(Intrinsics(64, 48, 50, 50, 31.5, 23.5))
    with pytest.raises(DocumentError, match=told):
        write_camera(camera, tmp_path / name, form)


@settings(max_examples=60, deadline=None)
@given(text=st.text(max_size=200))
def test_any_text_is_a_camera_or_one_line_of_refusal(tmp_path_factory, text):
    path = tmp_path_factory.mktemp("cameras") / "a.txt"
    path.write_text(text, encoding="utf-8", errors="replace")
    try:
        read_camera(path)
    except (DocumentError, InvalidValue) as refusal:
        assert "\n" not in str(refusal)


def test_a_lens_report_is_a_camera_file_unless_it_failed(tmp_path):
    path = tmp_path / "lens.json"
    camera = Camera(Intrinsics(1280, 960, 1200.0, 1195.0, 652.3, 471.8))
    report = {"verdict": "good", "board": "chessboard 9x6", "camera": camera_entry(camera)}
    path.write_text(json.dumps(report))
    is_lens(read_camera(path), "none", [])
    path.write_text(json.dumps(report | {"verdict": "failed"}))
    with pytest.raises(DocumentError, match="this calibration of the lens failed"):
        read_camera(path)
