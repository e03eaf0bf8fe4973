# SPDX-License-Identifier: GPL-3.0-or-later
"""Hand-made glTF files, written with json and struct, and what is read from them."""

from __future__ import annotations

import base64
import json
import struct
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from monocell.core import Box, Composite, Cylinder, Motion, Pose
from monocell.core.document.entries import composite_entry, object_entry
from monocell.core.errors import DocumentError
from monocell.headless.robot.glb import read_environment

CRATE = Box(
    "crate",
    Pose.from_rotation_vector([0.1, 0.2, 0.3], [0.5, 0.1, 0.2]),
    size=np.array([0.2, 0.1, 0.3]),
)
DRUM = Cylinder(
    "drum", Pose.from_rotation_vector([0, 0, 1], [0.4, -0.3, 0.1]), radius=0.06, height=0.2
)
# z up to y up, as Blender's exporter turns
Y_UP = np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
TRIANGLE = np.array([[0.0, 0, 0], [1, 0, 0], [0, 2, 0]], dtype="<f4")


def node_of(thing, pose=None):
    matrix = Y_UP @ (pose or thing.world_from_object).matrix() @ np.linalg.inv(Y_UP)
    return {
        "name": thing.name,
        "matrix": matrix.T.ravel().tolist(),
        "extras": {"monocell": object_entry(thing, with_picks=False)},
    }


def document(*nodes, roots=None, **more):
    listed = list(range(len(nodes))) if roots is None else roots
    scene = {"nodes": listed, "extras": {"monocell": {"version": 1, "camera": {"fx": 900}}}}
    return {"asset": {"version": "2.0"}, "scene": 0, "scenes": [scene], "nodes": list(nodes)} | more


def glb(content, binary=b""):
    text = json.dumps(content).encode() if isinstance(content, dict) else content
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
    if binary:
        chunks += struct.pack("<II", len(binary), 0x004E4942) + binary
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def with_triangle(*nodes, roots=None, uri=None):
    data = TRIANGLE.tobytes() + np.array([0, 1, 2, 0], dtype="<u2").tobytes()
    buffer = {"byteLength": len(data)} | ({"uri": uri} if uri else {})
    more = {
        "buffers": [buffer],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 36},
            {"buffer": 0, "byteOffset": 36, "byteLength": 6},
        ],
        "accessors": [
            {
                "bufferView": 0,
                "componentType": 5126,
                "count": 3,
                "type": "VEC3",
                "min": [0, 0, 0],
                "max": [1, 2, 0],
            },
            {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"},
        ],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
    }
    return document(*nodes, roots=roots, **more), data


def read(tmp_path, data, name="cell.glb"):
    path = tmp_path / name
    path.write_bytes(data)
    return read_environment(path)


def test_objects_come_back_exactly_with_the_scenes_extras(tmp_path):
    found = read(tmp_path, glb(document(node_of(CRATE), node_of(DRUM))))
    crate, drum = found.objects
    assert found.warnings == () and found.meshes == ()
    assert found.extras == {"version": 1, "camera": {"fx": 900}}
    assert (crate.name, drum.name) == ("crate", "drum")
    assert crate.size.tolist() == CRATE.size.tolist()
    assert (drum.radius, drum.height) == (DRUM.radius, DRUM.height)
    for got, made in ((crate, CRATE), (drum, DRUM)):
        assert np.array_equal(got.world_from_object.matrix(), made.world_from_object.matrix())


vectors = st.lists(st.floats(-3, 3), min_size=3, max_size=3)


@settings(max_examples=50, deadline=None)
@given(vectors, vectors)
def test_a_node_that_agrees_with_its_extras_is_never_warned_of(tmp_path_factory, turn, place):
    box = Box("box", Pose.from_rotation_vector(turn, place), size=np.ones(3))
    assert read(tmp_path_factory.mktemp("glb"), glb(document(node_of(box)))).warnings == ()


def test_a_node_moved_in_another_program_is_warned_of_and_its_extras_used(tmp_path):
    moved = Pose(np.eye(3), np.array([0, 0, 0.02])) @ CRATE.world_from_object
    found = read(tmp_path, glb(document(node_of(CRATE, moved))))
    assert "crate: its node stands 20.0 mm and 0.0 degrees from where" in found.warnings[0]
    assert found.objects[0].world_from_object.translation[2] == 0.2


def test_translation_rotation_and_scale_below_a_parent_are_composed(tmp_path):
    parent = {"translation": [0, 0.2, 0], "children": [1]}
    # a quarter turn about glTF's y, which is our z; the scale is the exporter's own affair
    child = node_of(
        Box("b", Pose.from_rotation_vector([0, 0, np.pi / 2], [0.1, 0, 0.2]), size=np.ones(3))
    )
    del child["matrix"]
    half = np.sqrt(0.5)
    child |= {"translation": [0.1, 0, 0], "rotation": [0, half, 0, half], "scale": [2, 3, 4]}
    assert read(tmp_path, glb(document(parent, child, roots=[0]))).warnings == ()


@pytest.mark.robot
def test_a_mesh_without_extras_arrives_as_triangles_in_the_z_up_world(tmp_path):
    node = {"name": "odd", "mesh": 0, "translation": [0.5, 1.0, 0.25], "scale": [2, 1, 1]}
    content, data = with_triangle(
        node_of(CRATE), {"name": "group", "children": [2]}, node, roots=[0, 1]
    )
    found = read(tmp_path, glb(content, data))
    assert [o.name for o in found.objects] == ["crate"]
    (mesh,) = found.meshes
    # (x, y, z) of glTF is (x, -z, y) here
    expected = [[0.5, -0.25, 1.0], [2.5, -0.25, 1.0], [0.5, -0.25, 3.0]]
    assert mesh.name == "odd"
    assert mesh.vertices[mesh.faces[0]] == pytest.approx(np.array(expected))


