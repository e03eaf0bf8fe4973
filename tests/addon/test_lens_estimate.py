# SPDX-License-Identifier: GPL-3.0-or-later
"""The camera from pictures of a board, as the sidebar estimates it."""

import json
import shutil
from pathlib import Path

import cv2
import numpy as np
import pytest
from monocell.core.document.camera_file import read_camera
from monocell.core.document.cell_file import read_cell
from monocell.core.picture.synthetic import photograph

pytestmark = pytest.mark.blender

BOARDS = Path(__file__).resolve().parents[2] / "samples" / "02_cameras" / "board"
TRUTH = read_camera(BOARDS / "truth.json").intrinsics


def chosen(*numbers):
    return [{"name": f"board_{number:02d}.jpg"} for number in numbers]


def estimate(bpy, numbers=range(0, 12, 2), model="plumb_bob", folder=BOARDS):
    bpy.context.scene.monocell_lens.model = model
    return bpy.ops.monocell.estimate_lens(
        "EXEC_DEFAULT", True, directory=str(folder), files=chosen(*numbers)
    )


def test_pictures_of_a_board_become_the_camera_of_the_picture_that_is_opened(addon, tmp_path):
    assert estimate(addon) == {"FINISHED"}
    assert addon.context.scene.monocell_inputs.camera_source == "BOARD"
    cv2.imwrite(str(tmp_path / "cell.png"), photograph(TRUTH, ()))
    addon.ops.monocell.open_picture(picture=str(tmp_path / "cell.png"))
    addon.ops.monocell.save_cell(filepath=str(tmp_path / "x.cell.json"))
    found = read_cell(tmp_path / "x.cell.json").camera.intrinsics
    assert np.abs(found.matrix() - TRUTH.matrix()).max() < 1.0
    # what was told of the lens is told in the new scene, too
    assert json.loads(addon.context.scene.monocell_lens.estimate)["verdict"] == "weak"


def test_the_estimate_tells_its_error_verdict_and_warnings(addon, module):
    estimate(addon)
    lens = module("addon.camera.lens_estimate")
    found = lens.parse_estimate(addon.context.scene.monocell_lens.estimate)
    assert (found.verdict, found.used, found.pictures) == ("weak", 6, 6)
    assert abs(found.camera["fx"] - TRUTH.fx) < 4 * found.sigmas["fx"] < 4.0
    assert found.rms_pixels < 0.1
    assert any("pictures" in warning for warning in found.warnings)
    assert lens.told_estimate(found).startswith("Lens weak: focal length 60")


def test_with_no_picture_chosen_all_of_the_folder_are_taken(addon, module, tmp_path):
    for number in (0, 3, 5, 8):
        shutil.copy(BOARDS / f"board_{number:02d}.jpg", tmp_path)
    (tmp_path / "notes.txt").write_text("no picture")
    addon.context.scene.monocell_lens.model = "plumb_bob"
    addon.ops.monocell.estimate_lens("EXEC_DEFAULT", directory=str(tmp_path))
    found = json.loads(addon.context.scene.monocell_lens.estimate)
    assert (found["used"], found["pictures"]) == (4, 4)


def test_what_can_not_be_estimated_is_refused_and_nothing_is_kept(addon, tmp_path):
    scene = addon.context.scene
    with pytest.raises(RuntimeError, match="there is no picture in this folder"):
        addon.ops.monocell.estimate_lens(directory=str(tmp_path))
    with pytest.raises(RuntimeError, match="at least 3 are needed"):
        estimate(addon, (0, 1))
    scene.monocell_lens.corners_x = 8
    with pytest.raises(RuntimeError, match="9x6"):
        estimate(addon, (0, 1, 2))
    scene.monocell_lens.board, scene.monocell_lens.marker = "charuco", 0.03
    with pytest.raises(RuntimeError, match="must be smaller than its square"):
        estimate(addon, (0, 1, 2))
    assert scene.monocell_lens.estimate == ""


def test_a_picture_is_not_opened_with_a_lens_that_failed_or_is_not_there(addon, module, tmp_path):
    scene = addon.context.scene
    scene.monocell_inputs.camera_source = "BOARD"
    cv2.imwrite(str(tmp_path / "cell.png"), photograph(TRUTH, ()))
    with pytest.raises(RuntimeError, match="no lens estimated yet: press Estimate"):
        addon.ops.monocell.open_picture(picture=str(tmp_path / "cell.png"))
    estimate(addon)
    kept = json.loads(scene.monocell_lens.estimate)
    failed = kept | {"verdict": "failed", "warnings": ["every board is parallel to the picture"]}
    scene.monocell_lens.estimate = json.dumps(failed)
    with pytest.raises(RuntimeError, match="the lens estimate failed: every board is parallel"):
        addon.ops.monocell.open_picture(picture=str(tmp_path / "cell.png"))


def test_each_picture_and_model_is_told_before_it_is_worked_on(module):
    from monocell.core.lens.board import Chessboard
    from monocell.core.lens.calibrate_lens import calibrate_lens
    from monocell.core.picture.pictures import read_picture

    told = []
    names = [one["name"] for one in chosen(0, 3, 5)]
    calibrate_lens(
        names,
        lambda name: read_picture(BOARDS / name),
        Chessboard(9, 6, 0.025),
        "plumb_bob",
        watch=told.append,
    )
    assert told == [*names, "plumb_bob"]
