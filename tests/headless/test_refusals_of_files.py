# SPDX-License-Identifier: GPL-3.0-or-later
"""What would cost a file, or can't be one, is refused before anything is touched."""

from __future__ import annotations

import pytest
from edited_job import edited
from synthetic_cell import RADIUS

FIND = ("find", "pose_0.png", "--camera", "lens.json", "--radius", RADIUS)


@pytest.mark.parametrize("name", ["a\0b.png", "\ud800.png"])
def test_a_name_that_no_file_can_have(refused, job, name):
    told = refused(
        "calibrate", edited(job, lambda d: d["sightings"][0].__setitem__("picture", name))
    )
    assert "sightings[0].picture" in told


@pytest.mark.parametrize("radius", [1e-9, 1e300])
def test_a_radius_of_no_ball(refused, job, radius):
    told = refused(
        "calibrate", edited(job, lambda d: d["sightings"][2].__setitem__("radius", radius))
    )
    assert "sightings[2]" in told and f"{radius:g} m" in told


def test_a_lens_with_impossible_coefficients(refused, job):
    def spoil(document):
        wild = {"model": "plumb_bob", "coefficients": [1e300, 0, 0, 0, 0]}
        document["camera"]["distortion"] = wild

    assert "distortion.coefficients: 1e+300" in refused("calibrate", edited(job, spoil))


def test_a_document_is_not_written_over_a_picture(refused):
    told = refused("calibrate", "cell.cell.json", "--out", "pose_0.png")
    assert "ends in .json" in told


def test_an_overlay_is_not_written_over_its_picture(refused):
    assert "would replace" in refused(*FIND, "--overlay", "pose_0.png")


def test_rendering_over_the_cell_s_own_pictures(refused):
    assert "own folder" in refused("render", "truth.cell.json", ".")


def test_rendering_two_pictures_of_one_name(refused, job):
    def share(document):
        document["picture"] = "cell.png"
        document["sightings"][1]["picture"] = "elsewhere/pose_0.jpg"

    told = refused("render", edited(job, share, "truth.cell.json"), "out")
    assert "pose_0.png: 2 pictures" in told


@pytest.mark.blender
def test_a_folder_that_can_not_be_made(refused, job):
    own = edited(job, lambda d: d.__setitem__("picture", "cell.png"), "truth.cell.json")
    assert "can't be made a folder" in refused("render", own, "lens.json")
    assert "can't be made a folder" in refused("demo", "lens.json")


@pytest.mark.parametrize("seed", ["-1", "1.5", str(2**40)])
def test_a_seed_that_is_none(run, seed):
    code, out, err = run("robot", "any.glb", f"--seed={seed}")
    assert (code, out) == (2, "")
    assert "--seed" in err and seed in err


def test_a_robot_picture_that_would_replace_the_environment(refused, job):
    (job / "cell.glb").write_bytes(b"precious")
    assert "name it .png" in refused("robot", "cell.glb", "--picture", "cell.glb")
