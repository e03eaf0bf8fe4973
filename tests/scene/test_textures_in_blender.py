# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import json
import os
import shutil
import struct
import subprocess
from pathlib import Path

import cv2
import numpy as np
import pytest
from monocell.core.appearance import Appearance, Texture
from monocell.core.camera import Camera
from monocell.core.cell import Cell
from monocell.core.distortion import Distortion
from monocell.core.errors import PictureError
from monocell.core.intrinsics import Intrinsics
from monocell.core.look.textures import eight_bit_srgb
from monocell.core.pose import Pose
from monocell.core.primitives import (
    Box,
    Cone,
    Cylinder,
    Prism,
    Sphere,
    Tube,
    polygon_centre,
)
from monocell.core.shape.charts import chart_of
from monocell.core.shape.hits import face_names, seen_map

pytestmark = pytest.mark.blender

LENS = Distortion("plumb_bob", np.array([-0.2, 0.06, 0.0006, -0.0004, 0.0]))
CAMERA = Camera(
    Intrinsics(160, 120, 190.0, 189.0, 88.0, 52.0, LENS),
    Pose.looking_at([0.9, -0.7, 0.8], [0.0, 0.05, 0.08], [0, 0, 1.0]),
)
# quarters of a face: top left, top right, bottom left, bottom right; blue, green, red
QUARTERS = np.array([[40, 40, 220], [40, 200, 40], [220, 60, 40], [30, 210, 230]], np.uint8)
PLAIN = np.array([0.5, 0.1, 0.4])


def quartered(folder, thing, place=None):
    """The thing with four colours on each face, its corners told apart."""
    textures = {}
    for number, face in enumerate(face_names(thing)):
        # each face has its own order, so that no face passes for another
        q = np.roll(QUARTERS, number, axis=0).reshape(2, 2, 3)
        pixels = q.repeat(20, axis=0).repeat(20, axis=1)
        alpha = np.zeros((40, 40, 1), np.uint8)
        name = f"{thing.name}.{face}.png"
        cv2.imwrite(str(folder / name), np.concatenate([pixels, alpha], axis=2))
        textures[face] = Texture(name, 0.5)
    return type(thing)(
        thing.name, place or thing.world_from_object, appearance=Appearance(PLAIN, textures),
        **{name: getattr(thing, name)
           for name in ("size", "radius", "height", "top_radius", "inner_radius", "polygon")
           if hasattr(thing, name)},
    )  # fmt: skip


@pytest.fixture
def cell(tmp_path):
    turn = Pose.from_rotation_vector([0, 0, 0.35], [0.0, -0.12, 0.09])
    things = (
        quartered(tmp_path, Box("crate", turn, size=[0.24, 0.2, 0.18])),
        quartered(
            tmp_path, Cylinder("drum", Pose(np.eye(3), [0, 0.2, 0.1]), radius=0.09, height=0.2)
        ),
    )
    return Cell(CAMERA, objects=things, folder=tmp_path)


def expected(cell):
    """The picture (H, W, 3) BGR by each pixel's own ray, and where it is clear of any edge."""
    seen = seen_map(cell.objects, cell.camera)
    rows, columns = np.nonzero(seen.owner >= 0)
    origin, rays = cell.camera.rays_world(np.stack([columns, rows], 1))
    points = origin + seen.depth[rows, columns][:, None] * rays
    picture = np.zeros((*seen.owner.shape, 3), np.uint8)
    label = np.full(seen.owner.shape, -1)
    for index, thing in enumerate(cell.objects):
        own = thing.world_from_object.inverse().apply(points)
        for number, face in enumerate(face_names(thing)):
            here = (seen.owner[rows, columns] == index) & (seen.face[rows, columns] == number)
            s, t = chart_of(thing, face).coordinates(own[here]).T
            quarter = (t >= 0.5) * 2 + (s >= 0.5)
            colors = np.roll(QUARTERS, number, axis=0)
            picture[rows[here], columns[here]] = colors[quarter]
            label[rows[here], columns[here]] = 100 * index + 10 * number + quarter
    inner = np.ones(label.shape, dtype=bool)
    for down in (-2, 0, 2):
        for across in (-2, 0, 2):
            inner &= np.roll(label, (down, across), (0, 1)) == label
    return picture, inner & (label >= 0)


def eight_bits(light):
    return eight_bit_srgb(light)[..., ::-1]


