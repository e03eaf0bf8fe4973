# SPDX-License-Identifier: GPL-3.0-or-later
"""`monocell calibrate` with offsets, clicks and a camera on the flange, and its refusals."""

from __future__ import annotations

import json

import numpy as np
import pytest
from edited_job import edited
from monocell.core import Pose
from monocell.core.document.entries import pose_entry
from synthetic_cell import LENS, PLACES, POSE

OFFSET = np.array([0.03, -0.02, 0.12])
TURNS = [[0.4, 0, 0], [0, 0.5, 0.2], [-0.5, 0.1, 0], [0, -0.4, -0.3], [0.3, 0.4, 0.9]]
# from the flange that carries a ball at OFFSET in each of the job's pictures
FLANGES = [
    Pose(turn.rotation, place - turn.rotation @ OFFSET)
    for turn, place in zip(
        (Pose.from_rotation_vector(t, [0, 0, 0]) for t in TURNS), PLACES, strict=True
    )
]
SEAT = Pose.from_rotation_vector([0.1, -0.2, 0.3], [0.02, 0.05, -0.04])


def on_the_flange(document):
    for sighting, flange in zip(document["sightings"], FLANGES, strict=True):
        del sighting["center"]
        sighting["world_from_flange"] = pose_entry(flange)


def mounted(document):
    """The same pictures as a camera on the flange would have taken them of a ball that stays."""
    document["mount"] = {"on": "flange"}
    for sighting, place in zip(document["sightings"], PLACES, strict=True):
        # the camera stood so that the ball at PLACES[0] shows where that at `place` did
        camera_from_world = POSE @ Pose(np.eye(3), place - PLACES[0])
        sighting["world_from_flange"] = pose_entry(camera_from_world.inverse() @ SEAT)
        sighting["center"] = PLACES[0].tolist()


def told_json(out):
    return json.loads(out)


def test_an_offset_in_the_flange_is_solved_and_told(run, job):
    name = edited(job, on_the_flange)
    code, out, _ = run("calibrate", name)
    assert code == 0
    assert "solved     the offset in the flange is at (0.0" in out
    _, out, _ = run("calibrate", name, "--json")
    solved = told_json(out)
    np.testing.assert_allclose(solved["offsets"][0]["offset"], OFFSET, atol=0.01)
    np.testing.assert_allclose(solved["sightings"][1]["center"], PLACES[1], atol=0.01)


def test_a_camera_on_the_flange_is_written_under_its_own_name(run, job):
    name = edited(job, mounted)
    code, out, err = run("calibrate", name, "--out", "done.cell.json")
    assert code == 0, err
    assert "mounted    on the flange" in out
    assert "mount.world_from_flange of the cell's picture is missing" in err
    done = json.loads((job / "done.cell.json").read_text())
    assert "camera_from_world" not in done["camera"]
    np.testing.assert_allclose(
        done["mount"]["camera_from_flange"]["translation"], SEAT.translation, atol=0.02
    )
    assert np.array(done["mount"]["covariance"]).shape == (6, 6)


def test_a_mounted_cell_with_its_picture_s_flange_can_be_modelled(run, job):
    def with_picture(document):
        mounted(document)
        document["mount"]["world_from_flange"] = document["sightings"][0]["world_from_flange"]

    name = edited(job, with_picture)
    assert run("calibrate", name, "--out", "done.cell.json")[0] == 0
    code, out, _ = run("model", "done.cell.json")
    assert code == 0
    assert "block" in out


def test_clicks_stand_in_for_balls(run, job):
    def clicked(document):
        for sighting, place in list(zip(document["sightings"], PLACES, strict=True))[:3]:
            del sighting["radius"]
            sighting["pixel"] = LENS.project(POSE.apply(place)[None])[0].tolist()

    code, out, _ = run("calibrate", edited(job, clicked))
    assert code == 0
    assert "camera     at (1.5" in out or "camera     at (1.4" in out


def test_a_refined_radius_is_told_and_written(run, job):
    def swollen(document):
        for sighting in document["sightings"]:
            sighting["radius"] = 0.042

    name = edited(job, swollen)
    _, _, err = run("calibrate", name)
    assert "the ball's radius seems to be" in err
    code, out, _ = run("calibrate", name, "--refine", "radius", "--out", "done.cell.json")
    assert code == 0
    assert "refined    radius -4." in out
    done = json.loads((job / "done.cell.json").read_text())
    assert done["sightings"][0]["radius"] == pytest.approx(0.04, rel=0.01)


def test_what_these_sightings_can_not_tell_is_refused(refused, job):
    def three(document):
        document["sightings"] = document["sightings"][:3]

    told = refused("calibrate", edited(job, three), "--refine", "focal", "--refine", "radius")
    assert "would be known" in told
    assert "add sightings" in told


def test_a_baseline_refines_nothing(refused):
    told = refused("calibrate", "cell.cell.json", "--refine", "focal", "--method", "pnp")
    assert "the baseline pnp refines nothing" in told


def test_an_offset_without_turning_the_flange_is_refused(refused, job):
    def straight(document):
        on_the_flange(document)
        for sighting in document["sightings"]:
            sighting["world_from_flange"]["rotation"] = np.eye(3).tolist()

    told = refused("calibrate", edited(job, straight))
    assert "the flange turned by only 0.0 deg about a second axis" in told


def test_an_unknown_offset_has_no_baseline(refused, job):
    told = refused("calibrate", edited(job, on_the_flange), "--method", "pnp")
    assert "an offset is unknown; give center, or use the method joint" in told


def test_three_clicks_are_refused_with_the_poses_that_fit(refused, job):
    def three(document):
        document["sightings"] = [
            {"picture": s["picture"], "center": s["center"],
             "pixel": LENS.project(POSE.apply(p)[None])[0].tolist()}
            for s, p in zip(document["sightings"][:3], PLACES, strict=False)
        ]  # fmt: skip

    told = refused("calibrate", edited(job, three))
    assert "poses fit the 3 sightings equally well, with the camera at (" in told


def test_rendering_refuses_what_it_can_not_hold(refused, job):
    def flanged(document):
        on_the_flange(document)
        document["camera"]["camera_from_world"] = pose_entry(POSE)

    told = refused("render", edited(job, flanged), "out")
    assert "sightings[0]: only balls at known places are rendered" in told
