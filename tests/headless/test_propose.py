# SPDX-License-Identifier: GPL-3.0-or-later
"""`monocell propose` writes what it believes, tells the rest, and refuses by name."""

import json
import sys
from pathlib import Path

import cv2
import pytest
from monocell.core.cell import Cell
from monocell.core.document.cell_file import read_cell, write_cell
from monocell.headless.cli import main

sys.path.append(str(Path(__file__).parents[1] / "core"))
from drawn_tabletop import TABLE, camera, can, picture


@pytest.fixture
def cell_file(tmp_path):
    cv2.imwrite(str(tmp_path / "seen.png"), picture([can()], camera(), [(0.1, 0.2, 0.75)]))
    file = tmp_path / "one.cell.json"
    write_cell(Cell(camera(), picture="seen.png", references=(TABLE,), folder=tmp_path), file)
    return file


def test_the_believed_ones_are_written_and_drawn(cell_file, tmp_path, capsys):
    out, overlay = tmp_path / "out.cell.json", tmp_path / "overlay.png"
    assert main(["propose", str(cell_file), "--out", str(out), "--overlay", str(overlay)]) == 0
    assert "proposal 1" in capsys.readouterr().out
    thing = read_cell(out).objects[0]
    assert thing.kind == "cylinder"
    assert thing.radius == pytest.approx(0.05, rel=0.02)
    assert overlay.stat().st_size > 1000


def test_machines_get_json(cell_file, capsys):
    assert main(["propose", str(cell_file), "--on", "table", "--json"]) == 0
    entries = json.loads(capsys.readouterr().out)
    assert entries[0]["believed"] is True
    assert entries[0]["object"]["kind"] == "cylinder"
    assert 0.8 < entries[0]["score"] <= 1


def test_a_plane_that_is_not_there_is_refused(cell_file, capsys):
    assert main(["propose", str(cell_file), "--on", "floor"]) == 2
    assert "floor" in capsys.readouterr().err


def test_a_cell_without_a_plane_is_asked_for_one(tmp_path, capsys):
    file = tmp_path / "bare.cell.json"
    write_cell(Cell(camera(), picture="seen.png"), file)
    assert main(["propose", str(file)]) == 2
    assert "say --on NAME" in capsys.readouterr().err


def test_an_overlay_does_not_replace_the_picture(cell_file, tmp_path, capsys):
    assert main(["propose", str(cell_file), "--overlay", str(tmp_path / "seen.png")]) == 2
    assert "would replace the picture" in capsys.readouterr().err