POLYGON = np.array([[0.2, 0], [0.05, 0.17], [-0.15, 0.1], [-0.02, 0.02], [-0.1, -0.15]])
OTHERS = (
    Cone("bucket", Pose.identity(), radius=0.1, top_radius=0.17, height=0.2),
    Cone("tip", Pose.identity(), radius=0.18, height=0.25),
    Tube("tube", Pose.identity(), radius=0.17, inner_radius=0.14, height=0.12),
    Sphere("ball", Pose.identity(), radius=0.16),
    Prism("prism", Pose.identity(), polygon=POLYGON - polygon_centre(POLYGON), height=0.15),
)


@pytest.mark.parametrize("upside_down", [False, True], ids=["upright", "upside down"])
@pytest.mark.parametrize("thing", OTHERS, ids=lambda thing: thing.name)
def test_each_face_of_every_solid_shows_its_own_picture(blender, tmp_path, thing, upside_down):
    from monocell.scene.flat_view import flat_view

    turn = Pose.from_rotation_vector([np.pi * upside_down, 0, 0.4], [0.0, 0.05, 0.08])
    cell = Cell(CAMERA, objects=(quartered(tmp_path, thing, turn),), folder=tmp_path)
    picture, inner = expected(cell)
    shown = eight_bits(flat_view(cell, samples=16))
    assert inner.sum() > 150
    assert (np.abs(shown[inner].astype(int) - picture[inner]).max(axis=1) <= 3).mean() > 0.995


def test_each_face_shows_its_picture_the_right_way_up(blender, cell):
    from monocell.scene.flat_view import flat_view

    picture, inner = expected(cell)
    shown = eight_bits(flat_view(cell, samples=16))
    assert inner.sum() > 500
    assert np.abs(shown[inner].astype(int) - picture[inner]).max() <= 3


def test_a_window_of_the_flat_view_is_that_part_of_it(blender, cell):
    from monocell.core.errors import InvalidValue
    from monocell.scene.flat_view import flat_view

    picture, inner = expected(cell)
    shown = eight_bits(flat_view(cell, window=(40, 20, 80, 60), samples=16))
    part = inner[20:80, 40:120]
    assert shown.shape == (60, 80, 3)
    assert np.abs(shown[part].astype(int) - picture[20:80, 40:120][part]).max() <= 3
    with pytest.raises(InvalidValue, match="not inside the picture"):
        flat_view(cell, window=(140, 20, 80, 60))


def test_an_object_in_a_scene_keeps_its_textures(blender, cell):
    from monocell.scene.objects import build_object, read_object

    ob = build_object(cell.objects[0], blender.context.scene.collection)
    assert read_object(ob).appearance.textures == cell.objects[0].appearance.textures


def glb_of(cell, path):
    from monocell.scene.gltf import export_gltf

    export_gltf(cell, path)
    data = path.read_bytes()
    (length,) = struct.unpack_from("<I", data, 12)
    return json.loads(data[20 : 20 + length]), data[20 + length + 8 :]


def test_the_glb_holds_the_files_as_they_are_and_what_was_seen(blender, cell, tmp_path):
    document, rest = glb_of(cell, tmp_path / "cell.glb")
    assert len(document["images"]) == 9
    for image in document["images"]:
        view = document["bufferViews"][image["bufferView"]]
        start = view.get("byteOffset", 0)
        embedded = rest[start : start + view["byteLength"]]
        assert image["mimeType"] == "image/png"
        assert embedded == (tmp_path / f"{image['name']}.png").read_bytes()
    node = next(node for node in document["nodes"] if node["name"] == "crate")
    texture = node["extras"]["monocell"]["appearance"]["textures"]["top"]
    assert texture == {"picture": "crate.top.png", "seen": 0.5}
    # a viewer that knows alpha must not see through what was made up
    assert all(m.get("alphaMode", "OPAQUE") == "OPAQUE" for m in document["materials"])


def test_the_glb_names_textures_from_where_it_lies(blender, cell, tmp_path):
    folder = tmp_path / "elsewhere"
    folder.mkdir()
    document, _ = glb_of(cell, folder / "cell.glb")
    looks = [
        node["extras"]["monocell"].get("appearance", {})
        for node in document["nodes"]
        if "monocell" in node.get("extras", {})
    ]
    names = [t["picture"] for look in looks for t in look.get("textures", {}).values()]
    assert names
    for name in names:
        assert (folder / name).is_file(), name


