# SPDX-License-Identifier: GPL-3.0-or-later
"""The cell worked on in edit, sculpt and pose mode, and objects that belong to another file."""

import json

import bench_cell
import numpy as np
import pytest
from monocell.core.document.cell_file import read_cell
from monocell.core.document.entries import object_entry

pytestmark = pytest.mark.blender


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


@pytest.mark.parametrize("mode", ["EDIT", "SCULPT", "VERTEX_PAINT", "WEIGHT_PAINT"])
def test_in_any_mode_objects_are_solved_added_and_exported(addon, scene, tmp_path, mode):
    before = things(addon, tmp_path)
    addon.context.view_layer.objects.active = scene.objects["box"]
    addon.ops.object.mode_set(mode=mode)
    assert addon.ops.monocell.export_gltf(filepath=str(tmp_path / "cell.glb")) == {"FINISHED"}
    assert addon.ops.monocell.solve_again() == {"FINISHED"}
    assert addon.context.mode == "OBJECT"
    assert scene.objects["box"].mode == "OBJECT"
    addon.ops.object.mode_set(mode=mode)
    add(addon, "box", bench_cell.box_picks(), name="crate")
    assert scene.objects["box"].mode == "OBJECT"
    after = things(addon, tmp_path)
    assert object_entry(after["box"]) == object_entry(before["box"])
    assert sorted(after) == ["box", "crate", "drum"]


def test_an_edit_that_is_still_going_on_is_in_the_document(addon, scene, tmp_path):
    import bmesh

    addon.context.view_layer.objects.active = scene.objects["box"]
    addon.ops.object.mode_set(mode="EDIT")
    mesh = bmesh.from_edit_mesh(scene.objects["box"].data)
    before = things(addon, tmp_path)["box"]
    for vertex in mesh.verts:
        vertex.co.x *= 2
    bmesh.update_edit_mesh(scene.objects["box"].data)
    assert things(addon, tmp_path)["box"].size[0] == pytest.approx(2 * before.size[0], rel=1e-5)


def test_objects_are_added_beside_a_posed_robot(addon, scene, tmp_path):
    rig = addon.data.objects.new("rig", addon.data.armatures.new("rig"))
    scene.collection.objects.link(rig)
    addon.context.view_layer.objects.active = rig
    addon.ops.object.mode_set(mode="EDIT")
    bone = rig.data.edit_bones.new("link")
    bone.tail = (0, 0, 0.2)
    addon.ops.object.mode_set(mode="POSE")
    add(addon, "box", bench_cell.box_picks(), name="crate")
    assert "crate" in things(addon, tmp_path)


def linked_into(bpy, scene, tmp_path, *, override):
    """The box of a library file, in the cell's collection instead of the one that was picked."""
    path = tmp_path / "parts.blend"
    bpy.data.libraries.write(str(path), {scene.objects["box"]})
    bpy.data.objects.remove(scene.objects["box"])
    with bpy.data.libraries.load(str(path), link=True) as (there, here):
        here.objects = list(there.objects)
    ob = here.objects[0]
    scene.monocell_cell.collection.objects.link(ob)
    if override:
        local = ob.override_create()
        scene.monocell_cell.collection.objects.unlink(ob)
        if local.name not in scene.monocell_cell.collection.objects:
            scene.monocell_cell.collection.objects.link(local)
        return local
    return ob


@pytest.mark.parametrize("override", [False, True], ids=["linked", "overridden"])
def test_what_belongs_to_a_library_stays_and_says_so(addon, scene, tmp_path, capfd, override):
    ob = linked_into(addon, scene, tmp_path, override=override)
    capfd.readouterr()
    before = things(addon, tmp_path)
    assert sorted(before) == ["box", "drum"]
    addon.ops.monocell.set_size(name="box", size="size_z", metres=0.2)
    after = things(addon, tmp_path)
    assert object_entry(after["box"]) == object_entry(before["box"])
    assert ob.data.library is not None
    assert "parts.blend and was not changed; make it local first" in capfd.readouterr().out


def test_a_turn_in_edit_mode_that_is_taken_back_is_no_longer_shown(addon, scene):
    box, undo_push = scene.objects["box"], addon.ops.ed.undo_push
    stood = box.matrix_basis.copy()
    addon.context.view_layer.objects.active = box
    for message in ("opened", "seen", "chosen"):
        undo_push(message=message)
    addon.ops.object.mode_set(mode="EDIT")
    undo_push(message="edit mode")
    box.rotation_euler[0] += 0.5
    addon.context.view_layer.update()
    undo_push(message="turned")
    for _ in range(4):
        addon.ops.ed.undo()
        addon.context.view_layer.update()
    box = addon.context.scene.objects["box"]
    assert np.allclose(box.matrix_basis, stood, atol=1e-6)
    # Blender by itself goes on to show it turned
    assert np.allclose(box.matrix_world, stood, atol=1e-6)
