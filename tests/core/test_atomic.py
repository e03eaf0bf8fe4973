# SPDX-License-Identifier: GPL-3.0-or-later
"""Files are written whole or not at all: what was there before survives every failure."""

from __future__ import annotations

import os

import pytest
from monocell.core.atomic import atomic_files, atomic_path
from monocell.core.errors import DocumentError


def test_the_new_file_takes_the_place_of_the_old_one(tmp_path):
    path = tmp_path / "cell.json"
    path.write_text("old")
    with atomic_path(path) as temporary:
        temporary.write_text("new")
        assert path.read_text() == "old"
    assert path.read_text() == "new"
    assert [p.name for p in tmp_path.iterdir()] == ["cell.json"]


@pytest.mark.parametrize("failure", [RuntimeError, KeyboardInterrupt, SystemExit])
def test_a_failure_midway_leaves_the_old_file_as_it_was_and_nothing_beside_it(tmp_path, failure):
    path = tmp_path / "cell.json"
    path.write_bytes(b"old\r\n\xff")
    before = path.stat()
    with pytest.raises(failure), atomic_path(path) as temporary:
        temporary.write_text("half of the n")
        raise failure
    assert path.read_bytes() == b"old\r\n\xff"
    assert path.stat().st_mtime_ns == before.st_mtime_ns
    assert [p.name for p in tmp_path.iterdir()] == ["cell.json"]


def test_a_disk_that_fills_up_midway_is_told_as_such(tmp_path):
    path = tmp_path / "cell.json"
    path.write_text("old")
    with (
        pytest.raises(DocumentError, match=r"can't be written \(No space left on device\)"),
        atomic_path(path),
    ):
        raise OSError(28, "No space left on device")
    assert path.read_text() == "old"
    assert [p.name for p in tmp_path.iterdir()] == ["cell.json"]


def test_a_failure_midway_makes_no_file_where_there_was_none(tmp_path):
    with pytest.raises(RuntimeError), atomic_path(tmp_path / "new.png") as temporary:
        temporary.write_text("half")
        raise RuntimeError
    assert list(tmp_path.iterdir()) == []


def test_the_temporary_file_has_the_same_ending_in_the_same_folder(tmp_path):
    with atomic_path(tmp_path / "a.cell.glb") as temporary:
        assert temporary.suffix == ".glb"
        assert temporary.parent == tmp_path


def test_a_new_file_may_be_read_by_whom_the_umask_allows(tmp_path):
    old = os.umask(0o027)
    try:
        with atomic_path(tmp_path / "a.json") as temporary:
            temporary.write_text("{}")
    finally:
        os.umask(old)
    assert (tmp_path / "a.json").stat().st_mode & 0o777 == 0o640


def test_a_missing_folder_is_named(tmp_path):
    with (
        pytest.raises(DocumentError, match=r"nowhere is not there; make it first"),
        atomic_path(tmp_path / "nowhere" / "a.json"),
    ):
        pass


def test_a_folder_can_t_be_replaced_by_a_file(tmp_path):
    (tmp_path / "out").mkdir()
    with pytest.raises(DocumentError, match="is a folder"), atomic_path(tmp_path / "out"):
        pass
    assert [p.name for p in tmp_path.iterdir()] == ["out"]


def test_a_name_too_long_for_the_disk_is_refused(tmp_path):
    with (
        pytest.raises(DocumentError, match="can't be written"),
        atomic_path(tmp_path / ("a" * 400)),
    ):
        pass


def test_files_that_belong_together_appear_together_and_others_stay(tmp_path):
    (tmp_path / "meshes").mkdir()
    (tmp_path / "meshes" / "of_others.obj").write_text("other")
    (tmp_path / "meshes" / "a.obj").write_text("old")
    with atomic_files(tmp_path / "cell.urdf") as temporary:
        assert temporary.name == "cell.urdf"
        temporary.write_text("new")
        (temporary.parent / "meshes").mkdir()
        (temporary.parent / "meshes" / "a.obj").write_text("new")
        assert (tmp_path / "meshes" / "a.obj").read_text() == "old"
    assert (tmp_path / "cell.urdf").read_text() == "new"
    assert (tmp_path / "meshes" / "a.obj").read_text() == "new"
    assert (tmp_path / "meshes" / "of_others.obj").read_text() == "other"
    assert sorted(p.name for p in tmp_path.iterdir()) == ["cell.urdf", "meshes"]


def test_when_one_of_the_files_can_t_take_its_place_none_does(tmp_path):
    (tmp_path / "a.obj").write_text("old")
    (tmp_path / "cell.urdf").write_text("old")
    (tmp_path / "b.obj").mkdir()
    with (
        pytest.raises(DocumentError, match="can't be written"),
        atomic_files(tmp_path / "cell.urdf") as temporary,
    ):
        for name in ("cell.urdf", "a.obj", "b.obj"):
            (temporary.parent / name).write_text("new")
        (temporary.parent / "more").mkdir()
        (temporary.parent / "Aa").mkdir()
        (temporary.parent / "Aa" / "c.obj").write_text("new")
    assert (tmp_path / "a.obj").read_text() == (tmp_path / "cell.urdf").read_text() == "old"
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.obj", "b.obj", "cell.urdf"]


def test_a_failure_midway_leaves_no_folder_behind(tmp_path):
    with pytest.raises(RuntimeError), atomic_files(tmp_path / "cell.urdf") as temporary:
        temporary.write_text("half")
        raise RuntimeError
    assert list(tmp_path.iterdir()) == []
