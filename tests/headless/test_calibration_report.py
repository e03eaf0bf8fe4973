# SPDX-License-Identifier: GPL-3.0-or-later
"""The report of `monocell calibrate`: for people in short lines, for machines with all numbers."""

from __future__ import annotations

import json
import re

import cv2
import numpy as np
import pytest
from edited_job import edited
from monocell.core.calibration import leave_one_out
from monocell.core.document.cell_file import read_cell
from monocell.core.picture.synthetic import Ball, Photographer, photograph
from synthetic_cell import LENS, PLACES, POSE, RADIUS

CALIBRATE = ("calibrate", "cell.cell.json")


@pytest.fixture
def told(run):
    """The JSON of a calibration."""

    def check(*arguments):
        code, out, err = run(*arguments, "--json")
        assert code == 0, err
        return json.loads(out)

    return check


def test_people_get_short_lines_with_what_they_ask_for(run):
    code, out, err = run(*CALIBRATE, "--advise")
    assert (code, err) == (0, "")
    lines = out.splitlines()
    assert max(map(len, lines)) <= 100
    assert len(lines) < 40
    for said in (
        "1 sigma (",
        "95 % within",
        "a point on floor is known to",
        "off a line",
        "next: ",
    ):
        assert said in out
    assert lines[-1] == "verdict   good"


def test_the_truth_lies_inside_the_ellipsoid_told(told):
    numbers = told(*CALIBRATE)
    off = np.array(numbers["center_world"]) - POSE.inverse().translation
    position = numbers["ellipsoid_95"]["position"]
    along = np.array(position["directions_world"]) @ off / position["semi_axes"]
    assert np.linalg.norm(along) < 1
    sigmas = np.array(position["semi_axes"]) / numbers["ellipsoid_95"]["sigmas"]
    assert np.linalg.norm(sigmas) == pytest.approx(np.linalg.norm(numbers["center_sigma"]))
    assert numbers["ellipsoid_95"]["degrees_of_freedom"] == 3 * len(PLACES) - 7
    assert len(numbers["ellipsoid_95"]["rotation"]["semi_axes_degrees"]) == 3


def test_json_has_the_surface_the_span_and_what_each_sighting_does(told):
    numbers = told(*CALIBRATE)
    surface = numbers["surface"]
    assert (surface["name"], np.shape(surface["grid_sigma"])) == ("floor", (5, 5))
    assert surface["work_area"].startswith("where things stand (")
    assert 0 < surface["sigma_at_work"] < surface["sigma_median"] < surface["sigma_worst"]
    depths = POSE.apply(PLACES)
    assert numbers["positions"]["nearest"] == pytest.approx(
        np.linalg.norm(depths, axis=1).min(), abs=0.01
    )
    seen = LENS.project(depths)
    assert numbers["positions"]["share_of_width"] == pytest.approx(
        np.ptp(seen[:, 0]) / 480, abs=0.01
    )
    for sighting in numbers["sightings"]:
        assert len(sighting["left_out"]["center_moves"]) == 3
        assert sighting["left_out"]["sigmas"] > 0
        assert sighting["left_out"]["position_sigma"] > np.linalg.norm(numbers["center_sigma"])
    assert numbers["advice"] is None


def test_without_references_the_ground_is_the_surface_and_another_can_be_named(told, job):
    def spoil(document):
        document["references"], document["objects"] = [], []

    name = edited(job, spoil)
    ground, raised = told("calibrate", name), told("calibrate", name, "--surface", "z=0.2")
    assert ground["surface"]["name"] == "z = 0 m"
    assert ground["surface"]["work_area"] == "over all that is seen"
    assert raised["surface"]["name"] == "z = 0.2 m"
    assert raised["surface"]["sigma_median"] < ground["surface"]["sigma_median"]


def test_a_surface_out_of_sight_is_told_and_spoils_nothing(run, told):
    assert told(*CALIBRATE, "--surface", "z=3")["surface"] is None
    code, out, _ = run(*CALIBRATE, "--surface", "z=3")
    assert code == 0
    assert "the picture shows nothing of z = 3 m; --surface names another" in out


