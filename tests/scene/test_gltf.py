# SPDX-License-Identifier: GPL-3.0-or-later
import json
import os
import shutil
import struct
import subprocess
from pathlib import Path

import numpy as np
import pytest
from monocell.core.appearance import Appearance
from monocell.core.camera import Camera
from monocell.core.cell import Cell
from monocell.core.composite import Composite
from monocell.core.distortion import Distortion
from monocell.core.document.entries import camera_entry, composite_entry, object_entry
from monocell.core.errors import InvalidValue, MonocellError
from monocell.core.intrinsics import Intrinsics
from monocell.core.motion import Motion
from monocell.core.pose import Pose
from monocell.core.primitives import Box, Cone, Cylinder, Prism, Sphere, Tube
from monocell.core.reference import ReferencePlane
from monocell.core.relation import Relation
from monocell.core.sketch import Sketch

pytestmark = pytest.mark.blender

LENS = Distortion("plumb_bob", np.array([-0.28, 0.09, 0.0006, -0.0004, -0.01]))
CAMERA = Camera(
    Intrinsics(1280, 960, 1200.0, 1195.0, 652.3, 471.8, LENS),
    Pose.looking_at([2.0, -1.5, 1.2], [0.1, 0.2, 0.1], [0, 0, 1.0]),
    np.diag(np.arange(1, 7) * 1e-7),
)
CELL = Cell(
    CAMERA,
    references=(ReferencePlane("floor", [0, 0, 0], [0, 0, 1]),),
    objects=(
        Box(
            "block",
            Pose.from_rotation_vector([0, 0, 0.4], [0.4, 0.2, 0.05]),
            size=[0.2, 0.15, 0.1],
            on="floor",
            picks={"base": [[1, 2], None]},
            appearance=Appearance([0.7, 0.1, 0.1]),
            covariance=np.diag(np.arange(1, 10) * 1e-6),
        ),
        Cylinder("drum", Pose.identity(), radius=1 / 30, height=0.17),
        Cylinder("lying", POSE_LYING := Pose.from_rotation_vector([1.2, 0.3, 0], [0, 1, 2]),
                 radius=1 / 30, height=0.17),
    ),
)  # fmt: skip
HINGE = Motion("attached", to="block", joint="hinge", axis=[0, 1, 0], limits=(-1, 2), mass=0.4)
EVERY_KIND = Cell(
    CAMERA,
    references=CELL.references,
    objects=(
        *CELL.objects,
        Sphere("ball", Pose.identity(), radius=0.04, motion=Motion("movable", density=700)),
        Cone("cone", POSE_LYING, radius=0.05, height=0.2),
        Cone("frustum", POSE_LYING, radius=0.05, top_radius=0.03, height=0.2, motion=HINGE),
        Tube("tube", POSE_LYING, radius=0.05, inner_radius=0.03, height=0.2),
        Prism("wedge", POSE_LYING, polygon=[[-1, -1], [1, -1], [0, 2]], height=0.2,
              relations=(Relation("lies_on", "block.top"), Relation("parallel", "drum.axis"))),
        Prism("other", POSE_LYING, polygon=[[-2, -1], [2, -1], [0, 2]], height=0.2),
    ),
    sketches=(Sketch("picked", "box", None, {}), Sketch("too", "box", None, {})),
    composites=(
        Composite("arm", ("drum", "lying", "picked"), Motion("movable", mass=3)),
        Composite("left out", ("too",)),
        Composite("group", ("tube",)),
    ),
)  # fmt: skip
YUP_FROM_ZUP = np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0.0]])


def exported(cell, path):
    from monocell.scene.gltf import export_gltf

    export_gltf(cell, path)
    data = path.read_bytes()
    (length,) = struct.unpack_from("<I", data, 12)
    return json.loads(data[20 : 20 + length])


def nodes_of(document):
    return {node["name"]: node for node in document["nodes"]}


def test_every_node_carries_its_entry_without_picks(blender, tmp_path):
    nodes = nodes_of(exported(CELL, tmp_path / "cell.glb"))
    for thing in CELL.objects:
        entry = object_entry(thing, with_picks=False)
        assert nodes[thing.name]["extras"]["monocell"] == entry


def test_the_scene_carries_the_whole_camera(blender, tmp_path):
    document = exported(CELL, tmp_path / "cell.glb")
    extras = document["scenes"][0]["extras"]
    assert extras["monocell"]["camera"] == camera_entry(CAMERA)
    assert extras["monocell"]["references"][0]["name"] == "floor"
    assert len(document["scenes"]) == 1


