# SPDX-License-Identifier: GPL-3.0-or-later
from types import SimpleNamespace

import bench_cell
import cv2
import numpy as np
import pytest
from monocell.core.document.cell_file import read_cell
from monocell.core.picture.synthetic import photograph

pytestmark = pytest.mark.blender


def intrinsics_of(bpy, tmp_path):
    bpy.ops.monocell.save_cell(filepath=str(tmp_path / "x.cell.json"))
    return read_cell(tmp_path / "x.cell.json").camera.intrinsics


def marks(module, scene):
    steps = module("addon.panels.steps")
    of = (steps.picture_step, steps.camera_step, steps.model_step, steps.use_step)
    return [step(scene).mark for step in of]


def test_the_sample_opens_with_one_press_and_says_what_comes_next(addon, module):
    scene = addon.context.scene
    assert marks(module, scene) == ["next", "waiting", "waiting", "waiting"]
    assert addon.ops.monocell.open_sample() == {"FINISHED"}
    scene = addon.context.scene
    assert len(scene.monocell_cell.sightings) == 8
    assert marks(module, scene) == ["done", "next", "waiting", "waiting"]
    assert (
        module("addon.panels.steps").camera_step(scene).said == "8 sightings are ready: calibrate."
    )
    # it is never written back into the extension
    assert scene.monocell_cell.path == ""


def test_the_sample_to_model_yourself_is_the_first_and_brings_no_picks(addon, module):
    addon.ops.monocell.open_sample()
    stored = addon.context.scene.monocell_cell
    assert '"objects": []' in stored.text
    addon.ops.monocell.open_sample(sample="TABLE")
    sketches = module("addon.cell.document").bare_cell(addon.context.scene).sketches
    assert len(sketches) == 7


def test_each_sample_says_what_is_in_it_before_it_is_opened(addon, module):
    opened = module("addon.operators.open_sample").OpenSample
    told = {
        name: opened.description(addon.context, SimpleNamespace(sample=name))
        for name in ("STACK", "TABLE")
    }
    assert "model yourself" in told["STACK"]
    assert "Solve All" in told["TABLE"]
    assert all("40 mm ball" in words for words in told.values())


def test_the_steps_follow_the_work(addon, module, bench):
    import json

    addon.ops.monocell.open_cell(filepath=str(bench))
    scene = addon.context.scene
    assert marks(module, scene) == ["done", "done", "next", "waiting"]
    picks = json.dumps(bench_cell.box_picks())
    addon.ops.monocell.add_box("EXEC_DEFAULT", True, picks=picks)
    assert marks(module, scene) == ["done", "done", "done", "next"]
    assert module("addon.panels.steps").use_step(scene).said == "1 object to export."


def test_a_typed_camera_has_the_picture_s_size(addon, bench, tmp_path):
    inputs = addon.context.scene.monocell_inputs
    inputs.camera_source, inputs.lens_model = "PIXELS", "plumb_bob"
    inputs.focal_x, inputs.focal_y = 760.0, 757.0
    inputs.centred, inputs.centre_x, inputs.centre_y = False, 411.3, 292.8
    inputs.coefficients = "-0.22, 0.07 0.0006 -0.0004 -0.01"
    addon.ops.monocell.open_picture(picture=str(bench.parent / "bench.png"))
    found, truth = intrinsics_of(addon, tmp_path), bench_cell.INTRINSICS
    assert (found.width, found.height) == (truth.width, truth.height)
    assert np.allclose(found.matrix(), truth.matrix(), atol=1e-4)
    assert found.distortion.coefficients.tolist() == truth.distortion.coefficients.tolist()


def test_a_field_of_view_becomes_a_focal_length(addon, bench, tmp_path):
    inputs = addon.context.scene.monocell_inputs
    inputs.camera_source, inputs.field_degrees = "ANGLE", 90.0
    addon.ops.monocell.open_picture(picture=str(bench.parent / "bench.png"))
    found = intrinsics_of(addon, tmp_path)
    # 90 degrees over 800 pixels; the middle of them is 399.5
    assert (found.fx, found.fy) == pytest.approx((400, 400))
    assert (found.cx, found.cy) == (399.5, 299.5)


@pytest.mark.parametrize(
    ("settings", "told"),
    [
        ({"camera_source": "FILE"}, "no camera file chosen"),
        ({"camera_source": "PIXELS", "coefficients": "0.1 x"}, "'x' is no number"),
        (
            {"camera_source": "PIXELS", "lens_model": "plumb_bob", "coefficients": "0.1"},
            "coefficients",
        ),
    ],
)
def test_a_camera_that_is_not_stated_is_refused(addon, bench, settings, told):
    for name, value in settings.items():
        setattr(addon.context.scene.monocell_inputs, name, value)
    with pytest.raises(RuntimeError, match=told):
        addon.ops.monocell.open_picture(picture=str(bench.parent / "bench.png"))


def test_files_that_are_dropped_find_their_operator(addon, tmp_path):
    import bpy

    handlers = [
        cls
        for cls in bpy.types.FileHandler.__subclasses__()
        if "MONOCELL" in cls.__name__ or cls.bl_idname.startswith("MONOCELL")
    ]
    found = {cls.bl_file_extensions: cls.bl_import_operator for cls in handlers}
    assert found[".json"] == "monocell.open_cell"
    pictures = {cls.bl_idname: cls.bl_import_operator for cls in handlers}["MONOCELL_FH_picture"]
    path = tmp_path / "dropped.png"
    cv2.imwrite(str(path), photograph(bench_cell.INTRINSICS, ()))
    inputs = addon.context.scene.monocell_inputs
    inputs.camera_source = "ANGLE"
    group, name = pictures.split(".")
    getattr(getattr(addon.ops, group), name)(filepath=str(path))
    assert addon.context.scene.monocell_cell.shown_picture == "dropped.png"


def test_pictures_that_were_moved_are_found_again(addon, module, tmp_path):
    here, there = tmp_path / "here", tmp_path / "there"
    here.mkdir()
    path = bench_cell.write_bench(here)
    addon.ops.monocell.open_cell(filepath=str(path))
    scene = addon.context.scene
    with pytest.raises(RuntimeError, match="no picture of this cell is missing"):
        addon.ops.monocell.find_pictures(directory=str(tmp_path))
    here.rename(there)
    assert module("addon.panels.steps").picture_step(scene).mark == "doubt"
    with pytest.raises(RuntimeError, match="there is no such picture either"):
        addon.ops.monocell.find_pictures(directory=str(tmp_path))
    assert addon.ops.monocell.find_pictures(directory=str(there)) == {"FINISHED"}
    assert module("addon.panels.steps").picture_step(scene).mark == "done"
    assert addon.ops.monocell.calibrate() == {"FINISHED"}