@pytest.mark.robot
def test_the_mesh_of_a_node_with_extras_is_not_taken_twice(tmp_path):
    content, data = with_triangle(node_of(CRATE) | {"mesh": 0})
    assert read(tmp_path, glb(content, data)).meshes == ()


@pytest.mark.robot
def test_a_text_gltf_with_its_buffer_inside_is_read_too(tmp_path):
    _, data = with_triangle()
    uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    content, _ = with_triangle({"name": "odd", "mesh": 0}, node_of(DRUM), uri=uri)
    found = read(tmp_path, json.dumps(content).encode(), "cell.gltf")
    assert len(found.meshes) == 1 and found.objects[0].name == "drum"


GOOD = glb(document(node_of(CRATE)))
BROKEN_SIZE = document(node_of(CRATE))
BROKEN_SIZE["nodes"][0]["extras"]["monocell"]["size"] = [0.2, "x", 0.3]


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"glTF\x02", "is cut short"),
        (GOOD[:-40], r"is cut short \(\d+ of \d+ bytes\)"),
        (GOOD[:4] + struct.pack("<I", 1) + GOOD[8:], "is GLB version 1"),
        (GOOD[:12] + struct.pack("<I", 10**6) + GOOD[16:], "chunk at byte 12 runs past"),
        (b"solid cube", "neither GLB nor glTF JSON"),
        (glb(b"[1, 2]"), "has no .asset."),
        (glb({"asset": {}, "nodes": 3}), "nodes: expected a list"),
        (glb({"asset": {}, "nodes": [{}], "scenes": [{"nodes": [4]}]}), "node 4 is asked for"),
        (glb(document({"children": [0]})), r"nodes\[0\] hangs in the tree twice"),
        (glb(document({"children": "all"})), r"nodes\[0\].children: expected a list"),
        (glb(document({"translation": [1, 2]})), r"nodes\[0\].translation: expected 3 numbers"),
        (glb(document({}, scene=2)), "scene 2 is asked for, there are 1"),
        (glb(BROKEN_SIZE), r"nodes\[0\]\.extras\.monocell\.size\[1\]: .*'x'"),
    ],
)
def test_a_malformed_file_is_refused_with_its_path_and_what_is_wrong(tmp_path, data, message):
    with pytest.raises(DocumentError, match=rf"cell\.glb: .*{message}"):
        read(tmp_path, data)


def test_a_missing_file_is_refused(tmp_path):
    with pytest.raises(DocumentError, match=r"none\.glb: can't be read"):
        read_environment(tmp_path / "none.glb")


def composite_node(composite, *children):
    extras = {"monocell": {"kind": "composite"} | composite_entry(composite)}
    return {"name": composite.name, "children": list(children), "extras": extras}


HUNG = replace(
    DRUM, motion=Motion("attached", to="crate", joint="hinge", axis=[0, 1, 0], density=700)
)


def test_composites_and_joints_come_back(tmp_path):
    pair = Composite("pair", ("crate", "drum"), Motion("movable", mass=4))
    nodes = (node_of(CRATE), node_of(HUNG), composite_node(pair, 0, 1))
    found = read(tmp_path, glb(document(*nodes, roots=[2])))
    assert found.warnings == ()
    assert composite_entry(found.composites[0]) == composite_entry(pair)
    assert object_entry(found.objects[1]) == object_entry(HUNG)


def test_what_hangs_on_a_node_that_is_gone_is_static_and_warned_of(tmp_path):
    pair = Composite("pair", ("crate", "drum"))
    found = read(tmp_path, glb(document(node_of(HUNG), composite_node(pair, 0), roots=[1])))
    assert found.warnings == (
        "drum: it hangs on crate, which is not there; it is taken as static",
        "pair: its parts crate are not there",
    )
    assert found.objects[0].motion.kind == "static" and found.composites[0].parts == ("drum",)


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        ({"parts": "crate"}, r"nodes\[1\]\.extras\.monocell\.parts: expected a list"),
        ({"colour": 1}, r"nodes\[1\]\.extras\.monocell\.colour: unknown key"),
        ({"name": "crate"}, r"composites\[0\]\.name: 'crate' is also objects\[0\]'s name"),
    ],
)
def test_a_composite_that_can_t_be_is_refused(tmp_path, entry, message):
    node = composite_node(Composite("pair", ("crate",)), 0)
    node["extras"]["monocell"] |= entry
    with pytest.raises(DocumentError, match=rf"cell\.glb: {message}"):
        read(tmp_path, glb(document(node_of(CRATE), node, roots=[1])))


@pytest.mark.blender
@pytest.mark.robot
def test_what_blender_exports_is_read_back_without_a_warning(tmp_path, blender):
    from monocell.core import Camera, Cell, Intrinsics
    from monocell.scene.gltf import export_gltf

    pose = Pose.looking_at([2.0, -1.0, 1.5], [0.4, 0, 0.1], [0, 0, 1])
    camera = Camera(Intrinsics(640, 480, 600, 600, 320, 240), pose)
    export_gltf(Cell(camera, objects=(CRATE, DRUM)), tmp_path / "cell.glb")
    found = read_environment(tmp_path / "cell.glb")
    assert found.warnings == () and found.meshes == ()
    by_name = {thing.name: thing for thing in found.objects}
    for made in (CRATE, DRUM):
        got = by_name[made.name]
        assert got.sizes.tolist() == made.sizes.tolist()
        assert np.array_equal(got.world_from_object.matrix(), made.world_from_object.matrix())
    assert found.extras["camera"]["fx"] == 600