def test_the_sigma_map_is_a_picture_over_the_cell_s_own(run, job):
    assert run(*CALIBRATE, "--sigma-map", "map.png")[0] == 0
    drawn, given = cv2.imread(str(job / "map.png")), cv2.imread(str(job / "pose_0.png"))
    assert drawn.shape[1] == given.shape[1]
    assert drawn.shape[0] > given.shape[0]
    assert (np.ptp(drawn.astype(int), axis=2) > 25).mean() > 0.5


def test_the_sigma_map_of_a_16_bit_picture(run, job):
    wide = cv2.imread(str(job / "pose_0.png")).astype(np.uint16) * 257
    cv2.imwrite(str(job / "pose_0.png"), wide)
    assert run(*CALIBRATE, "--sigma-map", "map.jpg")[0] == 0
    assert (job / "map.jpg").stat().st_size > 1000


def test_advice_comes_from_a_box_or_a_list(told, job):
    box = told(*CALIBRATE, "--advise-box", 0, -0.3, 0.1, 0.4, 0.3, 0.5)["advice"]
    assert box["tried"] == 567
    for step in box["next"]:
        assert (np.array(step["center"]) >= [0, -0.3, 0.1]).all()
        assert (np.array(step["center"]) <= [0.4, 0.3, 0.5]).all()
    assert box["sigma"] > box["next"][0]["sigma"] > box["next"][1]["sigma"]
    (job / "reach.json").write_text("[[0.2, 0.0, 0.3], [0.4, 0.1, 0.15]]")
    (job / "reach.csv").write_text("x,y,z\n0.2,0.0,0.3\n\n0.4,0.1,0.15\n")
    (job / "plain.csv").write_text("0.2,0.0,0.3\n0.4,0.1,0.15")
    answers = [
        told(*CALIBRATE, "--advise-from", name)["advice"]
        for name in ("reach.json", "reach.csv", "plain.csv")
    ]
    assert answers[0] == answers[1] == answers[2]
    assert (answers[0]["tried"], len(answers[0]["next"])) == (2, 2)


def test_following_the_advice_gains_what_it_promised(told, job):
    before = told(*CALIBRATE, "--advise")["advice"]
    place = before["next"][0]["center"]
    picture = photograph(
        LENS, (Ball(tuple(POSE.apply(place)), RADIUS),), Photographer(seed=9, supersampling=4)
    )
    cv2.imwrite(str(job / "next.png"), picture)

    def followed(document):
        document["sightings"].append({"picture": "next.png", "center": place, "radius": RADIUS})

    after = told("calibrate", edited(job, followed))["surface"]["sigma_at_work"]
    assert after < before["sigma"]
    assert after == pytest.approx(before["next"][0]["sigma"], rel=0.35)


def held_along_a_line(job, pictures):
    """Four balls beside a line and one off it, in noisy pictures of the names given."""
    line = [[0.0, -0.3, 0.2], [0.06, -0.1, 0.22], [0.1, 0.1, 0.19], [0.17, 0.3, 0.2]]
    places = [*line, [0.05, 0.0, 0.5]]
    for name in set(pictures):
        shown = [p for p, picture in zip(places, pictures, strict=True) if picture == name]
        balls = tuple(Ball(tuple(POSE.apply(place)), RADIUS) for place in shown)
        how = Photographer(noise_grey_levels=6.0, seed=4, supersampling=4)
        cv2.imwrite(str(job / name), photograph(LENS, balls, how))

    def spoil(document):
        document["sightings"] = []
        for name, place in zip(pictures, places, strict=True):
            u, v = LENS.project(POSE.apply(place)[None])[0]
            window = [u - 30, v - 30, 60, 60]
            document["sightings"].append(
                {"picture": name, "center": place, "radius": RADIUS, "window": window}
            )

    return edited(job, spoil)


@pytest.mark.parametrize(
    ("pictures", "named"),
    [
        ([f"row_{i}.png" for i in range(5)], r"row_\d\.png"),
        # several balls in one picture are told apart by their places
        (["row.png"] * 5, r"row\.png at \[[-\d., ]+\]"),
    ],
)
def test_the_sighting_that_the_pose_hangs_on_is_named(run, job, monkeypatch, pictures, named):
    # so low that one of any five counts
    monkeypatch.setattr(leave_one_out, "HANGS_SIGMAS", 0.5)
    code, _, err = run("calibrate", held_along_a_line(job, pictures))
    assert code == 0
    assert re.match(
        rf"warning: the pose hangs on {named}: without it the camera moves by [\d.]+ mm and [\d.]+ "
        r"deg, [\d.]+ of its sigmas, and its position is known to [\d.]+ mm instead of [\d.]+",
        err,
    ), err


