# SPDX-License-Identifier: GPL-3.0-or-later
"""Whatever a user gets wrong ends with code 2 and one line, and leaves every file as it was."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from edited_job import edited, state_of
from monocell.core.picture.synthetic import Ball, Photographer, photograph
from synthetic_cell import LENS, RADIUS

FIND = ("find", "pose_0.png", "--camera", "lens.json", "--radius", RADIUS)


def test_a_refusal_looks_the_same_from_a_process(shell):
    code, out, err = shell("find", "gone.png", "--camera", "lens.json", "--radius", "0.04")
    assert (code, out) == (2, "")
    assert err == "monocell find: gone.png: there is no such picture\n"


@pytest.mark.parametrize("ending", [".png", ".jpg"])
def test_a_truncated_picture(shell, refused, job, ending):
    whole = cv2.imencode(ending, cv2.imread(str(job / "pose_0.png")))[1].tobytes()
    (job / f"half{ending}").write_bytes(whole[: len(whole) // 2])
    told = refused("find", f"half{ending}", *FIND[2:])
    assert f"half{ending}: the picture breaks off after {len(whole) // 2} bytes" in told
    code, _, err = shell("find", f"half{ending}", *FIND[2:])
    assert (code, err) == (2, told)


def test_a_picture_of_another_size(refused, job):
    cv2.imwrite(str(job / "small.png"), np.zeros((100, 200, 3), np.uint8))
    told = refused("find", "small.png", *FIND[2:])
    assert "200 x 100 px, the camera file says 480 x 360" in told


def test_a_folder_for_a_picture(refused, job):
    (job / "pictures").mkdir()
    assert "pictures" in refused("find", "pictures", *FIND[2:])


@pytest.mark.parametrize("verb", ["calibrate", "model", "compare", "render", "export"])
@pytest.mark.parametrize(
    ("content", "told"),
    [
        ("{", "bad.json: is not JSON"),
        ("", "bad.json: is not JSON"),
        ('{"monocell": 1}', "bad.json: camera: is missing"),
        ('{"monocell": 1, "camera": {}, "colour": 1}', "bad.json: colour: unknown key"),
        ('{"monocell": 1, "camera": {"width": "x"}}', "bad.json: camera.height: is missing"),
        ("\x00\x01", "bad.json: is not JSON"),
    ],
)
def test_a_malformed_document(refused, job, verb, content, told):
    (job / "bad.json").write_text(content)
    more = {"compare": ["cell.cell.json"], "render": ["out"], "export": ["out.glb"]}.get(verb, [])
    assert told in refused(verb, "bad.json", *more)
    assert not (job / "out").exists()


@pytest.mark.parametrize("verb", ["calibrate", "model"])
def test_a_missing_document(refused, verb):
    assert "gone.json: there is no such file" in refused(verb, "gone.json")


@pytest.mark.parametrize("radius", ["0", "-0.04", "nan", "inf"])
def test_an_impossible_radius(refused, radius):
    assert "radius" in refused(*FIND[:-1], radius)


def test_a_window_too_small_or_outside(refused):
    assert "5 x 5 px is too small" in refused(*FIND, "--window", 10, 10, 5, 5)
    assert "leaves 0 x 60 px" in refused(*FIND, "--window", 700, 10, 60, 60)
    assert "window" in refused(*FIND, "--window", "nan", 10, 60, 60)


def test_an_impossible_radius_in_the_document(refused, job):
    def spoil(document):
        document["sightings"][1]["radius"] = -0.04

    assert "sightings[1]: radius: must be above zero, got -0.04" in refused(
        "calibrate", edited(job, spoil)
    )


@pytest.mark.parametrize("count", [0, 1, 2])
def test_fewer_than_three_sightings(refused, job, count):
    def spoil(document):
        document["sightings"] = document["sightings"][:count]

    assert f"{count}; add sightings" in refused("calibrate", edited(job, spoil), "--out", "x.json")


def test_positions_on_one_line(refused, job):
    def spoil(document):
        for i, sighting in enumerate(document["sightings"]):
            sighting["center"] = [0.1 * i, 0.0, 0.2]

    told = refused("calibrate", edited(job, spoil), "--out", "cell.cell.json")
    assert "mm of a line 400 mm long" in told
    assert "deg about it" in told


def test_a_sighting_s_picture_that_is_gone(refused, job):
    (job / "pose_3.png").unlink()
    assert "pose_3.png: there is no such picture" in refused("calibrate", "cell.cell.json")


def test_a_blank_picture_has_no_ball(refused, job):
    cv2.imwrite(str(job / "blank.png"), np.full((360, 480, 3), 80, np.uint8))
    told = refused("find", "blank.png", *FIND[2:], "--overlay", "pose_1.png")
    assert "no ball found in the picture" in told


def test_blank_pictures_calibrate_nothing(refused, job):
    for i in range(5):
        cv2.imwrite(str(job / f"pose_{i}.png"), np.full((360, 480, 3), 80, np.uint8))
    assert "found in 0 of 5 sightings" in refused("calibrate", "cell.cell.json")


def test_a_ball_cut_by_the_border(refused, job):
    ray = LENS.rays(np.array([[3.0, 180.0]]))[0]
    picture = photograph(LENS, (Ball(tuple(1.2 * ray), RADIUS),), Photographer(supersampling=4))
    cv2.imwrite(str(job / "cut.png"), picture)
    assert "no ball found" in refused("find", "cut.png", *FIND[2:])


def test_a_pick_above_the_horizon(refused, job, run):
    run("calibrate", "cell.cell.json", "--out", "placed.cell.json")

    def spoil(document):
        document["objects"][1]["picks"]["rim"][1] = [240.0, -170.0]

    told = refused("model", edited(job, spoil, "placed.cell.json"), "--out", "placed.cell.json")
    assert "drum: rim[1] at (240.0, -170.0)" in told
    assert "above the horizon of floor" in told


def test_picks_before_calibration(refused):
    assert "calibrate it" in refused("model", "cell.cell.json")


def test_a_cell_without_picks(refused):
    assert "nothing to model" in refused("model", "truth.cell.json")


@pytest.mark.parametrize("sigma", ["0", "-1", "nan"])
def test_an_impossible_pick_sigma(refused, run, sigma):
    run("calibrate", "cell.cell.json", "--out", "placed.cell.json")
    assert "pick_sigma" in refused("model", "placed.cell.json", f"--pick-sigma={sigma}")


def test_an_out_folder_that_is_missing(refused):
    told = refused("calibrate", "cell.cell.json", "--out", "nowhere/a.json")
    assert "the folder nowhere is not there" in told
    assert "nowhere is not there" in refused(*FIND, "--overlay", "nowhere/a.png")


def test_an_out_that_is_a_folder(refused, job):
    (job / "taken.json").mkdir()
    assert "taken.json: is a folder" in refused(
        "calibrate", "cell.cell.json", "--out", "taken.json"
    )


def test_an_overlay_that_is_no_picture(refused):
    assert "a picture ends in" in refused(*FIND, "--overlay", "cell.cell.json")


def test_a_camera_file_that_is_none(refused, job):
    assert "gone.yaml: there is no such" in refused(
        "find", "pose_0.png", "--camera", "gone.yaml", "--radius", 0.04
    )
    (job / "bad.yml").write_text("%YAML:1.0\n---\nimage_width: [\n")
    assert "bad.yml" in refused("find", "pose_0.png", "--camera", "bad.yml", "--radius", 0.04)


def test_compare_with_another_kind(refused, job):
    def spoil(document):
        document["objects"][0]["name"], document["objects"][1]["name"] = "drum", "block"

    told = refused("compare", "truth.cell.json", edited(job, spoil, "truth.cell.json"))
    assert "in truth" in told


def test_an_ending_that_is_not_exported(refused):
    assert "no format ends in .dae; name it one of .glb" in refused(
        "export", "truth.cell.json", "out.dae"
    )


def test_rendering_without_a_pose_or_samples(refused):
    assert "calibrate it" in refused("render", "cell.cell.json", "out")
    assert "--samples: must be 1 or more" in refused(
        "render", "truth.cell.json", "out", "--samples", 0
    )


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["paint"], "invalid choice: 'paint'"),
        (["find", "pose_0.png", "--radius", "0.04"], "--camera"),
        (["find", "pose_0.png", "--camera", "lens.json"], "--radius"),
        (["find", "pose_0.png", "--camera", "lens.json", "--radius", "large"], "large"),
        ([*map(str, FIND), "--window", "1", "2"], "--window"),
        (["calibrate", "cell.cell.json", "--method", "guess"], "guess"),
        (["calibrate"], "cell"),
        (["compare", "truth.cell.json"], "cell"),
    ],
)
def test_wrong_arguments_end_with_2_and_say_what_is_wrong(run, job, arguments, told):
    before = state_of(job)
    code, out, err = run(*arguments)
    assert (code, out) == (2, "")
    assert err.count("\n") == 1, err
    assert told in err
    assert "--help" in err
    assert state_of(job) == before
