# SPDX-License-Identifier: GPL-3.0-or-later
"""Every kind of solid as a Blender object: read back exactly, edited, or refused."""

from dataclasses import replace

import numpy as np
import pytest
from monocell.core import (
    Appearance,
    Box,
    Cone,
    Cylinder,
    Motion,
    Pose,
    Prism,
    Relation,
    Sphere,
    Tube,
)
from monocell.core.document.entries import object_entry
from monocell.core.errors import InvalidValue
from monocell.core.primitives import polygon_centre

pytestmark = pytest.mark.blender

POSE = Pose.from_rotation_vector([0.3, -0.7, 1.1], [0.41, -0.23, 1 / 3])
CORNERS = np.array([[0, 0], [0.4, 0], [0.4, 0.1], [0.1, 0.1], [0.1, 0.3], [0, 0.3]])
ELL = CORNERS - polygon_centre(CORNERS)
HELD = {
    "on": "crate.top",
    "relations": (Relation("parallel", "crate.axis"), Relation("same_size", "twin", own="radius")),
    "motion": Motion("attached", to="crate", joint="hinge", axis=[0, 1, 1], limits=(-0.1, 1.5)),
    "picks": {"rim": [[1.5, 2.25], None]},
    "appearance": Appearance([0.8, 1 / 3, 0.05]),
}
SOLIDS = {
    "box": Box("it", POSE, size=[0.2, 0.1, 1 / 7]),
    "cylinder": Cylinder("it", POSE, radius=0.1 / 3, height=0.17),
    "sphere": Sphere("it", POSE, radius=0.1 / 3),
    "cone": Cone("it", POSE, radius=0.1, height=1 / 3),
    "frustum": Cone("it", POSE, radius=0.1, top_radius=0.15, height=1 / 3),
    "tube": Tube("it", POSE, radius=0.1, inner_radius=0.07, height=1 / 3),
    "prism": Prism("it", POSE, polygon=ELL, height=1 / 7),
}
EVERY = pytest.mark.parametrize("thing", SOLIDS.values(), ids=SOLIDS)


@pytest.fixture
def collection(blender):
    return blender.context.scene.collection


def built(thing, collection):
    from monocell.scene.objects import build_object

    return build_object(thing, collection)


def read(ob):
    from monocell.scene.objects import read_object

    return read_object(ob)


def edit(ob, change):
    """Replace the mesh's vertices (N, 3) by what `change` makes of them."""
    from monocell.scene.meshes import mesh_vertices

    vertices = change(mesh_vertices(ob.data))
    ob.data.vertices.foreach_set("co", np.asarray(vertices, np.float32).ravel())


def surface_points(thing):
    from monocell.core.shape.tessellation import tessellated

    return thing.world_from_object.apply(tessellated(thing).vertices)


def world_points(ob):
    from monocell.scene.meshes import mesh_vertices

    matrix = np.array(ob.matrix_basis)
    return mesh_vertices(ob.data) @ matrix[:3, :3].T + matrix[:3, 3]


