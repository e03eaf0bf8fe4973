# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture of 27 megapixels in a real window: nothing freezes, and Esc leaves all as it was."""

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from monocell.core import Camera
from monocell.core.document.camera_file import write_camera
from monocell.core.document.cell_file import read_cell, write_cell
from monocell.core.intrinsics import Intrinsics
from window_run import in_window

pytestmark = [pytest.mark.real_blender, pytest.mark.slow]

SAMPLE = Path(__file__).resolve().parents[2] / "samples" / "03_stack" / "stack.cell.json"
WIDTH = 6000
CORNERS = ((2000.0, 1500.0), (2600.0, 2100.0))


def enlarged(folder):
    """The sample's picture and its first sighting as a camera of 27 megapixels takes them."""
    cell = read_cell(SAMPLE)
    lens = cell.camera.intrinsics
    scale = WIDTH / lens.width
    # a pixel's centre counts, not its corner
    cx, cy = (scale * (at + 0.5) - 0.5 for at in (lens.cx, lens.cy))
    size = WIDTH, round(scale * lens.height)
    large = Intrinsics(*size, scale * lens.fx, scale * lens.fy, cx, cy, lens.distortion)
    sighting = replace(cell.sightings[0], window=None)
    for name in (cell.picture, sighting.picture):
        picture = cv2.imread(str(cell.path_of(name)))
        cv2.imwrite(str(folder / name), cv2.resize(picture, size, interpolation=cv2.INTER_CUBIC))
    return replace(cell, camera=Camera(large), sightings=(sighting,), objects=(), folder=folder)


@pytest.fixture(scope="session")
def worked(window_blender, tmp_path_factory):
    """The folder that one Blender left its work in, and what it found."""
    folder = tmp_path_factory.mktemp("opening")
    cell = enlarged(folder)
    write_cell(cell, folder / "large.cell.json")
    write_camera(cell.camera, folder / "camera.json")
    inner = cell.camera.intrinsics
    job = {
        "width": inner.width,
        "height": inner.height,
        "picture": str(folder / cell.picture),
        "camera": str(folder / "camera.json"),
        "document": str(folder / "large.cell.json"),
        "corners": CORNERS,
    }
    return in_window(window_blender, folder, "opening_steps.py", job)


def test_no_step_fails(worked):
    _, found, run = worked
    assert "error" not in found, found.get("error")
    assert "Traceback" not in run.stdout + run.stderr


def test_progress_is_shown_as_soon_as_the_button_lets_go(worked):
    found = worked[1]
    assert found["cancelled_while"] == found["opened_while"] == "Opening"
    assert found["dragging_while"] == "Showing"


def test_escape_leaves_no_trace(worked):
    assert worked[1]["untouched"]


def test_the_picture_opens_at_its_full_size_in_one_undo_step(worked):
    found = worked[1]
    assert (found["size"], found["shown"]) == ([6000, 4500], "cell.jpg")
    assert found["undone"]


def test_a_window_is_dragged_on_the_picture_that_was_read_for_it(worked):
    folder, found, _ = worked
    assert found["dragged_on"] == "pose_00.jpg"
    cell = read_cell(folder / "dragged.cell.json")
    lens, (x, y, width, height) = cell.camera.intrinsics, cell.sightings[0].window
    corners = lens.project(lens.undistorted().rays(np.array(CORNERS)))
    # a screen pixel shows some eight of the picture
    assert np.abs(corners - [[x, y], [x + width, y + height]]).max() < 25
