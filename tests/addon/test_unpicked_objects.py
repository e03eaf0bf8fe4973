# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects made by hand or by a script, held by relations given in the sidebar."""

import json

import bench_cell
import pytest
from monocell.core.document.entries import object_entry

pytestmark = pytest.mark.blender


@pytest.fixture
def scene(addon, bench):
    """The box with picks, and a can that a script put into the air."""
    document = json.loads(bench.read_text())
    place = {"rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "translation": [0.6, 0.1, 0.3]}
    can = {"name": "can", "kind": "cylinder", "radius": 0.03, "height": 0.1}
    box = object_entry(bench_cell.BOX) | {"picks": bench_cell.box_picks()}
    document["objects"] = [box, can | {"world_from_object": place}]
    path = bench.parent / "by_hand.cell.json"
    path.write_text(json.dumps(document))
    addon.ops.monocell.open_cell(filepath=str(path))
    return addon.context.scene


def height_of(scene):
    return scene.objects["can"].matrix_world.translation.z


@pytest.mark.parametrize(("to", "height"), [("floor", 0.05), ("box.top", 0.17)])
def test_a_relation_moves_it_to_what_holds_it(addon, scene, to, height):
    addon.ops.monocell.add_relation(name="can", kind="stands_on", to=to)
    addon.context.view_layer.update()
    assert height_of(scene) == pytest.approx(height, abs=1e-5)


def test_standing_on_the_active_reference_moves_it_down(addon, scene):
    addon.context.view_layer.objects.active = scene.objects["can"]
    addon.ops.monocell.stand_on()
    addon.context.view_layer.update()
    assert height_of(scene) == pytest.approx(0.05, abs=1e-5)


def test_it_follows_the_object_that_it_stands_on(addon, scene):
    addon.ops.monocell.pick_reference(of="box.top")
    addon.context.view_layer.objects.active = scene.objects["can"]
    addon.ops.monocell.stand_on()
    addon.ops.monocell.set_size(name="box", size="size_z", metres=0.2)
    addon.context.view_layer.update()
    assert height_of(scene) == pytest.approx(0.25, abs=1e-4)


def test_without_a_relation_typed_sizes_leave_it_where_it_was_put(addon, scene):
    addon.ops.monocell.set_size(name="can", size="radius", metres=0.05)
    addon.context.view_layer.update()
    assert height_of(scene) == pytest.approx(0.3, abs=1e-6)


def test_what_can_not_hold_is_refused_and_moves_nothing(addon, scene):
    addon.ops.monocell.add_relation(name="can", kind="stands_on", to="floor")
    with pytest.raises(RuntimeError, match="can"):
        addon.ops.monocell.add_relation(name="can", kind="stands_on", to="box.top")
    addon.context.view_layer.update()
    assert height_of(scene) == pytest.approx(0.05, abs=1e-5)
