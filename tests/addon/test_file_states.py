# SPDX-License-Identifier: GPL-3.0-or-later
"""Files saved, moved and loaded again, several cells in one, and scenes of other files."""

import json
import shutil

import bench_cell
import cv2
import numpy as np
import pytest
from monocell.core.document.cell_file import read_cell

pytestmark = pytest.mark.blender


def saved(bpy, path):
    assert bpy.ops.monocell.save_cell(filepath=str(path)) == {"FINISHED"}
    return read_cell(path)


def add_box(bpy, **options):
    picks = json.dumps(bench_cell.box_picks())
    assert bpy.ops.monocell.add_box(picks=picks, **options) == {"FINISHED"}


@pytest.fixture
def project(addon, tmp_path):
    """A folder with a document, its pictures and a .blend file of it."""
    here = tmp_path / "here"
    here.mkdir()
    addon.ops.monocell.open_cell(filepath=str(bench_cell.write_bench(here)))
    add_box(addon)
    addon.ops.wm.save_as_mainfile(filepath=str(here / "bench.blend"))
    return here


def opened(bpy, path):
    bpy.ops.wm.open_mainfile(filepath=str(path))
    return bpy.context.scene


def test_a_project_that_was_moved_as_a_whole_finds_its_pictures(addon, module, project, tmp_path):
    there = tmp_path / "there"
    project.rename(there)
    scene = opened(addon, there / "bench.blend")
    assert scene.monocell_cell.folder == str(there)
    assert scene.monocell_cell.path == str(there / "bench.cell.json")
    assert module("addon.panels.steps").picture_step(scene).mark == "done"
    assert addon.ops.monocell.calibrate() == {"FINISHED"}


def test_a_blend_file_that_was_moved_alone_still_finds_its_pictures(addon, project, tmp_path):
    alone = tmp_path / "alone"
    alone.mkdir()
    shutil.move(project / "bench.blend", alone)
    scene = opened(addon, alone / "bench.blend")
    assert scene.monocell_cell.folder == str(project)


def test_a_blend_file_without_its_pictures_says_which_and_shows_them_still(
    addon, module, project, tmp_path
):
    alone = tmp_path / "alone"
    alone.mkdir()
    shutil.move(project / "bench.blend", alone)
    shutil.rmtree(project)
    scene = opened(addon, alone / "bench.blend")
    step = module("addon.panels.steps").picture_step(scene)
    assert step.mark == "doubt"
    assert f"bench.png is no longer in {project}" in step.said
    image = scene.monocell_cell.camera.data.background_images[0].image
    assert image.packed_file is not None
    assert image.has_data or image.size[0] == bench_cell.INTRINSICS.width
    # the model needs the pictures no more
    assert [thing.name for thing in saved(addon, tmp_path / "now.cell.json").objects] == ["box"]


def test_pictures_that_went_to_several_folders_are_found_one_by_one(addon, project, tmp_path):
    one, two = tmp_path / "one", tmp_path / "two"
    one.mkdir()
    two.mkdir()
    shutil.move(project / "bench.png", one)
    for picture in project.glob("ball_*.png"):
        shutil.move(picture, two)
    assert addon.ops.monocell.find_pictures(directory=str(one)) == {"FINISHED"}
    assert addon.ops.monocell.find_pictures(directory=str(two)) == {"FINISHED"}
    with pytest.raises(RuntimeError, match="no picture of this cell is missing"):
        addon.ops.monocell.find_pictures(directory=str(two))
    assert addon.ops.monocell.calibrate() == {"FINISHED"}


def test_a_picture_of_another_size_is_not_taken_for_the_moved_one(addon, project, tmp_path):
    other = tmp_path / "other"
    other.mkdir()
    (project / "bench.png").unlink()
    cv2.imwrite(str(other / "bench.png"), np.zeros((60, 80, 3), np.uint8))
    before = addon.context.scene.monocell_cell.text
    with pytest.raises(RuntimeError, match="80 x 60 px, the camera file says 800 x 600"):
        addon.ops.monocell.find_pictures(directory=str(other))
    assert addon.context.scene.monocell_cell.text == before


