# SPDX-License-Identifier: GPL-3.0-or-later
"""`monocell map`: pixels to points with errors and doubts, or one line of refusal."""

from __future__ import annotations

import copy
import json

import numpy as np
import pytest
from edited_job import edited
from monocell.core import Camera
from monocell.core.document.cell_file import read_cell, write_cell
from synthetic_cell import BLOCK, LENS, POSE

CAMERA = Camera(LENS, POSE)
TOP = BLOCK.corners_world()[7]
SOURCES = [
    {"name": "lid", "kind": "plane", "from": {"way": "feature", "of": "block.top"}},
    {"name": "loft", "kind": "plane", "from": {"way": "parallel", "to": "lid", "distance": 0.1}},
    {
        "name": "post",
        "kind": "line",
        "from": {"way": "upright", "on": "floor", "pixels": CAMERA.project([[0.1, 0, 0]]).tolist()},
    },
]


def referenced(document):
    document["references"] += copy.deepcopy(SOURCES)


def known_to_a_millimetre(document):
    referenced(document)
    document["camera"]["covariance"] = (1e-6 * np.eye(6)).tolist()


def test_a_pixel_of_a_box_s_face_is_a_point_of_it(run, job):
    u, v = CAMERA.project(TOP[None])[0]
    name = edited(job, known_to_a_millimetre, "truth.cell.json")
    for on in ("block.top", "lid"):
        code, out, err = run("map", name, "--on", on, u, v, "--json")
        assert (code, err) == (0, "")
        told = json.loads(out)
        assert (told["reference"], told["kind"], told["warnings"]) == (on, "plane", [])
        np.testing.assert_allclose(told["points"][0]["point"], TOP, atol=1e-9)
        assert 5e-4 < max(told["points"][0]["sigma"]) < 1e-2


def test_people_get_a_line_for_every_pixel(run, job):
    pixels = CAMERA.project([[0.1, 0.0, 0.05], [0.1, 0.0, 0.2]]).ravel()
    code, out, err = run("map", edited(job, referenced, "truth.cell.json"), "--on", "post", *pixels)
    assert code == 0
    lines = out.splitlines()
    assert len(lines) == 4
    assert "(0.1000, 0.0000, 0.0500) m" in lines[2]
    assert "±" in lines[3]
    assert err == "warning: the camera's pose states no error: each ± leaves it out\n"


def test_pick_noise_scales_the_sigmas(run, job):
    name = edited(job, referenced, "truth.cell.json")
    sigmas = []
    for noise in (0.5, 1.0):
        _, out, _ = run("map", name, "--on", "loft", 240, 180, "--pick-sigma", noise, "--json")
        sigmas.append(json.loads(out)["points"][0]["sigma"])
    np.testing.assert_allclose(2 * np.array(sigmas[0]), sigmas[1])


def test_a_doubt_goes_to_stderr(run, job):
    name = edited(job, known_to_a_millimetre, "truth.cell.json")
    code, _, err = run("map", name, "--on", "post", 10, 180)
    assert code == 0
    assert "px beside the image of post; its point is the nearest one of the line" in err


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--on", "floor", 240], "1 numbers are no pixels; give U and V of each, such as 640 480"),
        (["--on", "floor", "nan", 3], "pixels: the number at (0, 0) is nan, not finite"),
        (["--on", "floor", 240, -900], "more than half a picture outside the 480 x 360 px picture"),
        (["--on", "floor", 240, -170], "above the horizon of floor; pick a point on floor"),
        (["--on", "flor", 240, 180], "nothing is called 'flor'; references are floor, lid, loft"),
        (["--on", "block.lid", 240, 180], "block: a box has no feature 'lid'; it has base, top"),
        (["--on", "block.centre", 240, 180], "block.centre: is a point, and a reference is a pl"),
        (["--on", "floor", 240, 180, "--pick-sigma", 0], "must be above zero, got 0"),
        (["--on", "floor", 240, 180, "--pick-sigma", "inf"], "must be finite, got inf"),
        ([240, 180], "the following arguments are required: --on"),
        (["--on", "floor"], "the following arguments are required"),
        (["--on", "floor", "a", "b"], "invalid float value: 'a'"),
    ],
)
def test_what_can_t_be_mapped_is_refused(refused, job, arguments, told):
    name = edited(job, referenced, "truth.cell.json")
    assert told in refused("map", name, *arguments)


def test_a_face_of_what_is_only_picked_waits_for_the_model(refused, job):
    def placed(document):
        referenced(document)
        document["camera"] = json.loads((job / "truth.cell.json").read_text())["camera"]

    name = edited(job, placed)
    for on in ("loft", "block.top"):
        told = refused("map", name, "--on", on, 240, 180)
        assert f"{on}: is made from block, picked and not solved yet; model the cell first" in told


def test_a_cell_that_is_not_calibrated_is_refused(refused, job):
    assert "the camera has no pose yet" in refused("map", "cell.cell.json", "--on", "floor", 9, 9)


def test_a_spoilt_source_is_refused_by_its_path(refused, job):
    def spoil(document):
        referenced(document)
        document["references"][2]["from"]["distance"] = "far"

    told = refused("map", edited(job, spoil, "truth.cell.json"), "--on", "floor", 9, 9)
    assert "references[2].from.distance: expected a number, got 'far'" in told


def test_references_travel_through_the_document(job):
    name = edited(job, referenced, "truth.cell.json")
    write_cell(read_cell(job / name), job / "again.cell.json")
    again = json.loads((job / "again.cell.json").read_text())
    assert again["references"][1:] == SOURCES
