# SPDX-License-Identifier: GPL-3.0-or-later
"""OBJ, STL, PLY, USD and separate glTF: sizes, places, names, colours and textures read back."""

from __future__ import annotations

import json
import shutil

import numpy as np
import pytest
from monocell.core import (
    Appearance,
    Box,
    Camera,
    Cell,
    Composite,
    Cone,
    Cylinder,
    Intrinsics,
    Motion,
    Pose,
    Sphere,
)
from monocell.core.appearance import Texture
from monocell.core.errors import DocumentError, InvalidValue, PictureError, RenderFailed
from monocell.core.formats.endings import FORMATS
from monocell.core.formats.text_formats import WRITERS
from monocell.core.shape.mass import volume

pytestmark = pytest.mark.blender

CAMERA = Camera(
    Intrinsics(640, 480, 600.0, 600.0, 330.0, 236.0),
    Pose.looking_at([1.5, -1.2, 1.0], [0.4, 0, 0], [0, 0, 1]),
)
TURNED = Pose.from_rotation_vector([0.3, -0.2, 0.8], [0.5, 0.2, 0.1])
RED = Appearance(np.array([0.6, 0.05, 0.02]))
THINGS = (
    Box("Kiste 1", TURNED, size=[0.3, 0.2, 0.1], appearance=RED),
    Cylinder("drum", Pose(np.eye(3), [0.1, -0.3, 0.2]), radius=0.08, height=0.4),
    Cone("Kegel", Pose(np.eye(3), [0.9, 0, 0.1]), radius=0.1, height=0.2),
    Sphere("kiste-1", Pose(np.eye(3), [0, 0.6, 0.05]), radius=0.05),
)
NAMES = ("Kiste_1", "drum", "Kegel", "kiste_1_2")
CELL = Cell(CAMERA, objects=THINGS, composites=(Composite("both", ("Kiste 1", "drum")),))
MESHES = (".obj", ".stl", ".ply")
USD = (".usd", ".usda", ".usdc", ".usdz")


def export(cell, path):
    from monocell.scene.export import export_cell

    return export_cell(cell, path)


def truth(things=THINGS):
    """The corner nearest the origin and that farthest from it, of all objects together."""
    from monocell.core.shape.tessellation import tessellated

    points = [t.world_from_object.apply(tessellated(t).vertices) for t in things]
    points = np.concatenate(points)
    return points.min(axis=0), points.max(axis=0)


def test_every_ending_that_is_offered_has_a_writer():
    from monocell.scene.mesh_formats import EXPORTERS

    assert set(FORMATS) == {".glb", ".gltf"} | set(WRITERS) | set(EXPORTERS)


@pytest.mark.parametrize("ending", MESHES)
def test_meshes_have_the_volume_and_the_extent_of_the_cell_z_up_in_metres(
    blender, ending, tmp_path
):
    trimesh = pytest.importorskip("trimesh")
    assert export(CELL, tmp_path / f"cell{ending}") == ()
    mesh = trimesh.load(tmp_path / f"cell{ending}", force="mesh")
    np.testing.assert_allclose(mesh.bounds, truth(), atol=2e-6)
    assert mesh.volume == pytest.approx(sum(map(volume, THINGS)), rel=2e-3)


def test_an_obj_keeps_names_that_are_plain_and_apart_and_its_colours(blender, tmp_path):
    export(CELL, tmp_path / "cell.obj")
    lines = (tmp_path / "cell.obj").read_text().splitlines()
    assert lines[0] == "# monocell: metres, z up"
    assert {line[2:] for line in lines if line.startswith("o ")} == set(NAMES)
    colors = [line for line in (tmp_path / "cell.mtl").read_text().splitlines() if "Kd" in line]
    assert "Kd 0.600000 0.050000 0.020000" in colors
    assert sorted(file.name for file in tmp_path.iterdir()) == ["cell.mtl", "cell.obj"]


def test_a_ply_has_the_colours_srgb_encoded(blender, tmp_path):
    trimesh = pytest.importorskip("trimesh")
    export(CELL, tmp_path / "cell.ply")
    mesh = trimesh.load(tmp_path / "cell.ply", process=False)
    local = TURNED.inverse().apply(mesh.vertices)
    inside = (np.abs(local) < THINGS[0].size / 2 + 1e-6).all(axis=1)
    assert inside.sum() >= 8
    wanted = [round(255 * (1.055 * c ** (1 / 2.4) - 0.055)) for c in RED.color]
    assert np.abs(mesh.visual.vertex_colors[inside][:, :3].astype(int) - wanted).max() <= 1


