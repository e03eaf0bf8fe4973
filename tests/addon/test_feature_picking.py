# SPDX-License-Identifier: GPL-3.0-or-later
from pathlib import Path

import bench_cell
import numpy as np
import pytest
from monocell.addon.on_picture.feature_picking import outline_of, path_of, shown_at
from monocell.core import Pose
from monocell.core.primitives import Cone, Prism, Sphere, Tube
from monocell.core.shape.features import feature, feature_names

BALL = Sphere("ball", Pose(np.eye(3), [0.55, -0.2, 0.05]), radius=0.05)
CELL = bench_cell.cell_of(folder=Path()).with_objects((bench_cell.BOX, bench_cell.DRUM, BALL))
REACH = 6.0


def at(point, **keys):
    pixel = bench_cell.CAMERA.project(np.array([point]))[0]
    return shown_at(CELL, pixel, REACH, **keys)


def on_box(x, y, z):
    return bench_cell.BOX.world_from_object.apply(np.array([x, y, z]) * bench_cell.BOX.half_extent)


def test_a_face_is_what_its_middle_shows():
    shown = at(on_box(0, 0, 1))
    assert (shown.path, shown.kind) == ("box.top", "plane")
    assert len(shown.line) == 5


def test_near_an_edge_the_edge_is_meant_and_farther_away_the_face():
    edge = at(on_box(0.0, -1.0, 1.0))
    assert (edge.path, edge.kind) == ("box.y-top", "line")
    pixel = bench_cell.CAMERA.project(on_box(0.0, -0.9, 1.0)[None])[0]
    assert shown_at(CELL, pixel, 2.0).path == "box.top"


def test_an_edge_that_its_own_box_hides_is_not_meant():
    shown = at(on_box(-1.0, 1.0, 0.0))
    assert shown is None or "x-y+" not in shown.path


def test_a_round_side_means_its_axis_and_an_end_its_face():
    drum = bench_cell.DRUM.world_from_object
    eye = bench_cell.POSE.inverse().translation - drum.translation
    side = drum.apply([*(0.06 * eye[:2] / np.linalg.norm(eye[:2])), 0.0])
    assert (at(side).path, at(side).kind) == ("drum.axis", "line")
    assert at(drum.apply([0.0, 0.0, 0.09])).path == "drum.top"


def test_with_shift_the_axis_of_whatever_is_there_is_meant():
    assert at(on_box(0, 0, 1), axis=True).path == "box.axis"


def test_a_ball_is_no_reference_and_the_floor_is_itself():
    assert at([0.55, -0.2, 0.1]) is None
    assert at([0.7, 0.3, 0.0]).path == "floor"


def test_above_the_horizon_there_is_nothing():
    assert shown_at(CELL, np.array([400.0, -250.0]), REACH) is None


def test_a_feature_is_found_in_the_list_by_its_name():
    assert path_of(CELL, "floor") == "floor"
    assert path_of(CELL, "box.top") is None


@pytest.mark.parametrize(
    "thing",
    [
        bench_cell.BOX,
        bench_cell.DRUM,
        Cone("cone", Pose.identity(), radius=0.1, top_radius=0.05, height=0.2),
        Tube("tube", Pose.identity(), radius=0.1, inner_radius=0.05, height=0.2),
        Prism(
            "prism", Pose.identity(), polygon=[[-0.1, -0.1], [0.1, -0.1], [0.0, 0.2]], height=0.2
        ),
    ],
    ids=lambda thing: thing.kind,
)
def test_what_is_drawn_of_a_feature_lies_on_it(thing):
    for name in feature_names(thing):
        found = feature(thing, name)
        if found.kind == "point":
            continue
        away = outline_of(thing, name) - found.point
        off = away @ found.direction if found.kind == "plane" else np.cross(away, found.direction)
        assert np.abs(off).max() < 1e-12
