# SPDX-License-Identifier: GPL-3.0-or-later
"""`monocell export`: the ending tells the format, the text formats need no Blender."""

from __future__ import annotations

import subprocess
import sys

import pytest
from monocell.core.formats.endings import FORMATS
from monocell.core.formats.text_formats import WRITERS


@pytest.mark.parametrize("ending", WRITERS)
def test_text_formats_are_written_in_words_that_name_the_file(run, job, ending):
    code, out, err = run("export", "truth.cell.json", f"truth{ending}")
    assert (code, out) == (0, f"truth{ending}\n")
    lens = "warning: the lens distortion plumb_bob is left out: MuJoCo's camera has none\n"
    assert err == (lens if ending in (".xml", ".mjcf") else "")
    assert "block" in (job / f"truth{ending}").read_text(encoding="utf-8")


def test_help_lists_every_ending(capsys):
    from monocell.headless.cli import main

    assert main(["export", "--help"]) == 0
    told = capsys.readouterr().out
    for ending, what in FORMATS.items():
        assert f"  {ending} " in told and what in told


def test_an_ending_in_capitals_is_the_same(run, job):
    assert run("export", "truth.cell.json", "TRUTH.URDF")[0] == 0
    assert (job / "TRUTH.URDF").read_text().count("<link") == 4


@pytest.mark.parametrize("name", ["truth", "truth.json", "truth.cell"])
def test_what_is_no_format_is_refused_with_the_list(refused, name):
    assert "name it one of .glb .gltf .urdf .sdf" in refused("export", "truth.cell.json", name)


def test_a_folder_that_is_not_there_is_refused(refused):
    assert "the folder no is not there" in refused("export", "truth.cell.json", "no/truth.urdf")


def test_a_text_format_needs_no_blender_and_no_opencv(job):
    script = (
        "import sys; from monocell.headless.cli import main;"
        f"code = main(['export', {str(job / 'truth.cell.json')!r}, {str(job / 'a.urdf')!r}]);"
        "print(code, 'bpy' in sys.modules, 'trimesh' in sys.modules)"
    )
    told = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert told.stdout.split()[-3:] == ["0", "False", "False"], told.stderr


def test_what_is_picked_but_not_solved_is_told(run):
    code, _, err = run("export", "cell.cell.json", "cell.scene")
    assert code == 0
    assert "warning: block is picked but not solved yet: run monocell model" in err.splitlines()
