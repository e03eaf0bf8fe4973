# SPDX-License-Identifier: GPL-3.0-or-later
"""The benchmark of the add-on keeps running, and says so when it does not."""

from dataclasses import replace
from pathlib import Path

import pytest

pytestmark = [pytest.mark.real_blender, pytest.mark.slow]

ROOT = Path(__file__).resolve().parents[2]
BENCHMARK = ROOT / "benchmarks" / "addon_speed.py"


def test_the_benchmark_tells_every_time_it_is_for(real_blender):
    run = real_blender.run("--background", "--python", BENCHMARK)
    assert run.returncode == 0, run.stdout + run.stderr
    for told in ("register", "find and calibrate 8 sightings", "a pick: snap"):
        assert told in run.stdout


def test_an_error_in_a_step_ends_the_benchmark_with_its_traceback(real_blender, tmp_path):
    without_extension = replace(real_blender, resources=tmp_path)
    run = without_extension.run("--background", "--python", BENCHMARK)
    assert run.returncode == 1, run.stdout + run.stderr
    assert "Traceback" in run.stderr
