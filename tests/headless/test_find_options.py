# SPDX-License-Identifier: GPL-3.0-or-later
"""`monocell find` with what a person knows of the ball, and its refusals of what can't be."""

from __future__ import annotations

import json

import cv2
import numpy as np
import pytest
from monocell.core.camera import Camera
from monocell.core.document.cell_file import read_cell, write_cell
from monocell.core.picture.pictures import linear_light
from monocell.core.picture.synthetic import Ball, Photographer, photograph
from synthetic_cell import LENS, PLACES, POSE, RADIUS

BY_CAMERA = ("--camera", "lens.json", "--radius", RADIUS)
# where a camera that sees the held ball stands and looks, from the ball
EYE, BESIDE = np.array([1.2, -0.5, 0.4]), np.array([0.0, 0.1, 0.05])
BY_POSE = ("--near-pose", "truth.cell.json", "--radius", RADIUS)


def centre(place):
    return POSE.apply(PLACES[place])


@pytest.fixture
def found(run):
    """Run find with --json; the parsed answer and what stands on stderr."""

    def parsed(*arguments, code=0):
        done, out, err = run("find", *arguments, "--json")
        assert done == code, err
        return json.loads(out), err

    return parsed


def is_at(ball, place):
    assert np.linalg.norm(np.array(ball["center_camera"]) - centre(place)) < 0.008


def picture_of_all(job):
    balls = tuple(Ball(tuple(centre(i)), RADIUS) for i in range(len(PLACES)))
    cv2.imwrite(str(job / "all.png"), photograph(LENS, balls, Photographer(seed=5)))
    return "all.png"


@pytest.mark.parametrize(
    "hints",
    [
        ("--rough-radius", 17),
        ("--color", "orange"),
        ("--color", 230, 150, 80),
        ("--background", "pose_3.png"),
        ("--window", 60, 190, 110, 110),
    ],
)
def test_each_hint_alone_leads_to_the_ball(found, hints):
    ball, err = found("pose_0.png", *BY_CAMERA, *hints)
    is_at(ball, 0)
    assert err == ""


def test_all_balls_are_listed_and_too_few_are_told(found, run, job):
    picture = picture_of_all(job)
    balls, _ = found(picture, *BY_CAMERA, "--count", "all")
    assert len(balls["balls"]) == len(PLACES)
    code, out, err = run("find", picture, *BY_CAMERA, "--count", 7)
    assert code == 3
    assert out.count("ball at") == len(PLACES)
    assert "5 of 7 balls were found" in err


def test_a_near_pose_tells_the_balls_of_one_picture_apart(found, job):
    cell = read_cell(job / "truth.cell.json")
    rough = Camera(LENS, POSE.perturbed([0.005, -0.004, 0.004, 0.004, 0.003, 0.01]))
    write_cell(cell.with_camera(rough), job / "near.cell.json")
    picture = picture_of_all(job)
    for place, position in enumerate(PLACES):
        arguments = ("--center", *position, "--within", 20)
        ball, err = found(picture, "--near-pose", "near.cell.json", *BY_POSE[2:], *arguments)
        is_at(ball, place)
        assert err == ""


def test_the_sighting_of_the_picture_says_where_the_ball_is(found):
    is_at(found("pose_2.png", *BY_POSE)[0], 2)


def test_a_ball_beside_its_prediction_is_doubted(found):
    moved = PLACES[1] + [0.0, 0.0, 0.04]
    ball, err = found("pose_1.png", *BY_POSE, "--center", *moved, "--within", 15)
    is_at(ball, 1)
    assert "mm aside of where the pose puts it, 15 mm were expected at most" in err


def test_a_cell_in_place_of_a_picture_lists_its_sightings(found, run, job):
    cv2.imwrite(str(job / "pose_3.png"), np.full((360, 480, 3), 80, np.uint8))
    answer, err = found("truth.cell.json", code=3)
    seen = answer["sightings"]
    assert [s["picture"] for s in seen] == [f"pose_{i}.png" for i in range(5)]
    assert seen[3]["ball"] is None
    assert "pose_3.png: no ball found" in err
    is_at(seen[4]["ball"], 4)
    assert seen[4]["aside"] < 1e-3
    code, out, _ = run("find", "truth.cell.json")
    assert code == 3
    assert "not found" in out


def test_the_vote_stands_beside_the_outline(found, run):
    answer, _ = found("pose_0.png", *BY_CAMERA, "--method", "vote")
    is_at(answer, 0)
    assert answer["vote"]["aside_pixels"] < 1
    assert abs(answer["vote"]["deeper"]) < 0.05
    assert "px aside of the outline's" in run("find", "pose_0.png", *BY_POSE, "--method", "vote")[1]


