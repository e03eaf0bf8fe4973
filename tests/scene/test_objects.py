# SPDX-License-Identifier: GPL-3.0-or-later
from dataclasses import replace

import numpy as np
import pytest
from monocell.core.appearance import Appearance
from monocell.core.document.entries import object_entry
from monocell.core.errors import InvalidValue
from monocell.core.pose import Pose
from monocell.core.primitives import Box, Cylinder

pytestmark = pytest.mark.blender

POSE = Pose.from_rotation_vector([0.3, -0.7, 1.1], [0.41, -0.23, 1 / 3])
BOX = Box(
    "block",
    POSE,
    size=[0.2, 0.1, 1 / 7],
    on="floor",
    picks={"base": [[1.5, 2.25], None, [3.0, 4.0]]},
    known={"size_z": 1 / 7},
    appearance=Appearance([0.8, 1 / 3, 0.05]),
    covariance=np.diag(np.arange(1, 10) * 1e-6),
)
DRUM = Cylinder("drum", POSE, radius=0.1 / 3, height=0.17)


@pytest.fixture
def collection(blender):
    return blender.context.scene.collection


def built(thing, collection):
    from monocell.scene.objects import build_object

    return build_object(thing, collection)


def read(ob):
    from monocell.scene.objects import read_object

    return read_object(ob)


@pytest.mark.parametrize("thing", [BOX, DRUM], ids=["box", "cylinder"])
def test_an_untouched_object_comes_back_to_the_last_bit(collection, thing):
    ob = built(thing, collection)
    assert object_entry(read(ob)) == object_entry(thing)
    assert tuple(ob.scale) == (1.0, 1.0, 1.0)


@pytest.mark.parametrize("thing", [BOX, DRUM], ids=["box", "cylinder"])
def test_rebuilding_changes_the_same_object(collection, thing):
    ob = built(thing, collection)
    moved = replace(thing, world_from_object=Pose.identity(), appearance=Appearance([0, 0, 1]))
    assert built(moved, collection) == ob
    assert len(collection.objects) == 1
    assert object_entry(read(ob)) == object_entry(moved)


def test_a_saved_file_keeps_the_entry(blender, collection, tmp_path):
    built(BOX, collection)
    blender.ops.wm.save_as_mainfile(filepath=str(tmp_path / "x.blend"))
    blender.ops.wm.open_mainfile(filepath=str(tmp_path / "x.blend"))
    assert object_entry(read(blender.data.objects["block"])) == object_entry(BOX)


def test_a_move_in_blender_wins_and_drops_the_covariance(collection):
    ob = built(BOX, collection)
    ob.location.x += 0.25
    back = read(ob)
    assert back.world_from_object.translation == pytest.approx([0.66, -0.23, 1 / 3], abs=1e-6)
    assert back.covariance is None
    assert back.size.tolist() == BOX.size.tolist()
    assert back.picks == BOX.picks


def test_a_scale_in_blender_goes_into_the_sizes(collection):
    ob = built(BOX, collection)
    ob.scale = (2.0, 1.0, 0.5)
    assert read(ob).size == pytest.approx([0.4, 0.1, 0.5 / 7], rel=1e-6)
    drum = built(DRUM, collection)
    drum.scale = (1.5, 1.5, 2.0)
    assert read(drum).sizes == pytest.approx([0.05, 0.34], rel=1e-6)


def test_a_mirrored_object_is_the_same_shape(collection):
    ob = built(BOX, collection)
    ob.scale = (-1.0, 1.0, 1.0)
    back = read(ob)
    corners = sorted(map(tuple, back.corners_world().round(5)))
    assert corners == sorted(map(tuple, BOX.corners_world().round(5)))


def test_an_applied_scale_and_a_shifted_mesh_are_read_from_the_mesh(collection):
    from monocell.scene.meshes import mesh_vertices

    ob = built(replace(BOX, world_from_object=Pose.identity()), collection)
    vertices = mesh_vertices(ob.data) * [1.0, 3.0, 1.0] + [0.0, 0.05, 0.0]
    ob.data.vertices.foreach_set("co", vertices.astype(np.float32).ravel())
    back = read(ob)
    assert back.size == pytest.approx([0.2, 0.3, 1 / 7], rel=1e-6)
    assert back.world_from_object.translation == pytest.approx([0, 0.05, 0], abs=1e-7)


