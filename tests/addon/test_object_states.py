# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects hidden, parented, linked, modified or moved elsewhere: each behaves, or says what it
needs."""

import json

import bench_cell
import numpy as np
import pytest
from monocell.core.document.cell_file import read_cell
from monocell.core.document.entries import object_entry

pytestmark = pytest.mark.blender

BOX = bench_cell.BOX


@pytest.fixture
def scene(addon, bench):
    """A cell with the bench's box and drum, picked exactly."""
    assert addon.ops.monocell.open_cell(filepath=str(bench)) == {"FINISHED"}
    add(addon, "box", bench_cell.box_picks())
    add(addon, "cylinder", bench_cell.drum_picks(), name="drum")
    return addon.context.scene


def add(bpy, kind, picks, **options):
    operator = getattr(bpy.ops.monocell, f"add_{kind}")
    assert operator(picks=json.dumps(picks), **options) == {"FINISHED"}


def things(bpy, tmp_path):
    path = tmp_path / "now.cell.json"
    assert bpy.ops.monocell.save_cell(filepath=str(path)) == {"FINISHED"}
    return {thing.name: thing for thing in read_cell(path).objects}


def same_place(thing, other, tolerance=2e-6):
    here, there = thing.world_from_object, other.world_from_object
    assert np.allclose(here.translation, there.translation, atol=tolerance)
    assert np.allclose(here.rotation, there.rotation, atol=tolerance)


def hang(bpy, ob, *, inverse, **placed):
    """Parent an object to an empty that is placed so; with `inverse` it keeps its place."""
    parent = bpy.data.objects.new("arm", None)
    bpy.context.scene.collection.objects.link(parent)
    for name, value in placed.items():
        setattr(parent, name, value)
    bpy.context.view_layer.update()
    ob.parent = parent
    if inverse:
        ob.matrix_parent_inverse = parent.matrix_world.inverted()
    bpy.context.view_layer.update()
    return parent


PARENTS = {
    "moved": {"location": (0.3, -0.2, 0.1)},
    "turned": {"location": (0.3, -0.2, 0.1), "rotation_euler": (0.2, 0.4, -0.9)},
    "scaled": {"scale": (2.0, 2.0, 2.0)},
    "stretched and turned": {"scale": (2.0, 1.0, 0.5), "rotation_euler": (0.3, 0.0, 0.7)},
}


@pytest.mark.parametrize("placed", PARENTS.values(), ids=PARENTS)
def test_solving_again_keeps_the_true_place_under_a_parent(addon, scene, tmp_path, placed):
    before = things(addon, tmp_path)["box"]
    ob = scene.objects["box"]
    parent = hang(addon, ob, inverse=True, **placed)
    assert addon.ops.monocell.solve_again() == {"FINISHED"}
    # Blender works out a parented object's place when the scene is evaluated
    addon.context.view_layer.update()
    same_place(things(addon, tmp_path)["box"], before)
    assert ob.parent == parent
    assert np.allclose(
        np.array(ob.matrix_world)[:3, 3], BOX.world_from_object.translation, atol=1e-3
    )


def test_a_parent_that_a_script_moved_moves_its_object_at_once(addon, scene, tmp_path):
    before = things(addon, tmp_path)["box"]
    parent = hang(addon, scene.objects["box"], inverse=True)
    parent.location = (0.1, 0.0, 0.0)
    moved = things(addon, tmp_path)["box"].world_from_object.translation
    assert np.allclose(
        moved, before.world_from_object.translation + np.array([0.1, 0, 0]), atol=1e-6
    )


def test_an_object_sheared_by_its_parent_is_refused_in_words(addon, scene, tmp_path):
    parent = hang(addon, scene.objects["box"], inverse=True)
    parent.scale = (3.0, 1.0, 1.0)
    with pytest.raises(RuntimeError, match=r"box: sheared .* clear its parent"):
        things(addon, tmp_path)


def test_the_place_that_a_constraint_gives_counts_and_solving_says_so(
    addon, scene, tmp_path, capfd
):
    target = addon.data.objects.new("target", None)
    scene.collection.objects.link(target)
    target.location = (0.5, 0.5, 0.5)
    held = scene.objects["box"].constraints.new("COPY_LOCATION")
    held.target = target
    addon.context.view_layer.update()
    assert np.allclose(things(addon, tmp_path)["box"].world_from_object.translation, 0.5)
    capfd.readouterr()
    assert addon.ops.monocell.solve_again() == {"FINISHED"}
    assert "box: stands where its constraints put it" in capfd.readouterr().out
    addon.context.view_layer.update()
    assert np.allclose(things(addon, tmp_path)["box"].world_from_object.translation, 0.5)


def test_an_object_moved_out_of_its_collection_is_rebuilt_where_it_is(addon, scene, tmp_path):
    other = addon.data.collections.new("mine")
    scene.collection.children.link(other)
    ob = scene.objects["box"]
    other.objects.link(ob)
    scene.monocell_cell.collection.objects.unlink(ob)
    assert addon.ops.monocell.solve_again() == {"FINISHED"}
    assert sorted(things(addon, tmp_path)) == ["box", "drum"]
    assert list(other.objects) == [ob]


def test_new_objects_in_an_excluded_collection_are_built_and_it_is_said(
    addon, scene, tmp_path, capfd
):
    addon.context.view_layer.layer_collection.children[0].exclude = True
    capfd.readouterr()
    add(addon, "box", bench_cell.box_picks(), name="crate")
    assert "crate: is not seen, as Cell objects is hidden or excluded" in capfd.readouterr().out
    assert "crate" in things(addon, tmp_path)


