# SPDX-License-Identifier: GPL-3.0-or-later
"""A lens from pictures of a board, dropped files and another camera, in a real window."""

from pathlib import Path

import cv2
import pytest
from monocell.core import Camera, Cell
from monocell.core.document.camera_file import read_camera
from monocell.core.document.cell_file import write_cell
from monocell.core.picture.synthetic import photograph
from window_run import in_window

pytestmark = [pytest.mark.real_blender, pytest.mark.slow]

BOARDS = Path(__file__).resolve().parents[2] / "samples" / "02_cameras" / "board"
LENS = read_camera(BOARDS / "truth.json").intrinsics


@pytest.fixture(scope="session")
def worked(window_blender, tmp_path_factory):
    """The folder that one Blender left its work in, and what it found."""
    folder = tmp_path_factory.mktemp("picture")
    for name in ("first.png", "second.png"):
        cv2.imwrite(str(folder / name), photograph(LENS, ()))
    cell = Cell(Camera(LENS), picture="first.png", folder=folder)
    write_cell(cell, folder / "cell.cell.json")
    job = {
        "width": LENS.width,
        "height": LENS.height,
        "boards": f"{BOARDS}/",
        "folder": f"{folder}/",
    }
    return in_window(window_blender, folder, "picture_steps.py", job)


def test_no_step_fails(worked):
    _, found, run = worked
    assert "error" not in found, found.get("error")
    assert "Traceback" not in run.stdout + run.stderr


def test_escape_ends_the_estimate_and_nothing_is_kept(worked):
    assert worked[1]["was_working"] == "Estimating"
    assert worked[1]["cancelled"] == ""


def test_pictures_chosen_in_the_file_browser_tell_the_lens(worked):
    found = worked[1]["estimate"]
    assert (found["verdict"], found["used"]) == ("good", 12)
    assert abs(found["camera"]["fx"] - LENS.fx) < 4 * found["sigmas"]["fx"]


def test_of_several_pictures_the_first_by_name_starts_the_cell(worked):
    assert worked[1]["started"] == "first.png"


def test_pictures_dropped_on_a_cell_become_sightings_at_the_copied_places(worked):
    pictures, places = zip(*worked[1]["sightings"], strict=True)
    assert pictures == ("first.png", "second.png")
    assert places[0] == pytest.approx([0.1, 0.2, 0.3])
    assert places[1] == pytest.approx([0.2, 0.3, 0.4])


def test_what_takes_a_dropped_file_depends_on_what_is_open(worked):
    found = worked[1]
    start, boards = "monocell.drop_picture", "monocell.estimate_lens"
    assert found["empty"] == {".png": [start, boards], ".json": ["monocell.open_cell"]}
    assert found["open"][".png"] == ["monocell.add_pictures", start]
    assert found["dropped"] == "cell"


def test_another_camera_is_one_undo_step(worked):
    found = worked[1]
    # 60 degrees over 640 pixels
    assert found["changed"]["fx"] == pytest.approx(554.256, abs=1e-2)
    assert found["undone"]
