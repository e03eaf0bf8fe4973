# SPDX-License-Identifier: GPL-3.0-or-later
"""Camera files of ROS, OpenCV and our own give the same camera; broken ones say why not."""

from __future__ import annotations

import json

import cv2
import numpy as np
import pytest
from drawn_cells import whole_document
from monocell.core.document.camera_file import read_camera
from monocell.core.errors import DocumentError

K = [1200.0, 0, 652.3, 0, 1195.0, 471.8, 0, 0, 1]
BROWN = [-0.28, 0.09, 0.0006, -0.0004, -0.01]
MODELS = {
    "plumb_bob": BROWN,
    "rational_polynomial": [0.3, -0.2, 5e-4, -3e-4, 0.02, 0.5, -0.1, 0.01],
    "equidistant": [-0.02, 0.004, -0.001, 0.0002],
}


def ros(model="plumb_bob", coefficients=BROWN, k=K, **changed):
    fields = {
        "image_width": 1280,
        "image_height": 960,
        "camera_name": "left",
        "camera_matrix": f"\n  rows: 3\n  cols: 3\n  data: {k}",
        "distortion_model": model,
        "distortion_coefficients": (
            f"\n  rows: 1\n  cols: {len(coefficients)}\n  data: {list(coefficients)}"
        ),
        "rectification_matrix": "\n  rows: 3\n  cols: 3\n  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]",
        "projection_matrix": "\n  rows: 3\n  cols: 4\n  data: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]",
    } | changed
    return "".join(f"{key}: {value}\n" for key, value in fields.items() if value is not None)


def opencv(path, model="plumb_bob", values=BROWN, **names):
    storage = cv2.FileStorage(str(path), cv2.FILE_STORAGE_WRITE)
    storage.write("image_width", 1280)
    storage.write("image_height", 960)
    storage.write(names.get("matrix", "camera_matrix"), np.array(K).reshape(3, 3))
    if values is not None:
        storage.write(names.get("coefficients", "distortion_coefficients"), np.array(values))
    if model is not None:
        storage.write("distortion_model", model)
    storage.release()
    return path


def is_the_camera(camera, model, coefficients):
    lens = camera.intrinsics
    assert (lens.width, lens.height) == (1280, 960)
    np.testing.assert_array_equal(lens.matrix().ravel(), K)
    assert lens.distortion.model == model
    np.testing.assert_array_equal(lens.distortion.coefficients, coefficients)
    assert camera.camera_from_world is None


@pytest.mark.parametrize("model", MODELS)
def test_ros_camera_info_is_read(tmp_path, model):
    path = tmp_path / "left.yaml"
    path.write_text(ros(model, MODELS[model]))
    is_the_camera(read_camera(path), model, MODELS[model])


@pytest.mark.parametrize("ending", ["yml", "xml", "json", "yaml"])
@pytest.mark.parametrize("model", MODELS)
def test_opencv_file_storage_is_read_in_all_its_forms(tmp_path, ending, model):
    path = opencv(tmp_path / f"left.{ending}", model, MODELS[model])
    is_the_camera(read_camera(path), model, MODELS[model])


def test_opencv_without_a_model_means_what_its_number_of_coefficients_says(tmp_path):
    brown = opencv(
        tmp_path / "a.yml", None, BROWN, matrix="cameraMatrix", coefficients="distCoeffs"
    )
    is_the_camera(read_camera(brown), "plumb_bob", BROWN)
    eight = MODELS["rational_polynomial"]
    rational = opencv(tmp_path / "b.yml", None, eight, matrix="K", coefficients="D")
    is_the_camera(read_camera(rational), "rational_polynomial", eight)
    is_the_camera(read_camera(opencv(tmp_path / "c.yml", None, None)), "none", [])
    fourteen = opencv(tmp_path / "d.yml", None, [*eight, *[0.0] * 6])
    is_the_camera(read_camera(fourteen), "rational_polynomial", eight)
    four = opencv(tmp_path / "e.yml", None, BROWN[:4])
    is_the_camera(read_camera(four), "plumb_bob", [*BROWN[:4], 0.0])


def test_no_distortion_is_a_perfect_lens(tmp_path):
    path = tmp_path / "left.yaml"
    path.write_text(ros(coefficients=[0.0] * 5))
    is_the_camera(read_camera(path), "none", [])
    path.write_text(ros(distortion_coefficients=None, distortion_model=None))
    is_the_camera(read_camera(path), "none", [])


