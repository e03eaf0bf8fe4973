# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that name each other, opened, renamed, copied, deleted and saved in Blender."""

import json

import pytest
from monocell.core.document.cell_file import read_cell
from monocell.core.document.entries import object_entry

pytestmark = pytest.mark.blender

FLAT = {"rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "translation": [0.3, 0.1, 0.2]}
TILE = [[-0.05, -0.05], [0.05, -0.05], [0.05, 0.05], [-0.05, 0.05]]
LINKED = [
    {
        "name": "tile",
        "kind": "prism",
        "on": "box.top",
        "relations": [{"kind": "parallel", "to": "drum.axis"}],
        "polygon": TILE,
        "height": 0.02,
        "world_from_object": FLAT,
        "motion": {"kind": "attached", "to": "box", "joint": "slider", "axis": [0.0, 0.0, 1.0]}
        | {"point": [0.0, 0.0, 0.0]},
    },
    {"name": "ball", "kind": "sphere", "radius": 0.03, "world_from_object": FLAT},
    {"name": "new", "kind": "cone", "on": "box.top", "picks": {}},
]


@pytest.fixture
def linked(bench):
    """A document in which things name each other."""
    document = json.loads(bench.read_text())
    box = {"name": "box", "kind": "box", "size": [0.2, 0.1, 0.1], "world_from_object": FLAT}
    drum = {"name": "drum", "kind": "cylinder", "radius": 0.05, "height": 0.2}
    document["objects"] = [box, drum | {"world_from_object": FLAT}, *LINKED]
    document["composites"] = [{"name": "pile", "parts": ["box", "tile", "new"]}]
    path = bench.parent / "linked.cell.json"
    path.write_text(json.dumps(document))
    return path


def opened(bpy, path):
    assert bpy.ops.monocell.open_cell(filepath=str(path)) == {"FINISHED"}
    return bpy.context.scene


def saved(bpy, path):
    assert bpy.ops.monocell.save_cell(filepath=str(path)) == {"FINISHED"}
    return read_cell(path)


def entries(cell):
    return {thing.name: object_entry(thing) for thing in cell.things}


def test_a_document_of_every_kind_opens_and_saves_the_same(addon, linked, tmp_path):
    opened(addon, linked)
    back = saved(addon, tmp_path / "copy.cell.json")
    assert entries(back) == entries(read_cell(linked))
    assert back.composites[0].parts == ("box", "tile", "new")


def test_what_names_a_renamed_object_names_it_by_its_new_name(addon, linked, tmp_path):
    scene = opened(addon, linked)
    scene.objects["box"].name = "crate"
    back = saved(addon, tmp_path / "copy.cell.json")
    by_name = entries(back)
    assert by_name["tile"]["on"] == by_name["new"]["on"] == "crate.top"
    assert by_name["tile"]["motion"]["to"] == "crate"
    assert back.composites[0].parts == ("crate", "tile", "new")


def test_what_names_a_deleted_object_lets_go_of_it(addon, linked, tmp_path):
    scene = opened(addon, linked)
    for name in ("box", "drum"):
        addon.data.objects.remove(scene.objects[name])
    back = saved(addon, tmp_path / "copy.cell.json")
    tile = entries(back)["tile"]
    assert not {"on", "relations", "motion"} & set(tile)
    assert back.composites[0].parts == ("tile", "new")
    assert {thing.name for thing in back.things} == {"tile", "ball", "new"}


def test_a_copy_is_held_as_its_original_is(addon, linked, tmp_path):
    scene = opened(addon, linked)
    twin = scene.objects["tile"].copy()
    scene.monocell_cell.collection.objects.link(twin)
    back = saved(addon, tmp_path / "copy.cell.json")
    by_name = entries(back)
    assert by_name["tile.001"] == by_name["tile"] | {"name": "tile.001"}
    assert back.composites[0].parts == ("box", "tile", "new")