def test_many_sightings_are_not_all_listed(run, job):
    def many(document):
        document["sightings"] *= 4

    code, out, _ = run("calibrate", edited(job, many))
    assert code == 0
    # the sightings repeated count once
    assert "and 8 more: 8 rejected; --json has all" in out
    rows = [line.split() for line in out.splitlines() if line.startswith("pose_")]
    assert sum(row[1] == "used" for row in rows) == 5
    assert sum(row[1] == "rejected" for row in rows) == 7


@pytest.mark.parametrize(
    ("arguments", "why"),
    [
        (("--surface", "roof"), "no plane is called 'roof'; there is floor; or write z=0.1"),
        (("--surface", "z=high"), "'z=high' has no number"),
        (("--surface", "z=nan"), "must be finite"),
        (("--surface", "z=3", "--advise"), "shows nothing of z = 3 m"),
        (("--surface", "z=3", "--sigma-map", "m.png"), "shows nothing of z = 3 m"),
        (("--sigma-map", "map.txt"), "a picture ends in"),
        (("--sigma-map", "pose_0.png"), "would replace a picture of the cell"),
        (("--sigma-map", "no/map.png"), "the folder no is not there"),
        (("--advise-from", "gone.csv"), "there is no such file"),
        (("--advise-from", "gone.json"), "there is no such file"),
        (("--advise-from", "lens.json"), "positions: expected a list"),
        (("--advise-from", "pose_0.png"), "positions come as .json or .csv"),
        (("--advise-box", 1, 1, 1, 1, 1, 1), "both corners are the same"),
        (("--advise-box", 9, 9, 9, 10, 10, 10), "none of the 567 positions"),
        (("--advise", "--method", "pnp"), "the baseline pnp states no error"),
        (("--sigma-map", "m.png", "--method", "p3p"), "the baseline p3p states no error"),
    ],
)
def test_what_can_t_be_told_is_refused_and_nothing_written(refused, arguments, why):
    assert why in refused(*CALIBRATE, "--out", "new.json", *arguments)


@pytest.mark.parametrize(
    ("content", "why"),
    [
        ("x,y,z\n0.1,0.2\n", "row 2: expected x, y, z in metres, got '0.1, 0.2'"),
        ("0.1;0.2;0.3\n", "row 1: expected x, y, z in metres, got '0.1;0.2;0.3'"),
        ("0.1,nan,0.3\n", "row 1: expected x, y, z"),
        ("x,y,z\n", "holds no positions"),
        ("100,200,300\n", "give others, in metres"),
    ],
)
def test_a_list_that_is_none_is_refused_by_row(refused, job, content, why):
    (job / "list.csv").write_text(content)
    assert why in refused(*CALIBRATE, "--advise-from", "list.csv")


def test_a_calibration_that_failed_gives_no_map_and_no_advice(run, job):
    def mirrored(document):
        for sighting, place in zip(document["sightings"], PLACES, strict=True):
            sighting["center"] = (place * [1, -1, 1]).tolist()

    code, out, err = run("calibrate", edited(job, mirrored), "--advise", "--sigma-map", "m.png")
    assert code == 3
    assert "next:" not in out
    assert "no map and no advice from a calibration that failed" in err
    assert not (job / "m.png").exists()


def test_a_baseline_tells_what_it_knows(run, told):
    assert told(*CALIBRATE, "--method", "pnp")["ellipsoid_95"] is None
    code, out, _ = run(*CALIBRATE, "--method", "pnp")
    assert code == 0
    assert "unknown: the baseline pnp states none" in out
    assert "95 %" not in out


def test_the_map_does_not_change_the_cell_written(run, job):
    run(*CALIBRATE, "--out", "a.cell.json")
    run(*CALIBRATE, "--out", "b.cell.json", "--sigma-map", "map.png", "--advise")
    one, other = read_cell(job / "a.cell.json"), read_cell(job / "b.cell.json")
    np.testing.assert_array_equal(one.camera.covariance, other.camera.covariance)
