# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import json
from dataclasses import replace

import cv2
import numpy as np
import pytest
from monocell.core.appearance import Appearance, Texture
from monocell.core.cell import Cell
from monocell.core.document.cell_file import read_cell, write_cell
from monocell.core.errors import DocumentError, InvalidValue
from monocell.core.look.looks import looks_of
from monocell.core.look.texture_files import with_looks
from painted_cell import CAMERA, cell_of, crate, drum, face_size, photograph, waves

LOOK = Appearance(
    [0.5, 0.25, 0.125], {"top": Texture("a.png", 0.75), "y-": Texture("sub/b.png", 1.0)}
)


def cell_in(folder):
    return replace(cell_of(crate(appearance=LOOK)), folder=folder)


def test_textures_come_back_from_a_document_as_they_went(tmp_path):
    write_cell(cell_in(tmp_path), tmp_path / "x.cell.json")
    look = read_cell(tmp_path / "x.cell.json").objects[0].appearance
    assert look.color.tolist() == [0.5, 0.25, 0.125]
    assert look.textures["top"] == Texture("a.png", 0.75)
    assert look.textures["y-"] == Texture("sub/b.png", 1.0)


def test_a_document_elsewhere_finds_the_same_files(tmp_path):
    (tmp_path / "other").mkdir()
    write_cell(cell_in(tmp_path), tmp_path / "x.cell.json")
    write_cell(read_cell(tmp_path / "x.cell.json"), tmp_path / "other" / "x.cell.json")
    moved = read_cell(tmp_path / "other" / "x.cell.json")
    assert moved.objects[0].appearance.textures["y-"].picture == "../sub/b.png"
    here = moved.path_of(moved.objects[0].appearance.textures["top"].picture)
    assert here.resolve() == (tmp_path / "a.png").resolve()


@pytest.mark.parametrize(
    ("textures", "told"),
    [
        ([], r"objects\[0\]\.appearance\.textures: expected an object"),
        ({"lid": {"picture": "a.png"}}, r"textures\.lid: crate has no such face; it has x-, x\+"),
        ({"top": {"seen": 1}}, r"textures\.top\.picture: is missing"),
        ({"top": {"picture": "a.png", "seen": 1.5}}, r"a\.png: seen is a share from 0 to 1"),
        ({"top": {"picture": ""}}, r"textures\.top\.picture: expected a text"),
        ({"top": {"picture": "a.png", "alpha": 1}}, r"textures\.top\.alpha: unknown key"),
        ({"top": "a.png"}, r"textures\.top: expected an object"),
    ],
)
def test_textures_are_read_strictly(tmp_path, textures, told):
    path = tmp_path / "x.cell.json"
    write_cell(cell_in(tmp_path), path)
    document = json.loads(path.read_text())
    document["objects"][0]["appearance"]["textures"] = textures
    path.write_text(json.dumps(document))
    with pytest.raises(DocumentError, match=told):
        read_cell(path)


def printed(thing, face, st):
    return waves(st, face_size(thing, face))


def test_looks_become_files_beside_the_document_and_names_in_it(tmp_path):
    cell = cell_of(crate(), drum(appearance=Appearance([0.1, 0.2, 0.3])))
    picture = photograph(cell.objects, printed, side=1)
    looks = list(looks_of(cell, picture, textured=["crate"]))
    assert [look.thing.name for look in looks] == ["crate", "drum"]
    dressed = with_looks(cell, looks, tmp_path / "room.cell.json")
    write_cell(dressed, tmp_path / "room.cell.json")
    block = read_cell(tmp_path / "room.cell.json").objects[0]
    assert block.appearance.textures["top"].picture == "room.crate.top.png"
    assert set(block.appearance.textures) == {face.face for face in looks[0].faces}
    assert {face.face for face in looks[0].unseen} == {"x-", "y+", "base"}
    file = cv2.imread(str(tmp_path / "room.crate.top.png"), cv2.IMREAD_UNCHANGED)
    top = next(face for face in looks[0].faces if face.face == "top")
    assert np.array_equal(file, top.pixels)


def test_what_is_not_seen_keeps_its_colour_and_what_is_not_asked_its_textures(tmp_path):
    inside = crate(appearance=LOOK)
    small = type(inside)("small", inside.world_from_object, size=[0.1] * 3, appearance=LOOK)
    cell = cell_of(inside, small)
    picture = photograph(cell.objects, printed, side=1)
    looks = list(looks_of(cell, picture, textured=["small"]))
    dressed = with_looks(cell, looks, tmp_path / "x.cell.json")
    assert dressed.objects[1].appearance is LOOK
    assert dressed.objects[0].appearance.textures == LOOK.textures
    assert dressed.objects[0].appearance.color.tolist() != LOOK.color.tolist()
    assert "small: is not seen" in looks[1].warnings[0]


def test_files_of_names_that_differ_by_case_or_signs_do_not_meet(tmp_path):
    shapes = [crate(), drum()]
    a = type(shapes[0])("a/b", shapes[0].world_from_object, size=shapes[0].size)
    one = cell_of(a)
    looks = list(looks_of(one, photograph([a], printed, side=1), textured=["a/b"]))
    other = type(a)("A?b", a.world_from_object, size=a.size)
    both = [*looks, type(looks[0])(other, looks[0].color, looks[0].faces)]
    with_looks(Cell(CAMERA, objects=(a, other)), both, tmp_path / "x.cell.json")
    names = sorted(path.name for path in tmp_path.iterdir())
    assert len(names) == 2 * len(looks[0].faces)
    assert "x.a_b.top.png" in names and "x.A_b~2.top.png" in names


def test_a_name_that_no_object_has_is_refused_with_those_there_are():
    cell = cell_of(crate())
    with pytest.raises(InvalidValue, match="no solved object is called 'crat'; there is crate"):
        list(looks_of(cell, np.zeros((360, 480, 3), np.uint8), names=["crat"]))
