# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures are read one at a time, and several balls in one of them are told apart."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest
from ball_rig import LENS, PLACES, POSE, QUIET, RADIUS, pose_twist, sigmas_off, write_rig
from monocell.core import Camera, Cell, SphereSighting
from monocell.core.calibration.calibrate import calibrate_cell
from monocell.core.errors import PictureError
from monocell.core.picture import shelf
from monocell.core.picture.synthetic import Ball, photograph


@pytest.fixture(scope="module")
def crowded(tmp_path_factory):
    """One picture with five balls, and a cell that gives no windows."""
    folder = tmp_path_factory.mktemp("crowded")
    balls = tuple(Ball(tuple(POSE.apply(place)), RADIUS) for place in PLACES[:5])
    cv2.imwrite(str(folder / "all.png"), photograph(LENS, balls, QUIET))
    sightings = tuple(SphereSighting("all.png", place, RADIUS) for place in PLACES[:5])
    return Cell(Camera(LENS), sightings=sightings, folder=folder)


def places_found(calibration):
    return np.array([r.outline.centre_camera for r in calibration.sightings])


def test_five_balls_in_one_picture_are_told_apart_by_their_places(crowded):
    _, calibration = calibrate_cell(crowded)
    assert {r.status for r in calibration.sightings} == {"used"}
    # every outline is another one, and each is its own sighting's
    expected = POSE.apply(PLACES[:5])
    assert np.linalg.norm(places_found(calibration) - expected, axis=1).max() < 0.05
    twist = pose_twist(calibration.camera.pose)
    assert sigmas_off(twist, calibration.camera.covariance) < 5


def test_the_order_of_sightings_does_not_matter(crowded):
    turned = replace(crowded, sightings=crowded.sightings[::-1])
    _, one = calibrate_cell(crowded)
    _, other = calibrate_cell(turned)
    np.testing.assert_allclose(one.camera.pose.matrix(), other.camera.pose.matrix(), atol=1e-6)


def test_a_ball_that_is_not_there_gets_nobody_else_s_outline(crowded):
    absent = SphereSighting("all.png", [0.2, -0.1, 0.3], RADIUS)
    _, calibration = calibrate_cell(replace(crowded, sightings=(*crowded.sightings, absent)))
    assert [r.status for r in calibration.sightings] == ["used"] * 5 + ["rejected"]


def test_each_picture_is_read_once(tmp_path, monkeypatch):
    cell, read = write_rig(tmp_path), []

    def counted(path, intrinsics=None):
        read.append(path.name)
        return original(path, intrinsics)

    original = shelf.read_picture_told
    monkeypatch.setattr(shelf, "read_picture_told", counted)
    calibrate_cell(cell)
    # though looked at for what stays the same, for the balls, and closely
    assert sorted(read) == sorted({s.picture for s in cell.sightings})


def test_the_shelf_keeps_few_megabytes(tmp_path, monkeypatch):
    cell = write_rig(tmp_path)
    size = cell.camera.intrinsics.width * cell.camera.intrinsics.height * 3
    monkeypatch.setattr(shelf, "MOST_BYTES", 2 * size + 100)
    kept = shelf.PictureShelf(cell)
    for sighting in cell.sightings:
        kept.read(sighting.picture)
    assert list(kept._kept) == [s.picture for s in cell.sightings[-2:]]


def test_a_crowded_picture_is_read_once(crowded, monkeypatch):
    read = []
    original = shelf.read_picture_told
    monkeypatch.setattr(
        shelf, "read_picture_told", lambda *a: read.append(a[0].name) or original(*a)
    )
    calibrate_cell(crowded)
    assert read == ["all.png"]


def test_a_missing_picture_is_told_before_any_is_searched(tmp_path, monkeypatch):
    cell = write_rig(tmp_path)
    monkeypatch.setattr("monocell.core.ball.find.find_sphere", None)
    gone = replace(cell.sightings[5], picture="gone.png")
    with pytest.raises(PictureError, match=r"gone\.png: there is no such picture"):
        calibrate_cell(replace(cell, sightings=(*cell.sightings[:5], gone)))


def test_a_sighting_switched_off_changes_nothing_and_is_kept(tmp_path):
    cell = write_rig(tmp_path)
    _, without = calibrate_cell(replace(cell, sightings=cell.sightings[1:]))
    off = replace(cell.sightings[0], picture="gone.png", use=False)
    solved, calibration = calibrate_cell(replace(cell, sightings=(off, *cell.sightings[1:])))
    assert len(calibration.sightings) == len(cell.sightings) - 1
    assert [s.use for s in solved.sightings].count(False) == 1
    np.testing.assert_array_equal(calibration.camera.pose.matrix(), without.camera.pose.matrix())


def test_who_watches_hears_of_every_picture_and_can_end_the_work(tmp_path):
    class Enough(Exception):
        pass

    cell, heard = write_rig(tmp_path), []
    calibrate_cell(cell, watch=heard.append)
    assert set(heard) == {s.picture for s in cell.sightings}

    def ends(name):
        raise Enough

    with pytest.raises(Enough):
        calibrate_cell(cell, watch=ends)
