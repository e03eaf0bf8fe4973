# SPDX-License-Identifier: GPL-3.0-or-later
"""A camera's pose from pictures of a ball at known places, and from places that are wrong."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest
from ball_rig import LENS, PLACES, POSE, RADIUS, pose_twist, sigmas_off, write_rig
from monocell.core import Camera, Cell
from monocell.core.ball.find import find_sphere
from monocell.core.calibration.calibrate import calibrate_cell, calibrate_outlines
from monocell.core.errors import (
    AmbiguousPose,
    DegeneratePositions,
    InvalidValue,
    NotConverged,
    PictureError,
    SphereNotFound,
    TooFewSightings,
)
from monocell.core.picture.pictures import read_picture


@pytest.fixture(scope="module")
def rig(tmp_path_factory):
    return write_rig(tmp_path_factory.mktemp("rig"))


def with_places(cell, places):
    moved = (
        replace(s, center_world=place) for s, place in zip(cell.sightings, places, strict=True)
    )
    return replace(cell, sightings=tuple(moved))


def is_right(calibration, most_sigmas=5.0, millimetres=4.0, degrees=0.15):
    twist = pose_twist(calibration.camera.pose)
    assert sigmas_off(twist, calibration.camera.covariance) < most_sigmas
    off = calibration.camera.centre_world - POSE.inverse().translation
    assert 1e3 * np.linalg.norm(off) < millimetres
    assert np.degrees(np.linalg.norm(twist[:3])) < degrees


def rejected(calibration):
    return [r.picture for r in calibration.sightings if r.status == "rejected"]


@pytest.mark.parametrize("windows", [True, False], ids=["windows", "whole pictures"])
def test_six_sightings_give_the_pose_within_its_error(rig, windows):
    cell, calibration = calibrate_cell(write_rig(rig.folder, windows=windows))
    is_right(calibration)
    assert calibration.verdict == "good"
    assert calibration.warnings == ()
    assert calibration.count_used == 6
    assert cell.camera is calibration.camera
    assert {r.status for r in calibration.sightings} == {"used"}
    assert max(r.off_pixels for r in calibration.sightings) < 0.3
    assert calibration.rms_pixels < 0.2
    # the error is stated as what it is: fractions of a degree, millimetres
    assert np.degrees(calibration.camera.rotation_sigma().max()) < 0.1
    assert calibration.camera.centre_sigma().max() < 3e-3


def test_the_truth_is_not_needed_and_not_read(rig):
    _, calibration = calibrate_cell(rig)
    elsewhere = Camera(LENS, POSE.perturbed([1, 0, 0, 0, 0, 0]))
    _, again = calibrate_cell(replace(rig, camera=elsewhere))
    np.testing.assert_array_equal(again.camera.pose.matrix(), calibration.camera.pose.matrix())


@pytest.mark.parametrize("wrong", [0, 2, 5])
def test_one_wrong_place_among_six_is_rejected_by_name_and_the_pose_is_right(rig, wrong):
    places = PLACES.copy()
    places[wrong] += [0.05, -0.06, 0.04]
    _, calibration = calibrate_cell(with_places(rig, places))
    assert rejected(calibration) == [f"pose_{wrong}.png"]
    report = calibration.sightings[wrong]
    assert "from where the others put it" in report.reason
    assert 30 < report.off_millimetres < 110
    assert calibration.warnings[0].startswith("1 of 6 sightings rejected")
    assert calibration.verdict == "good"
    is_right(calibration, millimetres=5.0)


def test_two_exchanged_pictures_are_both_rejected(rig):
    order = [0, 1, 4, 3, 2, 5]
    names = [f"pose_{i}.png" for i in order]
    cell = write_rig(rig.folder, names=names)
    _, calibration = calibrate_cell(cell)
    assert rejected(calibration) == ["pose_4.png", "pose_2.png"]
    assert calibration.verdict in ("good", "weak")
    is_right(calibration, millimetres=8.0, degrees=0.3)


def test_a_ball_that_is_not_in_its_picture_is_rejected_with_the_reason(rig, tmp_path):
    blank = np.full((LENS.height, LENS.width, 3), 90, np.uint8)
    cv2.imwrite(str(rig.folder / "blank.png"), blank)
    names = [f"pose_{i}.png" for i in range(5)] + ["blank.png"]
    _, calibration = calibrate_cell(write_rig(rig.folder, names=names))
    assert rejected(calibration) == ["blank.png"]
    report = calibration.sightings[5]
    assert "no ball found" in report.reason
    assert np.isnan([report.rms_pixels, report.off_pixels, report.off_millimetres]).all()
    is_right(calibration)


def test_a_window_in_the_wrong_place_is_mended_from_the_other_sightings(rig):
    cell = write_rig(rig.folder, windows=True)
    sightings = list(cell.sightings)
    sightings[1] = replace(sightings[1], window=(10.0, 10.0, 60.0, 60.0))
    _, calibration = calibrate_cell(replace(cell, sightings=tuple(sightings)))
    assert rejected(calibration) == []
    is_right(calibration)


def test_places_that_have_nothing_to_do_with_the_pictures_are_not_believed(rig):
    rng = np.random.default_rng(8)
    for _ in range(2):
        scrambled = with_places(rig, rng.uniform(-0.4, 0.4, (6, 3)))
        try:
            _, calibration = calibrate_cell(scrambled)
        except (AmbiguousPose, NotConverged, DegeneratePositions):
            continue
        assert calibration.verdict != "good"
        assert calibration.verdict == "failed" or len(rejected(calibration)) >= 2


def test_a_wrong_radius_is_noticed(rig):
    swollen = replace(rig, sightings=tuple(replace(s, radius=1.05 * RADIUS) for s in rig.sightings))
    _, calibration = calibrate_cell(swollen)
    assert calibration.verdict != "good"
    assert any("radius" in warning for warning in calibration.warnings)


def test_three_sightings_are_weak_because_nothing_checks_them(rig):
    _, calibration = calibrate_cell(replace(rig, sightings=rig.sightings[:3]))
    assert calibration.verdict == "weak"
    assert any("add a fourth" in warning for warning in calibration.warnings)
    is_right(calibration, millimetres=12.0, degrees=0.4)


def test_the_same_sighting_twice_counts_once_for_the_geometry(rig):
    doubled = replace(rig, sightings=(*rig.sightings[:4], rig.sightings[0]))
    _, calibration = calibrate_cell(doubled)
    is_right(calibration, millimetres=6.0, degrees=0.3)
    with pytest.raises(DegeneratePositions, match="only 2 different"):
        calibrate_cell(replace(rig, sightings=(*rig.sightings[:2], *rig.sightings[:2])))


@pytest.mark.parametrize("count", [0, 1, 2])
def test_fewer_than_three_sightings_are_too_few(rig, count):
    with pytest.raises(TooFewSightings, match=f"{count}; add sightings"):
        calibrate_cell(replace(rig, sightings=rig.sightings[:count]))


def test_positions_on_a_line_are_refused_before_any_picture_is_read(tmp_path):
    line = np.linspace([0.0, -0.3, 0.1], [0.2, 0.3, 0.4], 6)
    cell = Cell(Camera(LENS), sightings=write_rig(tmp_path).sightings, folder=tmp_path / "none")
    with pytest.raises(DegeneratePositions, match=r"mm of a line .* mm long: .* deg about it"):
        calibrate_cell(with_places(cell, line))


def test_balls_found_in_too_few_pictures_are_told_with_the_first_reason(rig, tmp_path):
    blank = np.full((LENS.height, LENS.width, 3), 90, np.uint8)
    cv2.imwrite(str(rig.folder / "blank.png"), blank)
    names = ["pose_0.png", "pose_1.png"] + ["blank.png"] * 4
    with pytest.raises(SphereNotFound, match=r"found in 2 of 6 .* blank\.png: no ball found"):
        calibrate_cell(write_rig(rig.folder, names=names))


def test_a_missing_picture_is_named(rig):
    gone = replace(rig, sightings=(*rig.sightings, replace(rig.sightings[0], picture="gone.png")))
    with pytest.raises(PictureError, match=r"gone\.png: there is no such picture"):
        calibrate_cell(gone)


def test_the_paper_s_frames_run_and_are_worse(rig):
    _, joint = calibrate_cell(rig)
    _, frames = calibrate_cell(rig, "frames")
    assert frames.method == "frames"
    assert frames.camera.covariance is None
    error, baseline = (
        np.linalg.norm(c.camera.centre_world - POSE.inverse().translation) for c in (joint, frames)
    )
    assert baseline > 3 * error
    assert baseline < 0.3
    with pytest.raises(InvalidValue, match="'guess' is none of joint, frames, p3p, pnp"):
        calibrate_cell(rig, "guess")


@pytest.mark.parametrize("method", ["p3p", "pnp"])
def test_baselines_on_directions_come_near_and_list_their_candidates(rig, method):
    _, calibration = calibrate_cell(rig, method)
    truth = POSE.inverse().translation
    assert np.linalg.norm(calibration.camera.centre_world - truth) < 0.1
    assert calibration.camera.covariance is None
    offs = [candidate.off_pixels for candidate in calibration.candidates]
    assert offs == sorted(offs)
    assert 1 <= len(offs) <= (4 if method == "p3p" else 1)
    assert offs[0] < 3.0


def test_measured_outlines_give_the_same_pose_as_their_pictures(rig):
    outlines = [
        find_sphere(read_picture(rig.path_of(s.picture)), LENS, RADIUS) for s in rig.sightings
    ]
    _, from_pictures = calibrate_cell(rig)
    calibration = calibrate_outlines(rig.camera, rig.sightings, outlines)
    np.testing.assert_allclose(
        calibration.camera.pose.matrix(), from_pictures.camera.pose.matrix(), atol=5e-5
    )
    one_lost = calibrate_outlines(rig.camera, rig.sightings, [None, *outlines[1:]])
    assert rejected(one_lost) == ["pose_0.png"]
    assert one_lost.sightings[0].reason == "not found"
    is_right(one_lost)


def test_a_mirrored_rig_is_not_believed_though_three_of_its_places_always_fit(rig):
    five = replace(rig, sightings=rig.sightings[:5])
    _, calibration = calibrate_cell(with_places(five, PLACES[:5] * [1, -1, 1]))
    assert calibration.verdict == "failed"
    assert any("sightings agree, too few" in warning for warning in calibration.warnings)


@pytest.mark.parametrize("count", [4, 6])
def test_a_wrong_place_is_rejected_whichever_it_is(rig, count):
    for wrong in range(count):
        places = PLACES[:count].copy()
        places[wrong] += [0.05, -0.06, 0.04]
        fewer = replace(rig, sightings=rig.sightings[:count])
        _, calibration = calibrate_cell(with_places(fewer, places))
        assert rejected(calibration) == [f"pose_{wrong}.png"]
        assert calibration.verdict == ("weak" if count == 4 else "good")
        is_right(calibration, millimetres=12.0, degrees=0.4)
