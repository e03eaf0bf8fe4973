# SPDX-License-Identifier: GPL-3.0-or-later
"""Another camera for a cell that is open."""

import json
from dataclasses import replace

import bench_cell
import cv2
import numpy as np
import pytest
from monocell.core import Camera, Distortion, Intrinsics
from monocell.core.document.camera_file import write_camera
from monocell.core.document.cell_file import read_cell

pytestmark = pytest.mark.blender

OTHER = replace(bench_cell.INTRINSICS, fx=700.0, fy=698.0, distortion=Distortion("none", []))


@pytest.fixture
def scene(addon, bench):
    addon.ops.monocell.open_cell(filepath=str(bench))
    return addon.context.scene


def state(camera, path, scene):
    write_camera(camera, path)
    scene.monocell_inputs.camera_source, scene.monocell_inputs.camera = "FILE", str(path)


def saved(bpy, tmp_path):
    bpy.ops.monocell.save_cell(filepath=str(tmp_path / "x.cell.json"))
    return read_cell(tmp_path / "x.cell.json")


def plate(scene):
    image = scene.monocell_cell.camera.data.background_images[0].image
    pixels = np.empty(image.size[0] * image.size[1] * 4, np.float32)
    image.pixels.foreach_get(pixels)
    return pixels.reshape(image.size[1], image.size[0], 4)[:, :, :3]


def test_the_camera_of_a_file_replaces_lens_and_pose(addon, scene, bench, tmp_path):
    picture = cv2.imread(str(bench.parent / "bench.png"))[::-1, :, ::-1] / 255
    assert np.abs(plate(scene) - picture).max() > 0.02
    state(Camera(OTHER), tmp_path / "camera.yaml", scene)
    assert addon.ops.monocell.change_camera() == {"FINISHED"}
    camera = saved(addon, tmp_path).camera
    assert camera.intrinsics.matrix().tolist() == OTHER.matrix().tolist()
    assert camera.intrinsics.distortion.model == "none"
    # a pose found through another lens would be told with confidence
    assert camera.camera_from_world is None
    assert camera.covariance is None
    # a lens without distortion shows the picture as it is
    assert np.allclose(plate(scene), picture, atol=1e-3)
    # Blender's camera has the new lens
    assert scene.camera.data.lens == pytest.approx(OTHER.fx * 36 / OTHER.width, rel=1e-5)


def test_numbers_that_are_typed_are_for_the_size_of_the_cell(addon, scene, tmp_path):
    inputs = scene.monocell_inputs
    inputs.camera_source, inputs.field_degrees = "ANGLE", 90.0
    addon.ops.monocell.change_camera()
    found = saved(addon, tmp_path).camera.intrinsics
    assert (found.width, found.fx, found.cx) == pytest.approx((800, 400, 399.5))


def test_a_calibration_goes_and_says_so_and_the_next_marks_the_objects(addon, module, scene):
    steps = module("addon.panels.steps")
    addon.ops.monocell.calibrate()
    picks = json.dumps(bench_cell.box_picks())
    addon.ops.monocell.add_box("EXEC_DEFAULT", True, picks=picks)
    assert steps.model_step(scene).mark == "done"
    inputs = scene.monocell_inputs
    inputs.camera_source, inputs.focal_x, inputs.focal_y = "PIXELS", 760.0, 757.0
    inputs.centred, inputs.centre_x, inputs.centre_y = False, 411.3, 292.8
    inputs.lens_model, inputs.coefficients = "plumb_bob", "-0.2 0.07 0.0006 -0.0004 -0.01"
    addon.ops.monocell.change_camera()
    assert scene.monocell_cell.report == ""
    assert steps.camera_step(scene).mark == "next"
    assert steps.camera_step(scene).said.endswith("calibrate.")
    assert addon.ops.monocell.calibrate() == {"FINISHED"}
    assert steps.model_step(scene).mark == "doubt"
    assert "press Solve All" in steps.model_step(scene).said
    size = list(addon.data.objects["box"].dimensions)
    assert addon.ops.monocell.solve_again() == {"FINISHED"}
    assert steps.model_step(scene).mark == "done"
    assert list(addon.data.objects["box"].dimensions) != size


def test_a_camera_that_brings_its_pose_keeps_it(addon, scene, tmp_path):
    state(Camera(OTHER, bench_cell.POSE), tmp_path / "camera.json", scene)
    addon.ops.monocell.change_camera()
    camera = saved(addon, tmp_path).camera
    assert np.allclose(camera.camera_from_world.translation, bench_cell.POSE.translation)
    assert camera.covariance is None


def test_the_same_camera_changes_nothing(addon, scene, tmp_path):
    before = scene.monocell_cell.text
    state(Camera(bench_cell.INTRINSICS), tmp_path / "camera.json", scene)
    assert addon.ops.monocell.change_camera() == {"CANCELLED"}
    assert scene.monocell_cell.text == before


def test_a_camera_of_another_size_is_refused_and_changes_nothing(addon, scene, tmp_path):
    before = scene.monocell_cell.text
    state(Camera(Intrinsics(1600, 1200, 1500, 1500, 800, 600)), tmp_path / "camera.yaml", scene)
    with pytest.raises(RuntimeError, match=r"one of 1600 x 1200 px, .* have 800 x 600: give that"):
        addon.ops.monocell.change_camera()
    assert scene.monocell_cell.text == before


def test_a_change_is_one_undo_step(addon, scene, tmp_path):
    addon.ops.ed.undo_push(message="opened")
    before = scene.monocell_cell.text
    name = scene.name
    inputs = scene.monocell_inputs
    inputs.camera_source, inputs.field_degrees = "ANGLE", 90.0
    addon.ops.monocell.change_camera("EXEC_DEFAULT", True)
    after = addon.data.scenes[name].monocell_cell.text
    assert after != before
    addon.ops.ed.undo()
    assert addon.data.scenes[name].monocell_cell.text == before
    addon.ops.ed.redo()
    assert addon.data.scenes[name].monocell_cell.text == after