def test_hidden_objects_belong_to_the_cell(addon, scene, tmp_path):
    scene.objects["box"].hide_set(True)
    scene.objects["drum"].hide_viewport = True
    assert sorted(things(addon, tmp_path)) == ["box", "drum"]
    assert addon.ops.monocell.solve_again() == {"FINISHED"}
    assert sorted(things(addon, tmp_path)) == ["box", "drum"]


def test_a_linked_duplicate_keeps_its_shape_when_its_twin_is_resized(addon, scene, tmp_path):
    twin = scene.objects["box"].copy()
    scene.monocell_cell.collection.objects.link(twin)
    twin.location.x += 0.3
    before = things(addon, tmp_path)
    addon.ops.monocell.set_size(name="box", size="size_z", metres=0.2)
    after = things(addon, tmp_path)
    assert after["box"].size[2] == 0.2
    assert np.allclose(after["box.001"].size, before["box.001"].size)


def test_an_object_hung_on_a_bone_keeps_its_true_place(addon, scene, tmp_path):
    before = things(addon, tmp_path)["box"]
    rig = addon.data.objects.new("rig", addon.data.armatures.new("rig"))
    scene.collection.objects.link(rig)
    rig.location, rig.rotation_euler = (0.2, 0.1, 0.3), (0.3, 0.5, 0.1)
    addon.context.view_layer.objects.active = rig
    addon.ops.object.mode_set(mode="EDIT")
    bone = rig.data.edit_bones.new("link")
    bone.tail = (0, 0.1, 0.2)
    addon.ops.object.mode_set(mode="OBJECT")
    ob = scene.objects["box"]
    ob.parent, ob.parent_type, ob.parent_bone = rig, "BONE", "link"
    addon.context.view_layer.update()
    assert addon.ops.monocell.solve_again() == {"FINISHED"}
    addon.context.view_layer.update()
    same_place(things(addon, tmp_path)["box"], before)


def test_modifiers_are_no_part_of_the_model_and_this_is_said(addon, scene, tmp_path, capfd):
    before = things(addon, tmp_path)["box"]
    scene.objects["box"].modifiers.new("Bevel", "BEVEL")
    capfd.readouterr()
    after = things(addon, tmp_path)["box"]
    assert object_entry(after) == object_entry(before)
    assert (
        "box: its modifiers are no part of the model: apply or remove Bevel"
        in capfd.readouterr().out
    )


def test_shape_keys_are_told_and_go_when_the_object_is_rebuilt(addon, scene, tmp_path, capfd):
    ob = scene.objects["box"]
    ob.shape_key_add(name="Basis")
    key = ob.shape_key_add(name="wide")
    for point in key.data:
        point.co.x *= 2
    key.value = 1.0
    before = things(addon, tmp_path)["box"]
    assert "box: its shape keys are no part of the model" in capfd.readouterr().out
    assert addon.ops.monocell.solve_again() == {"FINISHED"}
    assert ob.data.shape_keys is None
    assert object_entry(things(addon, tmp_path)["box"]) == object_entry(before)


def test_a_stretched_box_is_a_longer_box_and_a_stretched_drum_is_refused(addon, scene, tmp_path):
    before = things(addon, tmp_path)["box"]
    scene.objects["box"].scale.x = 1.5
    assert things(addon, tmp_path)["box"].size[0] == pytest.approx(1.5 * before.size[0])
    scene.objects["drum"].scale.x = 1.5
    with pytest.raises(RuntimeError, match=r"drum: stretched to .* scale x and y alike"):
        things(addon, tmp_path)


def test_the_list_shows_what_the_document_holds(addon, module, scene, tmp_path):
    stored = scene.monocell_cell
    lamp = addon.data.objects.new("lamp", addon.data.lights.new("lamp", "POINT"))
    stored.collection.objects.link(lamp)
    box = scene.objects["box"]
    stored.collection.objects.unlink(box)
    scene.collection.objects.link(box)
    objects = module("scene.objects")
    listed = [ob for ob in scene.objects if objects.is_modelled(ob)]
    assert sorted(ob.name for ob in listed) == sorted(things(addon, tmp_path))
    assert module("addon.panels.steps").count_objects(scene) == 2
    for ob in listed:
        stored.object_index = scene.objects.find(ob.name)
        assert addon.context.view_layer.objects.active == ob
        assert scene.objects[stored.object_index] == ob


def test_a_script_s_object_is_edited_as_if_it_was_drawn(addon, module, scene, tmp_path):
    build = module("scene.objects").build_object
    box = module("core").Box(
        "crate", module("core").Pose(np.eye(3), [0.5, 0.1, 0.05]), size=[0.1, 0.1, 0.1], on="floor"
    )
    build(box, scene.collection)
    addon.ops.monocell.set_size(name="crate", size="size_z", metres=0.3)
    crate = things(addon, tmp_path)["crate"]
    assert crate.size[2] == 0.3
    # what stands keeps its base where it is
    assert crate.world_from_object.translation[2] == pytest.approx(0.15)
    assert len([ob for ob in scene.objects if ob.name.startswith("crate")]) == 1


def test_an_index_beyond_the_list_chooses_nothing_and_prints_no_traceback(addon, scene, capfd):
    stored = addon.context.scene.monocell_cell
    before = addon.context.view_layer.objects.active
    stored.object_index = 99
    assert addon.context.view_layer.objects.active == before
    assert "Traceback" not in "".join(capfd.readouterr())


def test_the_lock_of_a_size_that_an_object_has_not_does_nothing(addon, scene, capfd):
    fields = addon.context.scene.monocell_object
    addon.ops.monocell.add_sphere(
        way="FLOATING",
        picks='{"outline": [[400, 300], [440, 300], [420, 340]]}',
        known='{"radius": 0.05}',
    )
    fields.known_2 = True
    assert not fields.known_2
    assert "Traceback" not in "".join(capfd.readouterr())