def test_nodes_stand_where_the_objects_do_with_y_up(blender, tmp_path):
    nodes = nodes_of(exported(CELL, tmp_path / "cell.glb"))
    for thing in CELL.objects:
        place = thing.world_from_object.translation
        found = nodes[thing.name].get("translation", [0, 0, 0])
        assert found == pytest.approx(YUP_FROM_ZUP @ place, abs=1e-6)
        assert "scale" not in nodes[thing.name]


def test_objects_of_one_shape_and_colour_share_a_mesh(blender, tmp_path):
    document = exported(CELL, tmp_path / "cell.glb")
    nodes = nodes_of(document)
    assert nodes["drum"]["mesh"] == nodes["lying"]["mesh"] != nodes["block"]["mesh"]
    assert len(document["meshes"]) == 2


def test_every_kind_carries_what_it_is_and_how_it_moves(blender, tmp_path):
    document = exported(EVERY_KIND, tmp_path / "cell.glb")
    nodes = nodes_of(document)
    for thing in EVERY_KIND.objects:
        assert nodes[thing.name]["extras"]["monocell"] == object_entry(thing, with_picks=False)
    # two prisms of one height are two meshes all the same
    assert nodes["wedge"]["mesh"] != nodes["other"]["mesh"]


def test_a_composite_is_a_node_without_mesh_above_its_solved_parts(blender, tmp_path):
    document = exported(EVERY_KIND, tmp_path / "cell.glb")
    nodes = nodes_of(document)
    arm = nodes["arm"]
    assert {document["nodes"][i]["name"] for i in arm["children"]} == {"drum", "lying"}
    assert "mesh" not in arm and "translation" not in arm and "rotation" not in arm
    entry = composite_entry(Composite("arm", ("drum", "lying"), Motion("movable", mass=3)))
    assert arm["extras"]["monocell"] == {"kind": "composite"} | entry
    assert "left out" not in nodes and len(nodes["group"]["children"]) == 1
    roots = [document["nodes"][i]["name"] for i in document["scenes"][0]["nodes"]]
    assert "drum" not in roots and "arm" in roots


def test_the_users_scene_stays_as_it_was(blender, tmp_path):
    from monocell.scene.objects import build_object

    scene = blender.context.scene
    ob = build_object(CELL.objects[0], scene.collection)
    kinds = ("objects", "meshes", "materials", "scenes", "cameras", "collections", "images")
    before = {kind: set(getattr(blender.data, kind).keys()) for kind in kinds}
    nodes = nodes_of(exported(CELL, tmp_path / "cell.glb"))
    assert {kind: set(getattr(blender.data, kind).keys()) for kind in kinds} == before
    assert blender.context.scene == scene
    assert ob.name == "block"
    assert set(nodes) == {"block", "drum", "lying", "camera"}


def test_a_cell_without_camera_pose_or_objects_is_exported(blender, tmp_path):
    document = exported(Cell(Camera(CAMERA.intrinsics)), tmp_path / "cell.glb")
    assert "nodes" not in document
    assert "camera_from_world" not in document["scenes"][0]["extras"]["monocell"]["camera"]


def test_nothing_is_printed(blender, tmp_path, capfd):
    exported(CELL, tmp_path / "cell.glb")
    assert capfd.readouterr().out == ""


def test_a_missing_folder_or_another_ending_is_refused_and_leaves_nothing(blender, tmp_path):
    from monocell.scene.gltf import export_gltf

    with pytest.raises(MonocellError, match="folder"):
        export_gltf(CELL, tmp_path / "no" / "cell.glb")
    with pytest.raises(InvalidValue, match=r"name it \.glb"):
        export_gltf(CELL, tmp_path / "cell.obj")
    assert list(tmp_path.iterdir()) == []
    assert len(blender.data.scenes) == 1


@pytest.mark.parametrize("cell", [CELL, EVERY_KIND, Cell(CAMERA)], ids=["full", "every", "empty"])
def test_the_khronos_validator_has_nothing_to_say(blender, tmp_path, cell):
    if shutil.which("node") is None:
        pytest.skip("no node here: the Khronos validator runs on it")
    exported(cell, tmp_path / "cell.glb")
    script = Path(__file__).with_name("validate_gltf.mjs")
    command = ["node", str(script), str(tmp_path / "cell.glb")]
    done = subprocess.run(command, capture_output=True, text=True, env=os.environ, check=False)
    if "Cannot find module 'gltf-validator'" in done.stderr:
        pytest.skip("no gltf-validator: npm install gltf-validator (NODE_PATH is honoured)")
    assert done.returncode == 0, done.stderr
    issues = json.loads(done.stdout)
    assert issues["numErrors"] == issues["numWarnings"] == 0, issues["messages"]
