# SPDX-License-Identifier: GPL-3.0-or-later
"""Cell documents: what is written is read back to the last digit, and files stay whole."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from drawn_cells import cells, whole_document
from hypothesis import HealthCheck, given, settings
from monocell.core import Camera, Cell, Intrinsics, SphereSighting
from monocell.core.document.cell_file import (
    cell_from_document,
    document_from_cell,
    dumped,
    read_cell,
    write_cell,
)
from monocell.core.errors import DocumentError

CAMERA = Camera(Intrinsics(640, 480, 500.0, 500.0, 320.0, 240.0))


def write_json(path, document):
    path.write_text(json.dumps(document), encoding="utf-8")
    return path


@settings(max_examples=50, deadline=None, suppress_health_check=list(HealthCheck))
@given(cells())
def test_a_cell_comes_back_from_its_document_with_the_same_numbers(cell):
    document = document_from_cell(cell, Path())
    again = cell_from_document(json.loads(dumped(document)), Path())
    # a document holds every number of a cell in full: equal documents are equal cells
    assert document_from_cell(again, Path()) == document
    np.testing.assert_array_equal(
        [r.point for r in again.references], [r.point for r in cell.references]
    )
    for one, other in zip(again.things, cell.things, strict=True):
        assert type(one) is type(other)
        assert (one.name, one.on, dict(one.known)) == (other.name, other.on, dict(other.known))
        assert {k: list(v) for k, v in one.picks.items()} == other.picks


def test_every_field_of_a_whole_document_is_read_and_written():
    document = whole_document()
    again = document_from_cell(cell_from_document(document, Path()), Path())
    by_name = {entry["name"]: entry for entry in again["objects"]}
    assert [by_name[entry["name"]] for entry in document["objects"]] == document["objects"]
    assert {k: v for k, v in again.items() if k != "objects"} == {
        k: v for k, v in document.items() if k != "objects"
    }


def test_a_document_is_laid_out_for_people_and_ends_with_a_newline():
    written = dumped(whole_document())
    assert written.endswith("}\n")
    assert max(len(line) for line in written.splitlines()) <= 110
    assert '"center": [0.1, 0.0, 0.3]' in written


def test_relative_pictures_are_relative_to_the_document_wherever_it_is_written(tmp_path):
    (tmp_path / "a").mkdir()
    (tmp_path / "b").mkdir()
    cell = Cell(
        CAMERA,
        "cell.png",
        (
            SphereSighting("p/one.png", [0, 0, 1], 0.04),
            SphereSighting("/far/away.png", [0, 0, 1], 0.04),
        ),
        folder=tmp_path / "a",
    )
    write_cell(cell, tmp_path / "b" / "cell.json")
    again = read_cell(tmp_path / "b" / "cell.json")
    assert again.picture == "../a/cell.png"
    assert again.path_of(again.picture).resolve() == tmp_path / "a" / "cell.png"
    assert [s.picture for s in again.sightings] == ["../a/p/one.png", "/far/away.png"]
    write_cell(again, tmp_path / "a" / "back.json")
    assert read_cell(tmp_path / "a" / "back.json").picture == "cell.png"


def test_the_camera_may_be_the_path_of_a_camera_file(tmp_path):
    document = whole_document()
    (tmp_path / "lenses").mkdir()
    write_json(tmp_path / "lenses" / "left.json", document["camera"])
    document["camera"] = "lenses/left.json"
    cell = read_cell(write_json(tmp_path / "a.cell.json", document))
    assert cell.camera.intrinsics.cx == 652.3
    document["camera"] = "lenses/right.json"
    with pytest.raises(DocumentError, match=r"right\.json: there is no such"):
        read_cell(write_json(tmp_path / "b.cell.json", document))


def test_a_byte_order_mark_is_harmless(tmp_path):
    path = tmp_path / "a.json"
    path.write_bytes(b"\xef\xbb\xbf" + json.dumps(whole_document()).encode())
    assert read_cell(path).picture == "cell.png"


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (b"", "is not JSON .* at line 1, column 1"),
        (b'{"monocell": 1,\n "camera": }', "at line 2, column 12"),
        (b"\xff\xfe\x00", "is not a text file"),
        (b"[" * 100_000, "nested too deeply"),
        (b'{"monocell": ' + b"9" * 5000 + b"}", "is not JSON"),
        (b'{"monocell": 1e999, "camera": {}}', "monocell: expected a finite number"),
        (b"[]", "expected an object"),
        (b"null", "expected an object"),
        (b'{"monocell": 2, "camera": {}}', "version 2 is unknown; this reads up to 1"),
        (b'{"monocell": 0, "camera": {}}', "version 0 is unknown"),
        (b'{"monocell": 1.5, "camera": {}}', "monocell: expected a whole number, got 1.5"),
        (b'{"monocell": 1, "monocell": 1, "camera": {}}', "monocell: stands there twice"),
    ],
)
def test_what_is_no_cell_document_is_refused_with_the_file_and_the_reason(tmp_path, content, told):
    path = tmp_path / "a.cell.json"
    path.write_bytes(content)
    with pytest.raises(DocumentError, match=told) as refusal:
        read_cell(path)
    assert str(refusal.value).startswith(f"{path}: ")
    assert str(refusal.value).count(str(path)) == 1
    assert "\n" not in str(refusal.value)


def test_a_missing_document_and_a_folder_are_named(tmp_path):
    with pytest.raises(DocumentError, match="no such file"):
        read_cell(tmp_path / "none.json")
    with pytest.raises(DocumentError, match="can't be read"):
        read_cell(tmp_path)


def test_a_document_that_can_t_be_written_leaves_the_old_one(tmp_path, monkeypatch):
    path = tmp_path / "a.cell.json"
    write_cell(Cell(CAMERA), path)
    before = path.read_bytes()

    def full(*_, **__):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_text", full)
    with pytest.raises(DocumentError, match=r"a\.cell\.json: can't be written \(No space left"):
        write_cell(Cell(CAMERA, "other.png"), path)
    assert path.read_bytes() == before
    assert [p.name for p in tmp_path.iterdir()] == ["a.cell.json"]