def assert_same_surface(points, others, tolerance):
    """Every one of the points is near one of the others."""
    away = np.linalg.norm(points[:, None] - others[None, :: max(1, len(others) // 2000)], axis=2)
    assert away.min(axis=0).max() < tolerance


@EVERY
def test_an_untouched_object_comes_back_to_the_last_bit_with_all_that_holds_it(thing, collection):
    size = 6 + len(thing.parameters)
    whole = replace(thing, **HELD, covariance=np.diag(np.arange(1, size + 1) * 1e-6))
    assert object_entry(read(built(whole, collection))) == object_entry(whole)


@EVERY
def test_a_saved_file_keeps_it(thing, blender, collection, tmp_path):
    whole = replace(thing, **HELD)
    built(whole, collection)
    blender.ops.wm.save_as_mainfile(filepath=str(tmp_path / "x.blend"))
    blender.ops.wm.open_mainfile(filepath=str(tmp_path / "x.blend"))
    assert object_entry(read(blender.data.objects["it"])) == object_entry(whole)


@EVERY
def test_a_move_keeps_the_sizes_and_what_holds_it_and_drops_the_covariance(thing, collection):
    size = 6 + len(thing.parameters)
    ob = built(replace(thing, **HELD, covariance=1e-6 * np.eye(size)), collection)
    ob.location.x += 0.25
    back = read(ob)
    assert back.world_from_object.translation == pytest.approx([0.66, -0.23, 1 / 3], abs=1e-6)
    assert back.parameters.tolist() == thing.parameters.tolist()
    assert back.covariance is None
    assert (back.on, back.relations, back.motion.to) == ("crate.top", HELD["relations"], "crate")


@EVERY
@pytest.mark.parametrize("scale", [(2, 2, 2), (-1, 1, 1), (1, 1, -1), (-0.5, -0.5, 0.5)])
def test_a_scaled_or_mirrored_object_is_where_blender_shows_it(thing, scale, collection):
    ob = built(thing, collection)
    ob.scale = scale
    shown, back = world_points(ob), surface_points(read(ob))
    reach = np.ptp(shown, axis=0).max()
    assert_same_surface(shown, back, 0.06 * reach)
    assert_same_surface(back, shown, 0.06 * reach)
    if not isinstance(thing, Sphere | Cylinder | Tube | Cone):
        assert_same_surface(shown, back, 1e-6)


def test_a_scale_goes_into_the_sizes_that_lie_along_it(collection):
    expected = {
        "cylinder": ([1.5, 1.5, 2], [0.05, 0.34]),
        "cone": ([1.5, 1.5, 2], [0.15, 0, 2 / 3]),
        "frustum": ([2, 2, 1], [0.2, 0.3, 1 / 3]),
        "tube": ([2, 2, 3], [0.2, 0.14, 1]),
        "sphere": ([3, 3, 3], [0.1]),
        "prism": ([2, 3, 4], [4 / 7, *(ELL * [2, 3]).ravel()]),
    }
    for i, (kind, (scale, parameters)) in enumerate(expected.items()):
        ob = built(replace(SOLIDS[kind], name=f"it{i}"), collection)
        ob.scale = scale
        assert read(ob).parameters == pytest.approx(parameters, rel=1e-6), kind


@EVERY
def test_an_applied_scale_and_a_shifted_mesh_are_read_from_the_mesh(thing, collection):
    ob = built(replace(thing, world_from_object=Pose.identity()), collection)
    edit(ob, lambda v: v * 1.5 + [0.1, 0.2, -0.3])
    back = read(ob)
    assert back.parameters == pytest.approx(1.5 * thing.parameters, rel=1e-4, abs=1e-7)
    assert back.world_from_object.translation == pytest.approx([0.1, 0.2, -0.3], abs=1e-6)


@EVERY
def test_a_dent_in_the_mesh_is_refused_with_its_depth(thing, collection):
    ob = built(thing, collection)

    def dented(vertices):
        vertices[5] *= 0.8
        return vertices

    edit(ob, dented)
    with pytest.raises(InvalidValue, match=rf"it: its mesh is \d+\.\d mm off a {thing.kind}"):
        read(ob)


def test_the_upright_edges_of_a_prism_may_be_moved(collection):
    ob = built(SOLIDS["prism"], collection)

    def widened(vertices):
        vertices[[1, 7]] += [0.1, 0.0, 0.0]
        return vertices

    edit(ob, widened)
    back = read(ob)
    corners = ELL + np.where(np.arange(6)[:, None] == 1, [0.1, 0.0], 0.0)
    assert back.polygon == pytest.approx(corners - polygon_centre(corners), abs=1e-7)
    shown, there = world_points(ob), surface_points(back)
    assert_same_surface(shown, there, 1e-6)


@pytest.mark.parametrize("kind", ["sphere", "cone", "frustum", "tube", "cylinder"])
def test_what_is_stretched_until_it_is_not_round_is_refused(kind, collection):
    ob = built(SOLIDS[kind], collection)
    ob.scale = (1.2, 1.0, 1.0)
    with pytest.raises(InvalidValue, match=r"it: stretched to .* no longer round; scale x"):
        read(ob)
    ob.scale = (1.0, 1.0, 1.0)
    edit(ob, lambda v: v * [1.0, 1.2, 1.0])
    with pytest.raises(InvalidValue, match=r"it: stretched to .* no longer round"):
        read(ob)


def test_a_ball_flattened_is_refused_and_a_cylinder_made_longer_is_not(collection):
    ob = built(SOLIDS["sphere"], collection)
    ob.scale = (1.0, 1.0, 0.5)
    with pytest.raises(InvalidValue, match="scale x, y and z alike"):
        read(ob)


@pytest.mark.parametrize("kind", ["prism", "tube", "cone"])
def test_a_mesh_with_parts_missing_is_refused(kind, blender, collection):
    import bmesh

    ob = built(SOLIDS[kind], collection)
    solid = bmesh.new()
    solid.from_mesh(ob.data)
    solid.verts.ensure_lookup_table()
    gone = [v for v in solid.verts if v.co.x > 0.02]
    bmesh.ops.delete(solid, geom=gone, context="VERTS")
    solid.to_mesh(ob.data)
    solid.free()
    with pytest.raises(InvalidValue, match=r"it: (its mesh|stretched)"):
        read(ob)


def test_an_empty_and_a_flat_mesh_are_refused(collection):
    ob = built(SOLIDS["tube"], collection)
    edit(ob, lambda v: v * [1, 1, 0])
    with pytest.raises(InvalidValue, match="its mesh is flat"):
        read(ob)
    ob.data.clear_geometry()
    with pytest.raises(InvalidValue, match="its mesh is empty"):
        read(ob)


@EVERY
def test_its_mesh_is_valid_closed_and_has_its_volume(thing, blender, collection):
    import bmesh
    from monocell.core.shape.mass import volume

    mesh = built(thing, collection).data
    assert not mesh.validate()
    solid = bmesh.new()
    solid.from_mesh(mesh)
    assert all(edge.is_manifold for edge in solid.edges)
    assert solid.calc_volume(signed=True) == pytest.approx(volume(thing), rel=2e-3)
    solid.free()


def test_a_cone_is_shaded_as_a_cone_but_for_its_tip(collection):
    thing = replace(SOLIDS["cone"], world_from_object=Pose.identity())
    mesh = built(thing, collection).data
    slope = np.hypot(thing.radius, thing.height)
    for loop, corner in zip(mesh.loops, mesh.corner_normals, strict=True):
        at, normal = np.array(mesh.vertices[loop.vertex_index].co), np.array(corner.vector)
        away = np.hypot(at[0], at[1])
        if away > 0.04 * thing.radius and normal[2] > -0.9:
            outward = np.array([*(at[:2] / away * thing.height), thing.radius]) / slope
            assert normal @ outward > 0.9999
