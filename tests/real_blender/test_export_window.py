# SPDX-License-Identifier: GPL-3.0-or-later
"""Every format out of a real Blender, and the format that is chosen in its file browser."""

from pathlib import Path

import pytest
from monocell.core.formats.endings import FORMATS
from window_run import in_window

pytestmark = [pytest.mark.real_blender, pytest.mark.slow]

SAMPLE = Path(__file__).resolve().parents[2] / "samples" / "01_table"


@pytest.fixture(scope="session")
def exported(window_blender, tmp_path_factory):
    """The folder that one Blender left its files in, and what it found."""
    job = {
        "width": 1280,
        "height": 960,
        "cell": str(SAMPLE / "truth.cell.json"),
        "endings": list(FORMATS),
    }
    return in_window(window_blender, tmp_path_factory.mktemp("export"), "export_steps.py", job)


def test_no_step_fails(exported):
    _, found, run = exported
    assert "error" not in found, found.get("error")
    assert "Traceback" not in run.stdout + run.stderr


@pytest.mark.parametrize("ending", FORMATS)
def test_every_format_is_written_or_said_to_be_missing_in_this_blender(exported, ending):
    refused = exported[1]["refused"].get(ending)
    if refused is not None:
        # distributions build Blender without some of its parts
        assert ending.startswith(".usd")
        assert "this Blender was built without USD; use one from blender.org" in refused
        assert not (exported[0] / f"cell{ending}").exists()
        return
    assert (exported[0] / f"cell{ending}").stat().st_size > 100


def test_the_ending_follows_the_format_that_is_chosen_in_the_file_browser(exported):
    folder, found, _ = exported
    assert found["offered"] == ".urdf"
    assert found["written"] == ["cell.sdf", "truth.sdf"]
    assert "<sdf" in (folder / "truth.sdf").read_text()
    assert found["areas"] == "VIEW_3D"