@pytest.mark.parametrize("ending", USD)
def test_usd_comes_back_with_its_names_places_sizes_and_camera(blender, ending, tmp_path):
    if "usd_export" not in dir(blender.ops.wm):
        pytest.skip("this Blender has no USD")
    export(CELL, tmp_path / f"cell{ending}")
    blender.ops.wm.usd_import(filepath=str(tmp_path / f"cell{ending}"), set_frame_range=False)
    blender.context.view_layer.update()
    meshes = {}
    for ob in blender.data.objects:
        if ob.type == "MESH":
            points = [ob.matrix_world @ vertex.co for vertex in ob.data.vertices]
            meshes[ob.name.split(".")[0]] = np.array(points)
    assert set(meshes) == set(NAMES)
    for thing, name in zip(THINGS, NAMES, strict=True):
        low, high = truth((thing,))
        np.testing.assert_allclose(meshes[name].min(axis=0), low, atol=2e-6)
        np.testing.assert_allclose(meshes[name].max(axis=0), high, atol=2e-6)
    (camera,) = (ob for ob in blender.data.objects if ob.type == "CAMERA")
    np.testing.assert_allclose(camera.matrix_world.translation, CAMERA.centre_world, atol=2e-6)


def test_usd_is_z_up_in_metres(blender, tmp_path):
    export(CELL, tmp_path / "cell.usda")
    text = (tmp_path / "cell.usda").read_text(encoding="utf-8")
    assert 'upAxis = "Z"' in text and "metersPerUnit = 1\n" in text


def test_separate_gltf_carries_the_same_extras_and_names_as_one_file(blender, tmp_path):
    export(CELL, tmp_path / "cell.gltf")
    document = json.loads((tmp_path / "cell.gltf").read_text(encoding="utf-8"))
    assert {node["name"] for node in document["nodes"]} == {
        *(thing.name for thing in THINGS),
        "both",
        "camera",
    }
    assert document["scenes"][0]["extras"]["monocell"]["camera"]["fx"] == 600.0
    assert [buffer["uri"] for buffer in document["buffers"]] == ["cell.bin"]
    assert sorted(file.name for file in tmp_path.iterdir()) == ["cell.bin", "cell.gltf"]


@pytest.mark.parametrize("ending", [".gltf", ".obj", ".usda"])
def test_textures_go_along_beside_the_file(blender, ending, tmp_path):
    source, out = tmp_path / "cell", tmp_path / "out"
    source.mkdir()
    out.mkdir()
    image = blender.data.images.new("face", 8, 8)
    image.filepath_raw, image.file_format = str(source / "cell.box.top.png"), "PNG"
    image.save()
    look = Appearance(np.array([0.5, 0.5, 0.5]), {"top": Texture("cell.box.top.png")})
    box = Box("box", TURNED, size=[0.3, 0.2, 0.1], appearance=look)
    export(Cell(CAMERA, objects=(box,), folder=source), out / f"my{ending}")
    pictures = list(out.rglob("*.png"))
    assert len(pictures) == 1
    text = (out / "my.mtl" if ending == ".obj" else out / f"my{ending}").read_text("utf-8")
    assert pictures[0].relative_to(out).as_posix() in text
    shutil.rmtree(source)
    with pytest.raises(PictureError, match="there is no such texture"):
        export(Cell(CAMERA, objects=(box,), folder=source), out / f"other{ending}")
    assert not list(out.glob("*other*"))


@pytest.mark.parametrize("ending", [*MESHES, ".usda", ".gltf"])
def test_an_empty_cell_without_a_camera_pose_is_a_file_or_a_refusal_in_words(
    blender, ending, tmp_path
):
    try:
        export(Cell(Camera(CAMERA.intrinsics)), tmp_path / f"cell{ending}")
    except RenderFailed as error:
        assert "is anything modelled?" in str(error)
        assert list(tmp_path.iterdir()) == []
    else:
        assert (tmp_path / f"cell{ending}").stat().st_size > 0


def test_the_user_s_scene_keeps_its_names_and_nothing_is_left_behind(blender, tmp_path):
    kept = blender.data.objects.new("drum", blender.data.meshes.new("drum"))
    blender.context.scene.collection.objects.link(kept)
    counts = [len(blender.data.meshes), len(blender.data.materials), len(blender.data.scenes)]
    export(CELL, tmp_path / "cell.obj")
    text = (tmp_path / "cell.obj").read_text()
    assert "\no drum\n" in text and "drum.001" not in text
    assert [ob.name for ob in blender.data.objects] == ["drum"]
    after = [len(blender.data.meshes), len(blender.data.materials), len(blender.data.scenes)]
    assert after == counts


def test_what_moves_is_where_it_stands(blender, tmp_path):
    trimesh = pytest.importorskip("trimesh")
    lid = Box(
        "lid",
        TURNED,
        size=[0.3, 0.2, 0.1],
        motion=Motion("attached", to="drum", joint="hinge", axis=[1.0, 0, 0]),
    )
    export(Cell(CAMERA, objects=(THINGS[1], lid)), tmp_path / "cell.stl")
    mesh = trimesh.load(tmp_path / "cell.stl")
    np.testing.assert_allclose(mesh.bounds, truth((THINGS[1], lid)), atol=2e-6)


def test_what_can_t_be_written_is_told_in_one_line(blender, tmp_path):
    with pytest.raises(InvalidValue, match=r"no format ends in \.dae; name it one of \.glb"):
        export(CELL, tmp_path / "cell.dae")
    with pytest.raises(DocumentError, match="is not there; make it first"):
        export(CELL, tmp_path / "no" / "cell.obj")
    assert list(tmp_path.iterdir()) == []