def test_the_glb_shows_the_same_when_another_program_opens_it(blender, cell, tmp_path):
    from monocell.scene.rendering import render_linear
    from monocell.scene.textures import shader_of

    glb_of(cell, tmp_path / "cell.glb")
    blender.ops.import_scene.gltf(filepath=str(tmp_path / "cell.glb"))
    for material in blender.data.materials:
        shader = shader_of(material)
        if shader is None or not shader.inputs["Base Color"].is_linked:
            continue
        # without light of its own: what the base colour is
        link = shader.inputs["Base Color"].links[0]
        links = material.node_tree.links
        links.new(link.from_socket, shader.inputs["Emission Color"])
        links.remove(link)
        shader.inputs["Base Color"].default_value = (0, 0, 0, 1)
        shader.inputs["Specular IOR Level"].default_value = 0.0
        shader.inputs["Emission Strength"].default_value = 1.0
    picture, inner = expected(cell)
    shown = eight_bits(render_linear(blender.context.scene, CAMERA, samples=16, bounces=0))
    assert np.abs(shown[inner].astype(int) - picture[inner]).max() <= 3


def test_the_validator_finds_nothing(blender, cell, tmp_path):
    if shutil.which("node") is None:
        pytest.skip("no node here: the Khronos validator runs on it")
    glb_of(cell, tmp_path / "cell.glb")
    script = Path(__file__).with_name("validate_gltf.mjs")
    command = ["node", str(script), str(tmp_path / "cell.glb")]
    done = subprocess.run(command, capture_output=True, text=True, env=os.environ, check=False)
    if "Cannot find module 'gltf-validator'" in done.stderr:
        pytest.skip("no gltf-validator: npm install gltf-validator (NODE_PATH is honoured)")
    issues = json.loads(done.stdout)
    assert issues["numErrors"] == issues["numWarnings"] == 0, issues["messages"]


@pytest.mark.parametrize("content", [None, b"", b"no picture"])
def test_a_texture_that_is_not_there_or_no_picture_is_refused(blender, cell, tmp_path, content):
    from monocell.scene.flat_view import flat_view

    kinds = ("objects", "meshes", "materials", "scenes", "cameras", "images")
    (tmp_path / "crate.top.png").unlink()
    if content is not None:
        (tmp_path / "crate.top.png").write_bytes(content)
    before = {kind: set(getattr(blender.data, kind).keys()) for kind in kinds}
    with pytest.raises(PictureError, match=r"crate\.top\.png"):
        glb_of(cell, tmp_path / "cell.glb")
    with pytest.raises(PictureError, match=r"crate\.top\.png"):
        flat_view(cell)
    assert not (tmp_path / "cell.glb").exists()
    assert {kind: set(getattr(blender.data, kind).keys()) for kind in kinds} == before


def test_nothing_is_left_in_blender(blender, cell, tmp_path):
    from monocell.scene.flat_view import flat_view
    from monocell.scene.stage import Stage
    from monocell.scene.work_cell import WorkCell

    kinds = ("objects", "meshes", "materials", "scenes", "cameras", "images", "worlds")
    before = {kind: set(getattr(blender.data, kind).keys()) for kind in kinds}
    glb_of(cell, tmp_path / "cell.glb")
    flat_view(cell, samples=1)
    with Stage(WorkCell(CAMERA, cell.objects, folder=tmp_path)) as stage:
        stage.linear(samples=1)
    after = {kind: set(getattr(blender.data, kind).keys()) for kind in kinds}
    # Blender keeps the picture it rendered last
    after["images"] -= {"Render Result", "Viewer Node"}
    before["images"] -= {"Render Result", "Viewer Node"}
    assert after == before


def test_a_cell_is_rendered_with_its_textures_and_its_truth_finds_them(blender, cell, tmp_path):
    from monocell.core.document.cell_file import read_cell, write_cell
    from monocell.headless.cli import main

    write_cell(cell, tmp_path / "x.cell.json")
    assert main(["render", str(tmp_path / "x.cell.json"), str(tmp_path / "out")]) == 0
    truth = read_cell(tmp_path / "out" / "truth.cell.json")
    texture = truth.objects[0].appearance.textures["top"]
    assert texture.picture == "../crate.top.png"
    picture, (_, inner) = cv2.imread(str(tmp_path / "out" / "cell.png")), expected(cell)
    # light and shade change the colours, not which of them is strongest
    assert (picture[inner].argmax(axis=1) == expected(cell)[0][inner].argmax(axis=1)).mean() > 0.9
