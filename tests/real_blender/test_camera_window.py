# SPDX-License-Identifier: GPL-3.0-or-later
"""From the sample to a calibrated camera in a real window, with work in the background."""

import json
from pathlib import Path

import numpy as np
import pytest
from monocell.core.document.cell_file import read_cell
from monocell.core.sighting import PointSighting
from window_run import in_window

pytestmark = [pytest.mark.real_blender, pytest.mark.slow]

SAMPLE = Path(__file__).resolve().parents[2] / "samples" / "01_table"
THIRD_BALL = 2


@pytest.fixture(scope="session")
def worked(window_blender, tmp_path_factory):
    """The folder that one Blender left its work in, and what it found."""
    camera = read_cell(SAMPLE / "truth.cell.json").camera
    ball = read_cell(SAMPLE / "table.cell.json").sightings[THIRD_BALL]
    i = camera.intrinsics
    pinhole = i.undistorted()
    u, v = pinhole.project(camera.pose.apply(ball.center_world)[None])[0]
    point = [0.5, -0.1, 0.0]
    job = {
        "width": i.width,
        "height": i.height,
        "window": [u - 60, v - 60, u + 60, v + 60],
        "point": point,
        "sample": f"{SAMPLE}/",
        "point_at": pinhole.project(camera.pose.apply(np.array([point])))[0].tolist(),
    }
    folder = tmp_path_factory.mktemp("camera")
    return in_window(window_blender, folder, "camera_steps.py", job)


def cell(worked, name):
    return read_cell(worked[0] / f"{name}.cell.json")


def test_no_step_fails(worked):
    _, found, run = worked
    assert "error" not in found, found.get("error")
    assert "Traceback" not in run.stdout + run.stderr
    assert not found["left_over"]


def test_escape_cancels_the_work_without_a_trace(worked):
    found = worked[1]
    assert found["was_working"] == "Calibrating"
    assert found["unchanged"]


def test_progress_goes_up_while_the_window_lives(worked):
    shares = worked[1]["shares"]
    assert shares == sorted(shares)
    assert len(set(shares)) > 2


def test_all_balls_are_found_in_the_background(worked):
    assert worked[1]["found"] == ["found"] * 8


def test_a_dragged_window_is_one_of_the_picture_as_it_came(worked):
    sighting = cell(worked, "window").sightings[THIRD_BALL]
    x, y, width, height = sighting.window
    truth = read_cell(SAMPLE / "truth.cell.json").camera
    centre = truth.project(sighting.center_world[None])[0]
    assert [x + width / 2, y + height / 2] == pytest.approx(centre, abs=3)
    assert width == pytest.approx(120, abs=6)
    assert cell(worked, "undone").sightings[THIRD_BALL].window is None


def test_the_calibrated_camera_is_the_true_one(worked):
    found, truth = cell(worked, "calibrated").camera, read_cell(SAMPLE / "truth.cell.json").camera
    off = np.linalg.norm(found.centre_world - truth.centre_world)
    assert off < 3 * np.linalg.norm(found.centre_sigma())
    assert set(worked[1]["calibrated"]) <= {"used", "doubtful"}
    report = json.loads(worked[1]["report"])
    assert report["surface"] == "table"
    assert 0 < report["surface_millimetres"] < 2


def test_a_clicked_point_is_a_pixel_of_the_picture_as_it_came(worked):
    point = cell(worked, "point").sightings[-1]
    assert isinstance(point, PointSighting)
    truth = read_cell(SAMPLE / "truth.cell.json").camera
    expected = truth.project(point.center_world[None])[0]
    # a screen pixel shows more than one of the picture
    assert np.abs(point.pixel - expected).max() < 1.5
    assert len(cell(worked, "cancelled").sightings) == len(cell(worked, "point").sightings)


def test_a_document_that_is_dropped_opens_at_once(worked):
    assert worked[1]["dropped"] == "table"