def test_work_that_went_on_while_the_file_was_saved_does_not_go_on_in_it(addon, project):
    work = addon.context.window_manager.monocell_work
    work.title, work.picking = "Calibrating", True
    addon.ops.wm.save_mainfile()
    opened(addon, project / "bench.blend")
    work = addon.context.window_manager.monocell_work
    assert not work.title
    assert not work.picking


def test_two_cells_in_one_file_keep_to_themselves(addon, bench, tmp_path):
    addon.ops.monocell.open_cell(filepath=str(bench))
    first = addon.context.scene
    add_box(addon)
    addon.ops.monocell.open_cell(filepath=str(bench))
    second = addon.context.scene
    assert second != first
    add_box(addon, name="box")
    addon.ops.monocell.set_size(name="box", size="size_z", metres=0.3)
    assert saved(addon, tmp_path / "two.cell.json").objects[0].size[2] == 0.3
    addon.context.window.scene = first
    box = saved(addon, tmp_path / "one.cell.json").objects[0]
    assert box.name == "box"
    assert box.size[2] == pytest.approx(0.12, abs=1e-3)


@pytest.mark.parametrize("kind", ["FULL_COPY", "LINK_COPY", "EMPTY"])
def test_a_copied_scene_holds_a_cell_of_its_own(addon, bench, tmp_path, kind):
    addon.ops.monocell.open_cell(filepath=str(bench))
    first = addon.context.scene
    add_box(addon)
    addon.ops.scene.new(type=kind)
    second = addon.context.scene
    assert second != first
    assert addon.ops.monocell.look_through() == {"FINISHED"}
    assert second.camera == second.monocell_cell.camera
    assert second.camera in list(second.objects)
    assert (second.camera == first.camera) == (kind == "LINK_COPY")
    assert second.camera.data.background_images[0].image is not None
    # only the settings were copied, not the objects
    copied = int(kind != "EMPTY")
    assert len(saved(addon, tmp_path / "copy.cell.json").objects) == copied
    add_box(addon, name="crate")
    assert len(saved(addon, tmp_path / "copy.cell.json").objects) == copied + 1
    addon.context.window.scene = first
    names = [thing.name for thing in saved(addon, tmp_path / "first.cell.json").objects]
    assert names == (["box", "crate"] if kind == "LINK_COPY" else ["box"])


def test_a_scene_of_another_file_says_where_to_change_it(addon, project):
    addon.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    path = str(project / "bench.blend")
    with addon.data.libraries.load(path, link=True) as (there, here):
        here.scenes = list(there.scenes)
    addon.context.window.scene = next(s for s in addon.data.scenes if s.monocell_cell.text)
    with pytest.raises(
        RuntimeError, match=r"This scene is linked: open .*bench.blend to change it"
    ):
        addon.ops.monocell.solve_again()


def test_a_hidden_camera_is_shown_again_by_looking_through_it(addon, bench):
    addon.ops.monocell.open_cell(filepath=str(bench))
    scene = addon.context.scene
    camera = scene.camera
    camera.hide_set(True)
    camera.hide_viewport = True
    addon.ops.monocell.look_through()
    assert camera.visible_get()
    away = addon.data.collections.new("away")
    scene.collection.children.link(away)
    away.objects.link(camera)
    scene.collection.objects.unlink(camera)
    addon.context.view_layer.layer_collection.children["away"].exclude = True
    addon.ops.monocell.look_through()
    assert camera.visible_get()


def test_a_deleted_camera_comes_back_with_its_picture(addon, bench):
    addon.ops.monocell.open_cell(filepath=str(bench))
    scene = addon.context.scene
    addon.data.objects.remove(scene.camera)
    addon.ops.monocell.look_through()
    assert scene.camera.data.background_images[0].image is not None
