# SPDX-License-Identifier: GPL-3.0-or-later
"""What all sightings and all pictures together know helps each single look, and can be refused."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest
from ball_rig import LENS, PLACES, POSE, QUIET, RADIUS, picture_of, window_around, write_rig
from monocell.core.ball.find import measure_sphere
from monocell.core.calibration import calibrate
from monocell.core.calibration.calibrate import calibrate_cell
from monocell.core.calibration.scenery import Scenery
from monocell.core.errors import InvalidValue, SphereNotFound
from monocell.core.mount import Mount
from monocell.core.picture.shelf import PictureShelf
from monocell.core.pose import Pose


def half_hidden(place):
    """A ball of which a dark bar hides one side, its edge a pixel and a half inside the outline."""
    u, v = LENS.project(POSE.apply(place)[None])[0]
    size = LENS.fx * RADIUS / np.linalg.norm(POSE.apply(place))
    bar = (u - size - 20, v - 30, 21.5, 60)
    return picture_of(place, replace(QUIET, hidden=(bar,)))


def test_a_predicted_ball_keeps_its_place_where_something_hides_its_side():
    place = PLACES[2]
    centre = POSE.apply(place)
    close = measure_sphere(half_hidden(place), LENS, RADIUS, centre, predicted=True)
    pixels = LENS.fx / np.linalg.norm(centre)
    aside = np.linalg.norm(np.cross(close.centre_camera, centre / np.linalg.norm(centre))) * pixels
    assert aside < 0.15
    assert close.used.mean() < 0.95


def test_a_prediction_alone_makes_no_ball():
    empty = np.full((LENS.height, LENS.width, 3), 90, np.uint8)
    noise = np.random.default_rng(0).normal(0, 3, empty.shape)
    wall = np.clip(empty + noise, 0, 255).astype(np.uint8)
    with pytest.raises(SphereNotFound):
        measure_sphere(wall, LENS, RADIUS, POSE.apply(PLACES[0]), predicted=True)


def test_what_stays_in_the_pictures_has_no_ball(tmp_path):
    cell = write_rig(tmp_path)
    background = Scenery.of(cell, PictureShelf(cell)).hints.background
    for place in PLACES:
        u, v = LENS.project(POSE.apply(place)[None])[0].round().astype(int)
        beside = background[v, min(u + 60, LENS.width - 1)].astype(int)
        assert np.abs(background[v, u].astype(int) - beside).max() < 25


def test_a_camera_that_moves_or_few_pictures_have_no_background(tmp_path):
    cell = write_rig(tmp_path)
    shelf = PictureShelf(cell)
    assert Scenery.of(replace(cell, sightings=cell.sightings[:2]), shelf).hints is None
    rode = [replace(s, world_from_flange=Pose.identity()) for s in cell.sightings]
    riding = replace(cell, sightings=tuple(rode), mount=Mount(None, None, None))
    assert Scenery.of(riding, shelf).hints is None
    windowed = [replace(s, window=window_around(s.center_world)) for s in cell.sightings]
    assert Scenery.of(replace(cell, sightings=tuple(windowed)), shelf).hints is None


def test_hints_that_do_not_fit_give_way_to_the_whole_picture(tmp_path):
    cell = write_rig(tmp_path)
    scenery, asked = Scenery.of(cell, PictureShelf(cell)), []

    def find(hints=None):
        asked.append(hints)
        if hints is not None:
            raise InvalidValue("all of it changed")
        return "found"

    assert scenery.hinted(find, cell.sightings[0]) == "found"
    assert [hints is None for hints in asked] == [False, True]


def test_the_same_round_thing_in_all_pictures_is_not_taken_for_the_ball(tmp_path):
    cell = write_rig(tmp_path)
    for sighting in cell.sightings:
        path = tmp_path / sighting.picture
        picture = cv2.imread(str(path))
        cv2.circle(picture, (40, 300), 22, (20, 20, 235), -1, cv2.LINE_AA)
        cv2.imwrite(str(path), picture)
    _, calibration = calibrate_cell(cell)
    assert calibration.count_used == len(cell.sightings)
    off = calibration.camera.centre_world - POSE.inverse().translation
    assert np.linalg.norm(off) < 0.01


def test_every_ball_is_measured_again_where_all_have_it(tmp_path, monkeypatch):
    cell, closely = write_rig(tmp_path), []
    original = calibrate.look_again

    def watched(cell, shelf, expected, **how):
        if how.get("closely"):
            closely.append(dict(expected))
        return original(cell, shelf, expected, **how)

    monkeypatch.setattr(calibrate, "look_again", watched)
    calibrate_cell(cell)
    (expected,) = closely
    assert sorted(expected) == list(range(len(cell.sightings)))
    for i, place in enumerate(PLACES):
        np.testing.assert_allclose(expected[i], POSE.apply(place), atol=0.01)


def test_as_many_balls_elsewhere_as_in_place_are_not_believed(tmp_path):
    cell = write_rig(tmp_path)
    moved = [
        replace(s, center_world=s.center_world + (0.12 * np.eye(3)[i] if i < 3 else 0))
        for i, s in enumerate(cell.sightings)
    ]
    try:
        _, calibration = calibrate_cell(replace(cell, sightings=tuple(moved)))
    except calibrate.MonocellError:
        return
    assert calibration.verdict == "failed"
