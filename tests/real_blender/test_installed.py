# SPDX-License-Identifier: GPL-3.0-or-later
import json

import bench_cell
import numpy as np
import pytest
from bundled_wheels import ROOT
from session_checks import STEPS, SessionChecks, write_job

pytestmark = [pytest.mark.real_blender, pytest.mark.slow]


@pytest.fixture(scope="session")
def worked(real_blender, tmp_path_factory):
    """The folder in which one Blender left its work, and what it found."""
    folder = tmp_path_factory.mktemp("work")
    run = real_blender.run(
        *("--background", "--python-exit-code", 3, "--python", STEPS, "--", write_job(folder))
    )
    assert run.returncode == 0, run.stdout + run.stderr
    return folder, json.loads((folder / "found.json").read_text())


class TestSession(SessionChecks):
    """All that has to be true after the session."""


@pytest.mark.parametrize("what", ["zip", "checkout"])
def test_blender_validates_it(real_blender, extension_zip, what):
    path = {"zip": extension_zip, "checkout": ROOT}[what]
    run = real_blender.run("--command", "extension", "validate", path)
    assert run.returncode == 0, run.stdout + run.stderr


def test_the_command_tells_its_verbs(real_blender):
    run = real_blender.run("--command", "monocell", "--help")
    assert run.returncode == 0, run.stderr
    assert "calibrate" in run.stdout


@pytest.mark.parametrize("way", ["command", "script"])
def test_a_ball_is_found_by_command_and_by_script(real_blender, tmp_path, way):
    bench_cell.write_bench(tmp_path)
    (tmp_path / "camera.yaml").write_text(bench_cell.ros_camera())
    start = {
        "command": ("--command", "monocell"),
        "script": ("--background", "--python", ROOT / "headless" / "run.py", "--"),
    }[way]
    run = real_blender.run(
        *(*start, "find", tmp_path / "ball_0.png", "--camera", tmp_path / "camera.yaml"),
        *("--radius", bench_cell.RADIUS, "--json"),
    )
    assert run.returncode == 0, run.stderr
    # Blender prints its own name first
    told = json.JSONDecoder().raw_decode(run.stdout[run.stdout.index("{") :])[0]
    truth = bench_cell.POSE.apply(bench_cell.CENTRES[0])
    assert np.allclose(told["center_camera"], truth, atol=3e-3)


@pytest.mark.parametrize("way", ["command", "script"])
def test_bad_input_ends_with_2_and_one_line(real_blender, tmp_path, way):
    start = {
        "command": ("--command", "monocell"),
        "script": ("--background", "--python", ROOT / "headless" / "run.py", "--"),
    }[way]
    run = real_blender.run(*start, "calibrate", tmp_path / "none.cell.json")
    assert run.returncode == 2
    assert "there is no such file" in run.stderr and "Traceback" not in run.stderr
