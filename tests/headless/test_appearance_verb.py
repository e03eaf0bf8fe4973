# SPDX-License-Identifier: GPL-3.0-or-later
"""`monocell appearance` as a shell sees it: colours, textures, and every refusal."""

from __future__ import annotations

import json

import cv2
import numpy as np
import pytest
from edited_job import edited
from monocell.core.document.cell_file import read_cell
from monocell.core.shape.hits import seen_map

COLORS = ((30, 60, 200), (170, 90, 20))


@pytest.fixture
def photo(job):
    """A picture of the true objects, each in one colour (blue, green, red), faces apart."""
    truth = read_cell(job / "truth.cell.json")
    seen = seen_map(truth.objects, truth.camera)
    picture = np.full((*seen.owner.shape, 3), 90, np.uint8)
    for index, color in enumerate(COLORS):
        for face in range(6):
            picture[(seen.owner == index) & (seen.face == face)] = np.array(color) * (
                1 - 0.1 * face
            )
    cv2.imwrite(str(job / "pose_0.png"), picture)
    return picture


def test_every_object_gets_the_colour_it_has_in_the_picture(run, photo, job):
    code, out, err = run("appearance", "truth.cell.json", "--out", "seen.cell.json")
    assert (code, err) == (0, "")
    assert [line.split()[0] for line in out.splitlines()[2:]] == ["block", "drum"]
    block, drum = read_cell(job / "seen.cell.json").objects
    assert block.appearance.color.argmax() == 0
    assert drum.appearance.color.argmax() == 2
    assert not block.appearance.textures


def test_textures_are_told_face_by_face_and_stand_beside_the_document(run, photo, job):
    arguments = ("truth.cell.json", "--texture", "block", "--out", "seen.cell.json")
    code, out, err = run("appearance", *arguments)
    assert code == 0
    assert "top" in out.splitlines()[2]
    assert "block.base: no texture, it is turned away from the camera" in err
    textures = read_cell(job / "seen.cell.json").objects[0].appearance.textures
    assert all((job / texture.picture).is_file() for texture in textures.values())
    assert not read_cell(job / "seen.cell.json").objects[1].appearance.textures
    code, out, _ = run("appearance", *arguments, "--json")
    told = json.loads(out)
    assert told[0]["seen"] == {face: texture.seen for face, texture in textures.items()}
    assert told[0]["unseen"]["base"] == "it is turned away from the camera"


def test_all_or_only_some_are_looked_at(run, photo, job):
    arguments = ("appearance", "truth.cell.json", "--only", "drum", "--texture-all")
    code, out, _ = run(*arguments, "--out", "seen.cell.json")
    assert code == 0
    block, drum = read_cell(job / "seen.cell.json").objects
    assert block.appearance is None
    assert "side" in drum.appearance.textures
    assert len(out.splitlines()) == 3


def test_what_a_mask_hides_is_not_looked_at(run, photo, job):
    truth = read_cell(job / "truth.cell.json")
    hidden = seen_map(truth.objects, truth.camera).owner == 0
    cv2.imwrite(str(job / "arm.png"), hidden.astype(np.uint8) * 255)
    code, out, err = run("appearance", "truth.cell.json", "--hidden", "arm.png")
    assert code == 0
    assert "not seen" in out.splitlines()[2]
    assert "warning: block: is not seen in the picture" in err


def test_a_print_is_told_of(run, photo, job):
    cv2.imwrite(str(job / "pose_0.png"), np.where(np.indices((360, 480, 3))[1] % 8 < 4, photo, 20))
    _, out, err = run("appearance", "truth.cell.json")
    assert "uniform" in out
    assert "give it a texture" in err


def test_refusals_say_what_is_missing(refused, photo, job):
    verb = "appearance"
    assert "no solved object is called 'crate'; there is block, drum" in refused(
        verb, "truth.cell.json", "--only", "crate"
    )
    assert "name it with --out" in refused(verb, "truth.cell.json", "--texture", "block")
    assert "run monocell model first" in refused(
        verb, edited(job, lambda d: d["camera"].update(camera_from_world=pose_of(job)))
    )
    assert "picture: is missing" in refused(
        verb, edited(job, lambda d: d.pop("picture"), "truth.cell.json")
    )
    assert "there is no such picture" in refused(verb, "truth.cell.json", "--hidden", "gone.png")
    assert "has no pose yet" in refused(verb, "cell.cell.json")
    cv2.imwrite(str(job / "white.png"), np.full((360, 480), 255, np.uint8))
    assert "is white over 100 %" in refused(verb, "truth.cell.json", "--hidden", "white.png")
    cv2.imwrite(str(job / "small.png"), np.zeros((36, 48), np.uint8))
    assert "the mask is 48 x 36 px, the picture 480 x 360" in refused(
        verb, "truth.cell.json", "--hidden", "small.png"
    )
    cv2.imwrite(str(job / "pose_0.png"), np.zeros((36, 48, 3), np.uint8))
    assert "the picture is 48 x 36 px" in refused(verb, "truth.cell.json")


def test_a_folder_that_is_not_there_is_refused(refused, photo):
    arguments = ("truth.cell.json", "--texture", "block", "--out", "no/seen.cell.json")
    assert "the folder no is not there" in refused("appearance", *arguments)


def pose_of(job):
    return json.loads((job / "truth.cell.json").read_text())["camera"]["camera_from_world"]
