# SPDX-License-Identifier: GPL-3.0-or-later
from dataclasses import replace
from types import SimpleNamespace

import bench_cell
import numpy as np
import pytest
from monocell.addon.camera.report import (
    AdvisedPlace,
    Report,
    SeenSighting,
    dump_report,
    parse_report,
    seen_of,
)
from monocell.addon.overlay.drawing import GREEN, GREY, HALO, ORANGE, RED, WHITE, YELLOW, ends_of
from monocell.addon.overlay.overlay_lines import (
    joined,
    looks_of,
    object_strokes,
    sighting_color,
    sighting_labels,
    sighting_strokes,
)
from monocell.core.sighting import PointSighting


def seen(status, centre=None, rms=0.1, reason=""):
    outline = None if centre is None else SimpleNamespace(centre_camera=centre, radius=0.04)
    return seen_of(SimpleNamespace(status=status, reason=reason, rms_pixels=rms, outline=outline))


CENTRES = [bench_cell.POSE.apply(centre) for centre in bench_cell.CENTRES]
REPORT = Report(
    "weak",
    ("a", "b"),
    0.2,
    -0.1,
    (
        seen("used", CENTRES[0]),
        seen("doubtful", CENTRES[1] + [0.002, 0, 0], reason="half of it is hidden"),
        seen("rejected", rms=float("nan")),
        seen("used", CENTRES[3]),
        seen("used", CENTRES[4]),
    ),
    "floor",
    (AdvisedPlace((0.4, 0.0, 0.2), (400.0, 300.0), 20.0, 0.19),),
)


def strokes(tmp_path, active=-1, report=REPORT):
    return list(sighting_strokes(bench_cell.cell_of(folder=tmp_path), report, active))


def test_a_report_comes_back_from_its_text():
    assert parse_report(dump_report(REPORT)) == REPORT
    assert parse_report("") is None


def test_balls_are_coloured_by_what_the_pose_leaves_of_them(tmp_path):
    # each has a dark halo below it
    colors = [stroke.color for stroke in strokes(tmp_path)[1:6:2]]
    assert np.allclose(colors, [GREEN, ORANGE, RED])
    poor = replace(REPORT, sightings=(seen("used", CENTRES[0], rms=3.0),))
    assert sighting_color(poor, 0, True) == pytest.approx(RED)
    assert sighting_color(poor, 0, False) == GREY
    assert sighting_color(None, 0, True) == WHITE


def test_the_doubtful_say_why_and_the_others_their_number(tmp_path):
    labels = list(sighting_labels(bench_cell.cell_of(folder=tmp_path), REPORT))
    assert [label.text for label in labels] == [
        "1",
        "2  half of it is hidden",
        "3",
        "4",
        "5",
        "next 1: 0.19 mm",
    ]


def test_advice_is_drawn_where_the_ball_would_be_seen(tmp_path):
    (line,) = strokes(tmp_path)[-1].lines
    centre = bench_cell.POSE.apply(np.array([0.4, 0.0, 0.2]))
    expected = bench_cell.INTRINSICS.undistorted().project(centre[None])[0]
    assert np.linalg.norm((line.min(axis=0) + line.max(axis=0)) / 2 - expected) < 1.0


def test_a_clicked_point_is_a_cross_at_its_pixel(tmp_path):
    point = PointSighting("bench.png", [0.4, 0, 0], [300.0, 200.0])
    cell = replace(bench_cell.cell_of(folder=tmp_path), sightings=(point,))
    _, cross = sighting_strokes(cell, None, -1)
    i = bench_cell.INTRINSICS
    at = i.undistorted().project(i.rays(np.array([[300.0, 200.0]])))[0]
    assert np.concatenate(cross.lines).mean(axis=0) == pytest.approx(at)


def test_an_edit_keeps_what_still_holds_and_forgets_the_advice():
    arranged = REPORT.arranged([1, None])
    assert arranged.sightings == (REPORT.sightings[1], SeenSighting("", "", None, None))
    assert arranged.changed and arranged.advice == ()


def test_a_ball_that_was_not_found_is_drawn_where_it_should_be(tmp_path):
    (line,) = strokes(tmp_path)[5].lines
    expected = bench_cell.INTRINSICS.undistorted().project(CENTRES[2][None])[0]
    assert np.linalg.norm((line.min(axis=0) + line.max(axis=0)) / 2 - expected) < 1.0


def test_the_active_ball_is_drawn_wider(tmp_path):
    widths = [stroke.width for stroke in strokes(tmp_path, active=1)[1:6:2]]
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
    assert strokes(tmp_path, 0, None) == []


@pytest.mark.parametrize("active", [True, False])
def test_hidden_edges_are_fainter(active):
    hidden, _, seen = object_strokes(bench_cell.BOX, bench_cell.CAMERA, active)
    assert len(hidden.lines) == 3
    assert hidden.color[3] < seen.color[3] and hidden.width < seen.width


def test_lines_become_the_ends_of_their_straight_parts():
    lines = [
        np.array([[0.0, 0], [1, 0], [1, 1]]),
        np.array([[5.0, 5]]),
        np.array([[2.0, 2], [3, 3]]),
    ]
    assert ends_of(lines)[:, :2].tolist() == [[0, 0], [1, 0], [1, 0], [1, 1], [2, 2], [3, 3]]
    assert ends_of([]).shape == (0, 3)


def test_objects_are_joined_by_their_looks_with_halos_below():
    many = [
        looks_of(object_strokes(thing, bench_cell.CAMERA, False))
        for thing in (bench_cell.BOX, bench_cell.DRUM)
    ]
    together = joined(many)
    assert len(together) == 3
    assert next(iter(together))[0] == HALO
    assert sum(map(len, together.values())) == sum(len(e) for one in many for e in one.values())


def test_a_line_that_is_straight_all_along_keeps_its_ends_alone():
    along = np.linspace([0.0, 0], [40, 30], 9)
    bent = np.array([[0.0, 0], [20, 0.5], [40, 0]])
    there_and_back = np.array([[0.0, 0], [50, 0], [40, 0]])
    closed = np.array([[0.0, 0], [5, 0], [5, 5], [0.0, 0]])
    lines = [along, bent, there_and_back, closed, along[::-1]]
    starts = ends_of(lines)[0::2, :2].tolist()
    assert starts == [[0, 0], [0, 0], [20, 0.5], [0, 0], [50, 0], [0, 0], [5, 0], [5, 5], [40, 30]]
    assert ends_of(lines)[1::2, :2].tolist()[0] == [40, 30]
    assert ends_of(lines)[1::2, :2].tolist()[-1] == [0, 0]