def test_an_edited_mesh_that_is_no_box_is_refused(collection):
    ob = built(BOX, collection)
    ob.data.vertices[3].co.x += 0.02
    with pytest.raises(InvalidValue, match=r"block: its mesh is 1\d\.\d mm off a box"):
        read(ob)


def test_a_cylinder_stretched_to_an_ellipse_is_refused(collection):
    ob = built(DRUM, collection)
    ob.scale = (1.2, 1.0, 1.0)
    with pytest.raises(InvalidValue, match=r"0\.0400 x 0\.0333"):
        read(ob)


def test_a_sheared_object_is_refused(blender, collection):
    parent = blender.data.objects.new("parent", None)
    collection.objects.link(parent)
    parent.scale = (1.0, 3.0, 1.0)
    ob = built(BOX, collection)
    ob.parent = parent
    blender.context.view_layer.update()
    with pytest.raises(InvalidValue, match="sheared"):
        read(ob)


def test_a_parent_carries_the_object_along(blender, collection):
    parent = blender.data.objects.new("parent", None)
    collection.objects.link(parent)
    ob = built(BOX, collection)
    ob.parent = parent
    parent.location = (0, 0, 2.0)
    blender.context.view_layer.update()
    assert read(ob).world_from_object.translation == pytest.approx([0.41, -0.23, 7 / 3], abs=1e-6)


def test_a_rename_and_a_new_colour_in_blender_are_taken_over(collection):
    ob = built(BOX, collection)
    ob.name = "crate"
    shader = next(n for n in ob.active_material.node_tree.nodes if n.type == "BSDF_PRINCIPLED")
    shader.inputs["Base Color"].default_value = (0.1, 0.2, 0.3, 1.0)
    back = read(ob)
    assert back.name == "crate"
    assert back.appearance.color == pytest.approx([0.1, 0.2, 0.3], abs=1e-7)


def test_a_duplicate_has_a_name_of_its_own(collection):
    ob = built(BOX, collection)
    twin = ob.copy()
    collection.objects.link(twin)
    assert {read(o).name for o in collection.objects} == {"block", "block.001"}


def test_a_name_taken_elsewhere_in_blender_does_not_change_the_objects(blender, collection):
    blender.data.objects.new("block", None)
    ob = built(BOX, collection)
    assert ob.name == "block.001"
    assert read(ob).name == "block"
    assert built(BOX, collection) == ob


def test_an_object_that_is_not_ours_is_refused(blender, collection):
    ob = blender.data.objects.new("cube", blender.data.meshes.new("cube"))
    with pytest.raises(InvalidValue, match="not made by monocell"):
        read(ob)


def test_a_cylinder_is_smooth_round_and_sharp_at_its_rims(collection):
    mesh = built(DRUM, collection).data
    normals = np.array([c.vector for c in mesh.corner_normals])
    z = np.abs(normals[:, 2])
    assert ((z < 1e-6) | (z > 1 - 1e-6)).all()
    side = [tuple(mesh.corner_normals[i].vector) for i in mesh.polygons[0].loop_indices]
    assert len({tuple(np.round(n, 5)) for n in side}) == 2


@pytest.mark.parametrize("shape", ["box", "cylinder", "sphere"])
def test_meshes_are_closed_and_face_outwards(blender, shape):
    import bmesh
    from monocell.core.shape import tessellation as meshes
    from monocell.scene.meshes import fill_mesh

    volume = {"box": 0.006, "cylinder": np.pi * 0.01 * 0.3, "sphere": 4 / 3 * np.pi * 0.001}
    made = {"box": meshes.box([0.1, 0.2, 0.3]), "cylinder": meshes.cylinder(0.1, 0.3, 512)}
    mesh = blender.data.meshes.new(shape)
    fill_mesh(mesh, made.get(shape) or meshes.sphere(0.1, 512))
    assert not mesh.validate()
    solid = bmesh.new()
    solid.from_mesh(mesh)
    assert all(edge.is_manifold for edge in solid.edges)
    assert solid.calc_volume(signed=True) == pytest.approx(volume[shape], rel=2e-4)
    solid.free()
