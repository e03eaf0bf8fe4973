# SPDX-License-Identifier: GPL-3.0-or-later
from types import SimpleNamespace

import bench_cell
import numpy as np
import pytest
from monocell.addon.drawing import GREEN, ORANGE, RED, YELLOW
from monocell.addon.overlay_lines import ball_strokes, object_strokes
from monocell.addon.report import dump_report, parse_report, report_of


def sighting(status, centre=None, rms=0.1):
    outline = None if centre is None else SimpleNamespace(centre_camera=centre, radius=0.04)
    return SimpleNamespace(status=status, reason="", rms_pixels=rms, outline=outline)


def calibration(*sightings):
    return SimpleNamespace(
        verdict="weak",
        warnings=("a", "b"),
        rms_pixels=0.2,
        edge_bias_pixels=-0.1,
        sightings=sightings,
    )


CENTRES = [bench_cell.POSE.apply(centre) for centre in bench_cell.CENTRES]
REPORT = report_of(
    calibration(
        sighting("used", CENTRES[0]),
        sighting("doubtful", CENTRES[1] + [0.002, 0, 0]),
        sighting("rejected", rms=float("nan")),
    )
)


def strokes(tmp_path, active=-1):
    cell = bench_cell.cell_of(folder=tmp_path)
    return list(ball_strokes(cell, REPORT, active))


def test_a_report_comes_back_from_its_text():
    assert parse_report(dump_report(REPORT)) == REPORT
    assert parse_report("") is None


def test_balls_are_coloured_by_their_status(tmp_path):
    # each has a dark halo below it
    assert [stroke.color for stroke in strokes(tmp_path)[1::2]] == [GREEN, ORANGE, RED]


def test_a_ball_that_was_not_found_is_drawn_where_it_should_be(tmp_path):
    (line,) = strokes(tmp_path)[5].lines
    expected = bench_cell.INTRINSICS.undistorted().project(CENTRES[2][None])[0]
    assert np.linalg.norm((line.min(axis=0) + line.max(axis=0)) / 2 - expected) < 1.0


def test_the_active_ball_is_drawn_wider(tmp_path):
    widths = [stroke.width for stroke in strokes(tmp_path, active=1)[1::2]]
    assert widths[1] > widths[0] == widths[2]


def test_the_wireframe_passes_through_the_corners_of_the_undistorted_view():
    lines = [
        line
        for stroke in object_strokes(bench_cell.BOX, bench_cell.CAMERA, active=True)
        for line in stroke.lines
    ]
    pixels = np.concatenate(lines)
    pinhole = bench_cell.INTRINSICS.undistorted()
    corners = pinhole.project(bench_cell.POSE.apply(bench_cell.BOX.corners_world()))
    assert all(np.linalg.norm(pixels - corner, axis=1).min() < 1e-6 for corner in corners)
    # a perfect lens bends nothing
    assert max(len(line) for line in lines) < 20


def test_the_active_object_is_yellow():
    colors = {stroke.color for stroke in object_strokes(bench_cell.BOX, bench_cell.CAMERA, True)}
    assert YELLOW in colors


def test_nothing_is_drawn_before_a_calibration(tmp_path):
    assert list(ball_strokes(bench_cell.cell_of(folder=tmp_path), None, 0)) == []


@pytest.mark.parametrize("active", [True, False])
def test_hidden_edges_are_fainter(active):
    hidden, _, seen = object_strokes(bench_cell.BOX, bench_cell.CAMERA, active)
    assert len(hidden.lines) == 3
    assert hidden.color[3] < seen.color[3] and hidden.width < seen.width
