# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line from outside: verbs, exit codes, one line on stderr, results on stdout alone."""

from __future__ import annotations

import json
import subprocess
import sys

import numpy as np
import pytest
from monocell.core.document.cell_file import read_cell
from monocell.core.version import VERSION
from monocell.headless.cli import VERBS, main
from synthetic_cell import BLOCK, DRUM, LENS, PLACES, POSE, RADIUS

FIND = ("find", "pose_0.png", "--camera", "lens.json", "--radius", RADIUS)


def test_the_whole_job_from_pictures_to_a_comparison_runs_as_processes(shell, job):
    code, out, err = shell("calibrate", "cell.cell.json", "--out", "placed.cell.json")
    assert (code, err) == (0, "")
    assert "verdict   good" in out
    code, out, err = shell("model", "placed.cell.json", "--out", "done.cell.json")
    assert (code, err) == (0, "")
    assert "block" in out
    code, out, err = shell("compare", "truth.cell.json", "done.cell.json", "--json")
    assert (code, err) == (0, "")
    comparison = json.loads(out)
    assert np.linalg.norm(comparison["pose"]["centre"]) < 4e-3
    assert comparison["pose"]["mahalanobis"] < 5
    assert [e["name"] for e in comparison["objects"]] == ["block", "drum"]
    for error in comparison["objects"]:
        assert np.abs(error["sizes"]).max() < 2e-3
        assert np.abs(error["position"]).max() < 3e-3
    assert comparison["missing"] == comparison["surplus"] == []
    done = read_cell(job / "done.cell.json")
    assert (done.sketches, len(done.objects)) == ((), 2)
    np.testing.assert_allclose(done.objects[0].sizes, BLOCK.sizes, atol=2e-3)
    np.testing.assert_allclose(done.objects[1].sizes, DRUM.sizes, atol=2e-3)


def test_find_tells_the_ball_s_place_with_its_error(shell):
    code, out, err = shell(*FIND, "--json")
    assert (code, err) == (0, "")
    told = json.loads(out)
    error = np.array(told["center_camera"]) - POSE.apply(PLACES[0])
    assert (np.abs(error) < 5 * np.array(told["sigma"])).all()
    assert np.array(told["covariance"]).shape == (3, 3)
    assert told["coverage"] > 0.9
    assert told["warnings"] == []


def test_find_tells_people_in_lines(run):
    u, v = LENS.project(POSE.apply(PLACES[:1]))[0]
    code, out, err = run(*FIND, "--window", u - 50, v - 50, 100, 100)
    assert (code, err) == (0, "")
    assert out.startswith("ball at (")
    assert "1 sigma" in out
    assert "% of it seen" in out


def test_find_draws_its_outline_over_the_picture(run, job):
    from monocell.core.picture.pictures import read_picture

    assert run(*FIND, "--overlay", "seen.png")[0] == 0
    drawn, given = read_picture(job / "seen.png", LENS), read_picture(job / "pose_0.png", LENS)
    changed = (drawn != given).any(axis=2)
    assert 50 < changed.sum() < 0.2 * changed.size


def test_calibrate_tells_json_with_every_sighting(run):
    code, out, err = run("calibrate", "cell.cell.json", "--json")
    assert (code, err) == (0, "")
    told = json.loads(out)
    assert told["verdict"] == "good"
    assert [s["status"] for s in told["sightings"]] == ["used"] * 5
    assert told["positions"]["count"] == 5
    assert np.array(told["camera"]["covariance"]).shape == (6, 6)
    off = np.linalg.norm(np.array(told["center_world"]) - POSE.inverse().translation)
    assert off < 5 * np.linalg.norm(told["center_sigma"])


def test_json_has_null_where_there_is_no_number(run, job):
    document = json.loads((job / "cell.cell.json").read_text())
    document["sightings"].append({**document["sightings"][0], "window": [5, 5, 50, 50]})
    document["sightings"][-1]["center"] = [0.1, 0.1, 2.0]
    (job / "one_bad.json").write_text(json.dumps(document))
    code, out, err = run("calibrate", "one_bad.json", "--json")
    assert code == 0
    last = json.loads(out)["sightings"][-1]
    assert (last["status"], last["rms_pixels"]) == ("rejected", None)
    assert err.startswith("warning: 1 of 6 sightings rejected")


def test_the_baseline_of_the_paper_runs_and_states_no_error(run, job):
    code, out, _ = run("calibrate", "cell.cell.json", "--method", "frames", "--out", "f.json")
    assert code == 0
    assert "unknown: the baseline frames states none" in out
    assert read_cell(job / "f.json").camera.covariance is None


def test_model_tells_json_with_every_residual(run):
    run("calibrate", "cell.cell.json", "--out", "placed.cell.json")
    code, out, _ = run("model", "placed.cell.json", "--json")
    assert code == 0
    block, drum = json.loads(out)
    assert (block["object"]["kind"], drum["object"]["kind"]) == ("box", "cylinder")
    assert len(drum["residual_pixels"]) == 6
    assert max(block["size_sigma"]) < 0.02


def test_compare_tells_a_table_and_what_one_side_lacks(run):
    code, out, err = run("compare", "truth.cell.json", "cell.cell.json")
    assert code == 0
    assert err.splitlines() == [
        "warning: block of the truth is not in the cell",
        "warning: drum of the truth is not in the cell",
    ]
    code, out, err = run("compare", "truth.cell.json", "truth.cell.json")
    assert (code, err) == (0, "")
    assert "block" in out
    assert "+0.00" in out


def test_a_calibration_that_can_t_be_trusted_ends_with_3_and_writes_nothing(shell, job):
    document = json.loads((job / "cell.cell.json").read_text())
    for sighting, place in zip(document["sightings"], PLACES, strict=True):
        # the rig's mirror image, as from a robot whose y points the other way: any three places fit
        sighting["center"] = (place * [1, -1, 1]).tolist()
    (job / "mirrored.json").write_text(json.dumps(document))
    (job / "old.json").write_text("old")
    code, out, err = shell("calibrate", "mirrored.json", "--out", "old.json")
    assert code == 3, (out, err)
    assert "verdict   failed" in out
    assert "Traceback" not in err
    assert "warning: only 3 of 5 sightings agree" in err
    assert (job / "old.json").read_text() == "old"


def test_without_a_verb_the_verbs_are_told(run):
    code, out, err = run()
    assert (code, err) == (0, "")
    assert all(verb in out for verb in VERBS)


@pytest.mark.parametrize("verb", VERBS)
def test_every_verb_tells_its_arguments(verb, capsys):
    assert main([verb, "--help"]) == 0
    assert f"monocell {verb}" in capsys.readouterr().out


def test_the_version_is_the_package_s(run):
    assert run("--version")[1] == f"monocell {VERSION}\n"


def test_a_reader_that_leaves_a_pipe_is_no_error(job):
    command = f"{sys.executable} -m monocell.headless calibrate cell.cell.json | head -c 1"
    done = subprocess.run(
        ["bash", "-o", "pipefail", "-c", command], cwd=job, capture_output=True, text=True
    )
    assert "Traceback" not in done.stderr
    assert "Exception" not in done.stderr
