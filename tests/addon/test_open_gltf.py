# SPDX-License-Identifier: GPL-3.0-or-later
"""A cell exported as glTF and opened again."""

import json
import struct

import bench_cell
import numpy as np
import pytest
from monocell.core.document.cell_file import read_cell
from monocell.core.document.entries import camera_entry

pytestmark = pytest.mark.blender


@pytest.fixture
def exported(addon, bench, tmp_path):
    """A glTF with a box on the floor and a cylinder on the box."""
    ops = addon.ops.monocell
    ops.open_cell(filepath=str(bench))
    ops.add_box("EXEC_DEFAULT", True, picks=json.dumps(bench_cell.box_picks()))
    ops.pick_reference("EXEC_DEFAULT", True, of="box.top")
    ops.add_cylinder("EXEC_DEFAULT", True, picks=json.dumps(bench_cell.drum_picks()))
    path = tmp_path / "out.glb"
    ops.export_gltf(filepath=str(path))
    ops.save_cell(filepath=str(tmp_path / "before.cell.json"))
    return path


def test_what_was_exported_opens_exactly_and_is_edited_as_ever(addon, exported, tmp_path):
    assert addon.ops.monocell.open_gltf(filepath=str(exported)) == {"FINISHED"}
    addon.ops.monocell.save_cell(filepath=str(tmp_path / "after.cell.json"))
    before, after = (read_cell(tmp_path / f"{n}.cell.json") for n in ("before", "after"))
    assert camera_entry(after.camera) == camera_entry(before.camera)
    assert [r.name for r in after.references] == [r.name for r in before.references]
    truth = {thing.name: thing for thing in before.objects}
    for thing in after.objects:
        assert thing.parameters.tolist() == truth[thing.name].parameters.tolist()
        assert thing.on == truth[thing.name].on
        there = thing.world_from_object.translation
        assert np.array_equal(there, truth[thing.name].world_from_object.translation)
    addon.ops.monocell.set_size("EXEC_DEFAULT", True, name="box", size="size_z", metres=0.2)
    addon.ops.monocell.save_cell(filepath=str(tmp_path / "edited.cell.json"))
    edited = {thing.name: thing for thing in read_cell(tmp_path / "edited.cell.json").objects}
    assert edited["box"].size[2] == 0.2


def glb(document):
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    return struct.pack("<4sIIII", b"glTF", 2, 20 + len(text), len(text), 0x4E4F534A) + text


@pytest.mark.parametrize(
    ("data", "told"),
    [
        (b"{}", "is no binary glTF"),
        (glb({"asset": {}})[:-4], "cut short"),
        (glb({"asset": {}}), "was not exported by monocell"),
        (glb({"scenes": [{"extras": {"monocell": {"camera": {}}}}]}), "extras.monocell.camera"),
    ],
)
def test_other_files_are_refused_in_one_line(addon, tmp_path, data, told):
    path = tmp_path / "x.glb"
    path.write_bytes(data)
    with pytest.raises(RuntimeError) as refusal:
        addon.ops.monocell.open_gltf(filepath=str(path))
    assert told in str(refusal.value)
    assert "Traceback" not in str(refusal.value)


def test_what_stood_on_a_node_that_is_gone_stands_alone(addon, exported, tmp_path):
    data = exported.read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    document = json.loads(data[20 : 20 + length])
    for node in document["nodes"]:
        if node["name"] == "box":
            del node["extras"]
    path = tmp_path / "less.glb"
    path.write_bytes(glb(document))
    addon.ops.monocell.open_gltf(filepath=str(path))
    addon.ops.monocell.save_cell(filepath=str(tmp_path / "less.cell.json"))
    cell = read_cell(tmp_path / "less.cell.json")
    assert [thing.name for thing in cell.objects] == ["cylinder"]
