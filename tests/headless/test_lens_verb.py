# SPDX-License-Identifier: GPL-3.0-or-later
"""`monocell lens` from outside: a report, a camera file, pictures, and refusals of one line."""

from __future__ import annotations

import json

import cv2
import numpy as np
import pytest
from monocell.core import Distortion, Intrinsics, Pose
from monocell.core.document.camera_file import read_camera
from monocell.core.lens.board import Chessboard
from monocell.core.lens.synthetic_board import photograph_boards, scattered_poses

LENS = Intrinsics(480, 360, 400, 401, 243, 177, Distortion("plumb_bob", [-0.2, 0.05, 0, 0, 0]))
BOARD = Chessboard(7, 5, 0.03)
SAID = ("--board", "chessboard", "7x5", "0.03")


@pytest.fixture(scope="module")
def photos():
    """Eight pictures of the board, small to be quick."""
    poses = scattered_poses(LENS, BOARD, 8, np.random.default_rng(5))
    return photograph_boards(LENS, BOARD, poses)


@pytest.fixture
def boards(job, photos):
    """The job's folder with the pictures in `boards/`, and nothing else of a picture."""
    folder = job / "boards"
    folder.mkdir()
    for i, picture in enumerate(photos):
        cv2.imwrite(str(folder / f"board_{i}.png"), picture)
    (folder / "notes.txt").write_text("taken on Monday")
    return folder


def test_a_folder_of_pictures_becomes_a_camera_file_and_a_report(run, job, boards):
    code, out, err = run("lens", "boards", *SAID, "--out", "lens.yaml", "--overlay", "seen")
    assert code == 0, err
    assert out.startswith("verdict     ")
    assert "board_7.png" in out
    assert "unseen px" in out
    assert all(line.startswith("warning: ") for line in err.splitlines())
    found = read_camera(job / "lens.yaml").intrinsics
    assert abs(found.fx - LENS.fx) < 2
    assert sorted(p.name for p in (job / "seen").iterdir()) == [
        *(f"board_{i}.png" for i in range(8)),
        "coverage.png",
    ]


def test_the_camera_file_found_is_one_for_the_other_verbs(run, job, boards):
    run("lens", "boards", *SAID, "--model", "plumb_bob", "--out", "lens_found.json")
    code, _, err = run("find", "boards/board_0.png", "--camera", "lens_found.json", "--radius", 0.1)
    assert code == 2
    assert "the picture is" not in err


def test_json_tells_everything_a_machine_wants(run, boards):
    code, out, _ = run("lens", "boards/*.png", *SAID, "--model", "plumb_bob", "--json")
    assert code == 0
    told = json.loads(out)
    assert told["camera"]["distortion"]["model"] == "plumb_bob"
    assert np.array(told["covariance"]).shape == (9, 9)
    assert told["sigma"]["fx"] == pytest.approx(np.sqrt(told["covariance"][0][0]))
    assert [p["status"] for p in told["pictures"]] == ["used"] * 8
    assert told["verdict"] in ("good", "weak")
    assert 0 < told["corner_error_at_2_m"] < 0.05
    assert len(told["tilts_degrees"]) == 8


def test_pictures_may_stand_behind_the_board(run, boards):
    names = [f"boards/board_{i}.png" for i in range(4)]
    code, out, _ = run("lens", *SAID, *names, "--model", "none", "--json")
    assert [p["picture"] for p in json.loads(out)["pictures"]] == names
    assert code in (0, 3)


def test_a_lens_that_can_t_be_trusted_is_told_and_not_written(run, job):
    # boards parallel to the picture: the focal length stays open
    flat = [
        Pose(np.eye(3), np.array([-0.09 + x, -0.06, z]))
        for x, z in ((-0.03, 0.4), (0.01, 0.5), (0.02, 0.6))
    ]
    for name, picture in zip("abc", photograph_boards(LENS, BOARD, flat), strict=True):
        cv2.imwrite(str(job / f"{name}.png"), picture)
    names = ("a.png", "b.png", "c.png")
    code, out, err = run("lens", *names, *SAID, "--model", "plumb_bob", "--out", "no.json")
    assert code == 3
    assert "verdict     failed" in out
    assert "warning: " in err
    assert not (job / "no.json").exists()


def test_a_board_is_printed_without_any_picture(run, job):
    code, out, err = run("lens", *SAID, "--print-board", "board.svg")
    assert (code, out) == (0, "")
    assert "all 8 squares across are 240 mm, all 6 down 180 mm" in err
    assert (job / "board.svg").read_text().startswith("<svg")


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("boards", "--board", "chessboard", "8x6", "0.03"), "did you mean --board chessboard 7x5"),
        (("boards/board_0.png", *SAID), "1 of 1 pictures show the chessboard"),
        (("boards", "--board", "chessboard", "7x5", "30"), "sides are in metres (0.03 for 30 mm?)"),
        (("boards", "--board", "chessboard"), "give it as chessboard 9x6 0.025, or charuco"),
        (("boards", "--board", "circles", "7x5"), "give it as chessboard"),
        (("boards", *SAID, "--model", "brown"), "invalid choice: 'brown'"),
        (("boards", *SAID, "--out", "lens.txt"), "ends in .json (monocell), .yaml (ROS) or .yml"),
        (("boards",), "the following arguments are required: --board"),
        (SAID, "no pictures given"),
        (("none.png", *SAID), "none.png: there is no such picture"),
        (("none/*.png", *SAID), "no picture is named like this"),
        (("empty", *SAID), "empty: there is no picture in this folder"),
        ((*SAID, "--print-board", "board.doc"), "ends in .pdf, .svg, .png"),
        ((*SAID, "--print-board", "no/board.pdf"), "the folder no is not there"),
    ],
)
def test_refusals_are_one_line(refused, job, boards, arguments, told):
    (job / "empty").mkdir()
    assert told in refused("lens", *arguments)
