# SPDX-License-Identifier: GPL-3.0-or-later
"""Colours and textures from the picture, in Blender."""

import bench_cell
import cv2
import numpy as np
import pytest
from monocell.core.document.cell_file import read_cell, write_cell
from monocell.core.shape.hits import seen_map

pytestmark = pytest.mark.blender

# linear light of the sRGB levels that the box and the drum are painted with
BOX_BGR, DRUM_BGR = (40, 60, 200), (190, 120, 40)


def linear(bgr):
    levels = np.array(bgr[::-1]) / 255
    return np.where(levels <= 0.04045, levels / 12.92, ((levels + 0.055) / 1.055) ** 2.4)


@pytest.fixture
def painted(tmp_path):
    """A document of a red box and a blue drum, and the picture of them."""
    things = (bench_cell.BOX, bench_cell.DRUM)
    seen = seen_map(things, bench_cell.CAMERA)
    picture = np.full((*seen.owner.shape, 3), 150, np.uint8)
    for index, color in enumerate((BOX_BGR, DRUM_BGR)):
        picture[seen.owner == index] = color
    cv2.imwrite(str(tmp_path / "bench.png"), picture)
    cell = bench_cell.cell_of(folder=tmp_path)
    path = tmp_path / "painted.cell.json"
    write_cell(cell.with_objects(things), path)
    return path


def opened(bpy, path):
    assert bpy.ops.monocell.open_cell(filepath=str(path)) == {"FINISHED"}
    bpy.ops.ed.undo_push(message="opened")
    return bpy.context.scene


def things(bpy, tmp_path):
    bpy.ops.monocell.save_cell(filepath=str(tmp_path / "now.cell.json"))
    return {thing.name: thing for thing in read_cell(tmp_path / "now.cell.json").objects}


def test_objects_get_the_colour_of_the_picture_in_one_undo_step(addon, painted, tmp_path):
    opened(addon, painted)
    before = things(addon, tmp_path)["box"].appearance.color
    addon.ops.monocell.take_colors("EXEC_DEFAULT", True, everything=True)
    after = things(addon, tmp_path)
    assert after["box"].appearance.color == pytest.approx(linear(BOX_BGR), abs=0.01)
    assert after["drum"].appearance.color == pytest.approx(linear(DRUM_BGR), abs=0.01)
    addon.ops.ed.undo()
    assert things(addon, tmp_path)["box"].appearance.color == pytest.approx(before, abs=1e-6)


def test_the_active_object_alone_is_coloured_unless_all_are_asked_for(addon, painted, tmp_path):
    scene = opened(addon, painted)
    before = things(addon, tmp_path)["box"].appearance.color
    addon.context.view_layer.objects.active = scene.objects["drum"]
    addon.ops.monocell.take_colors("EXEC_DEFAULT", True)
    after = things(addon, tmp_path)
    assert after["drum"].appearance.color == pytest.approx(linear(DRUM_BGR), abs=0.01)
    assert after["box"].appearance.color == pytest.approx(before, abs=1e-6)


def test_textures_lie_beside_the_document_and_on_the_mesh(addon, painted, tmp_path):
    scene = opened(addon, painted)
    addon.ops.monocell.take_textures("EXEC_DEFAULT", True, everything=True)
    box = things(addon, tmp_path)["box"]
    assert "top" in box.appearance.textures
    assert (tmp_path / box.appearance.textures["top"].picture).is_file()
    assert len(scene.objects["box"].data.materials) == 1 + len(box.appearance.textures)
    assert all(image.packed_file for image in addon.data.images if image.name.endswith("top.png"))
    # an edit keeps them on
    addon.ops.monocell.set_motion("EXEC_DEFAULT", True, name="box", kind="movable", mass=1.0)
    assert len(scene.objects["box"].data.materials) == 1 + len(box.appearance.textures)


def test_a_textured_document_opens_with_its_textures(addon, painted, tmp_path):
    opened(addon, painted)
    addon.ops.monocell.take_textures("EXEC_DEFAULT", True, everything=True)
    textured = things(addon, tmp_path)["box"]
    scene = opened(addon, tmp_path / "now.cell.json")
    ob = next(ob for ob in scene.objects if ob.name.startswith("box"))
    assert len(ob.data.materials) == 1 + len(textured.appearance.textures)


def test_a_missing_texture_is_named_when_the_document_is_opened(addon, painted, tmp_path):
    opened(addon, painted)
    addon.ops.monocell.take_textures("EXEC_DEFAULT", True, everything=True)
    box = things(addon, tmp_path)["box"]
    (tmp_path / box.appearance.textures["top"].picture).unlink()
    with pytest.raises(RuntimeError, match=r"box\.top\.png: there is no such texture"):
        addon.ops.monocell.open_cell(filepath=str(tmp_path / "now.cell.json"))


def test_without_a_saved_cell_or_blend_textures_are_refused_and_colours_are_not(
    addon, painted, tmp_path
):
    scene = opened(addon, painted)
    scene.monocell_cell.path = ""
    with pytest.raises(RuntimeError, match=r"save the \.blend file"):
        addon.ops.monocell.take_textures(everything=True)
    assert addon.ops.monocell.take_colors(everything=True) == {"FINISHED"}


def test_a_missing_picture_is_named(addon, painted):
    opened(addon, painted)
    (painted.parent / "bench.png").unlink()
    with pytest.raises(RuntimeError, match=r"bench\.png"):
        addon.ops.monocell.take_colors(everything=True)