def test_a_fisheye_without_coefficients_stays_a_fisheye(tmp_path):
    path = tmp_path / "left.yaml"
    path.write_text(ros("fisheye", [0.0] * 4))
    is_the_camera(read_camera(path), "equidistant", [0.0] * 4)


def test_our_own_json_is_a_camera_or_a_whole_cell(tmp_path):
    document = whole_document()
    for name, value in (("camera.json", document["camera"]), ("a.cell.json", document)):
        (tmp_path / name).write_text(json.dumps(value))
        camera = read_camera(tmp_path / name)
        assert camera.intrinsics.fy == 1195.0
        assert camera.camera_from_world is not None


@pytest.mark.parametrize(
    ("content", "told"),
    [
        ("", "is none of monocell JSON, ROS"),
        ("just words", "is none of monocell JSON, ROS"),
        ("- a\n- list", "is none of"),
        ("a: [1, 2", "is none of"),
        ("\x00\x01\x02", "is none of"),
        (ros(image_width=None), "image_width: is missing"),
        (ros(image_width="wide"), "image_width: expected a number, got 'wide'"),
        (ros(image_height=0), "height: expected a whole number of pixels, got 0"),
        (ros(image_height="1e400"), "image_height"),
        (ros(k=K[:8]), r"camera_matrix\.data: expected 9 numbers, got 8"),
        (ros(k=[*K[:8], "'x'"]).replace('"', ""), r"camera_matrix\.data\[8\]: expected a number"),
        (ros(k=[0.0, *K[1:]]), "fx: must be above zero"),
        (ros(k=[1200.0, 5.0, *K[2:]]), "a skew of 5 px is not supported"),
        (ros(camera_matrix="[1, 2]"), "camera_matrix: expected an object"),
        (ros(camera_matrix="{rows: 3, cols: 3}"), r"camera_matrix\.data: is missing"),
        (ros(camera_matrix="{rows: 3, cols: 3, data: 7}"), "camera_matrix.*expected a list"),
        (ros("kannala"), "distortion_model: 'kannala' is none of plumb_bob"),
        (ros(distortion_model="[1]"), "distortion_model: expected a text"),
        (ros(coefficients=[*BROWN, 0.1]), "6 numbers, but plumb_bob has 5; thin-prism"),
        (ros(colour="blue"), "colour: unknown key"),
        (ros() + ros(), "is none of .*duplicate|is none of"),
        ("%YAML:1.0\n---\nimage_width: 3\n", "needs image_width, image_height and camera_matrix"),
        ("%YAML:1.0\n---\nimage_width: [\n", "can't read it"),
        ("%YAML:1.0\n---\nimage_width: 3\nimage_height: 4\ncamera_matrix: 5\n", "camera_matrix"),
        (
            "%YAML:1.0\n---\nimage_width: .Nan\nimage_height: 4\nK: !!opencv-matrix\n  rows: 3\n"
            "  cols: 3\n  dt: d\n  data: [ 1., 0., 0., 0., 1., 0., 0., 0., 1. ]\n",
            "width",
        ),
        ("<?xml version='1.0'?><opencv_storage><a></opencv_storage>", "can't read it"),
        ("<?xml version='1.0'?><svg></svg>", "can't read it|needs image_width"),
    ],
)
def test_a_broken_camera_file_says_why(tmp_path, capfd, content, told):
    path = tmp_path / "left.yaml"
    path.write_text(content)
    with pytest.raises(DocumentError, match=told) as refusal:
        read_camera(path)
    assert str(refusal.value).startswith(f"{path}: ")
    assert "\n" not in str(refusal.value)
    # the one line is ours to print: nobody else may write beside it
    assert capfd.readouterr().err == ""


def test_a_missing_camera_file_and_a_folder_are_named(tmp_path):
    for name in ("none.yaml", "none.json"):
        with pytest.raises(DocumentError, match=rf"{name}: there is no such"):
            read_camera(tmp_path / name)
    with pytest.raises(DocumentError, match="can't be read"):
        read_camera(tmp_path)


def test_a_binary_file_is_no_camera_file(tmp_path):
    path = tmp_path / "left.yaml"
    path.write_bytes(bytes(range(256)) * 9)
    with pytest.raises(DocumentError, match="is none of"):
        read_camera(path)