def test_linear_pixels_give_the_same_ball(found, job):
    light = linear_light(cv2.imread(str(job / "pose_1.png")))
    cv2.imwrite(str(job / "raw.png"), np.rint(light * 65535).astype(np.uint16))
    plain, _ = found("pose_1.png", *BY_CAMERA)
    raw, _ = found("raw.png", *BY_CAMERA, "--linear")
    np.testing.assert_allclose(raw["center_camera"], plain["center_camera"], rtol=2e-3)


@pytest.mark.robot
def test_joint_angles_say_where_the_ball_is(found, job):
    from monocell.headless.robot.arm import Arm

    joints, offset = (0.3, 0.5, 0.0, -1.4, 0.0, 1.1, 0.0), np.array([0.0, 0.0, 0.12])
    with Arm() as arm:
        place = arm.world_from_flange(joints).apply(offset)
    pose = POSE.looking_at(place + EYE, place + BESIDE, [0, 0, 1])
    write_cell(read_cell(job / "lens.json").with_camera(Camera(LENS, pose)), job / "arm.cell.json")
    ball = Ball(tuple(pose.apply(place)), RADIUS)
    cv2.imwrite(str(job / "held.png"), photograph(LENS, (ball,), Photographer(seed=3)))
    answer, err = found(
        "held.png", "--near-pose", "arm.cell.json", "--radius", RADIUS, "--within", 10,
        "--joints", *joints, "--offset", *offset,
    )  # fmt: skip
    assert np.linalg.norm(np.array(answer["center_camera"]) - pose.apply(place)) < 0.008
    assert err == ""


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("pose_0.png", "--radius", RADIUS), "--camera is missing"),
        (("pose_0.png", "--camera", "lens.json"), "--radius is missing"),
        (("pose_0.png", *BY_CAMERA, "--rough-radius", 2), "2 px is too small"),
        (("pose_0.png", *BY_CAMERA, "--rough-radius", 90), "of about 90 px radius stands out"),
        (("pose_0.png", *BY_CAMERA, "--color", "mauve"), "'mauve' is unknown"),
        (("pose_0.png", *BY_CAMERA, "--color", 0, 0, 999), "color: 0 0 999 is none"),
        (("pose_0.png", *BY_CAMERA, "--background", "gone.png"), "no such picture"),
        (("pose_0.png", *BY_CAMERA, "--background", "pose_0.png"), "is the picture itself"),
        (("pose_0.png", *BY_CAMERA, "--count", 0), "neither a number above zero nor all"),
        (("pose_0.png", *BY_CAMERA, "--joints", 1, 2), "--joints needs --near-pose"),
        (("pose_0.png", *BY_CAMERA, "--within", 2), "--within needs --near-pose"),
        (("pose_0.png", *BY_CAMERA, "--offset", 0, 0, 1), "--offset needs --joints"),
        (("pose_0.png", *BY_POSE, "--window", 1, 2, 90, 90), "both say where to look"),
        (("pose_0.png", *BY_POSE, "--center", 0, 0, 0, "--joints", 1), "both say where the ball"),
        (("pose_0.png", *BY_POSE, "--within", 0), "--within: must be above zero"),
        (("pose_0.png", *BY_POSE, "--center", 9, 0, 0), "z = -"),
        (("pose_0.png", "--near-pose", "cell.cell.json", "--radius", RADIUS), "no pose yet"),
        (("truth.cell.json", "--radius", RADIUS), "--radius does not go with a cell document"),
        (("truth.cell.json", "--method", "vote"), "goes with one picture"),
        (("lens.json",), "the cell has no sightings"),
    ],
)
def test_arguments_that_can_t_be_are_refused(refused, arguments, told):
    assert told in refused("find", *arguments)


def test_a_picture_that_the_near_cell_does_not_have_is_refused(refused, job):
    told = refused("find", picture_of_all(job), *BY_POSE)
    assert "none of its 5 sightings is of all.png" in told


def test_a_cell_without_any_ball_is_refused(refused, job):
    for i in range(5):
        cv2.imwrite(str(job / f"pose_{i}.png"), np.full((360, 480, 3), 80, np.uint8))
    assert "found in none of 5 sightings; pose_0.png" in refused("find", "truth.cell.json")


def test_a_background_that_is_the_same_picture_under_another_name_is_refused(refused, job):
    (job / "copy.png").write_bytes((job / "pose_0.png").read_bytes())
    told = refused("find", "pose_0.png", *BY_CAMERA, "--background", "copy.png")
    assert "does not differ from it" in told


def test_a_radius_in_millimetres_is_asked_about(found):
    _, err = found("pose_0.png", "--camera", "lens.json", "--radius", 40)
    assert "a ball of radius 40 m would be 16" in err
    assert "is the radius in metres?" in err
