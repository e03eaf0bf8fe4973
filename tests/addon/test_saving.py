# SPDX-License-Identifier: GPL-3.0-or-later
"""Saving a cell document, and what a search leaves of a calibration."""

import bench_cell
import pytest
from monocell.core.document.cell_file import read_cell

pytestmark = pytest.mark.blender


def marked(module, scene):
    steps = module("addon.panels.steps")
    return [step(scene).mark for step in (steps.picture_step, steps.camera_step)]


def test_saving_makes_the_file_the_scene_s_own(addon, module, bench, tmp_path):
    addon.ops.monocell.open_cell(filepath=str(bench))
    scene, path = addon.context.scene, tmp_path / "deep" / "mine.cell.json"
    path.parent.mkdir()
    addon.ops.monocell.save_cell(filepath=str(path))
    stored = scene.monocell_cell
    assert (stored.path, stored.folder) == (str(path), str(path.parent.resolve()))
    # the document and the scene name pictures alike, and both find them
    assert read_cell(path).picture == module("addon.cell.document").bare_cell(scene).picture
    assert stored.shown_picture == read_cell(path).picture
    assert marked(module, scene) == ["done", "done"]
    assert addon.ops.monocell.show_picture(picture=stored.sightings[1].picture) == {"FINISHED"}
    assert addon.ops.monocell.calibrate() == {"FINISHED"}
    assert module("addon.modelling.looks_taken").document_of(scene) == path
    addon.ops.monocell.save_cell(filepath=str(path))
    assert [s.status for s in stored.sightings] == ["used"] * 5


def test_textures_follow_a_document_that_is_saved_elsewhere(addon, module, tmp_path):
    import json

    path = bench_cell.write_bench(tmp_path)
    addon.ops.monocell.open_cell(filepath=str(path))
    picks = json.dumps(bench_cell.box_picks())
    addon.ops.monocell.add_box("EXEC_DEFAULT", True, picks=picks)
    addon.ops.monocell.take_textures("EXEC_DEFAULT", everything=True)
    there = tmp_path / "there"
    there.mkdir()
    addon.ops.monocell.save_cell(filepath=str(there / "b.cell.json"))
    (box,) = module("addon.cell.document").read_scene(addon.context.scene).objects
    assert box.appearance.textures
    for texture in box.appearance.textures.values():
        assert texture.picture.startswith("../")
        assert (there / texture.picture).is_file()


def test_a_document_that_can_not_be_written_changes_nothing(addon, bench, tmp_path):
    addon.ops.monocell.open_cell(filepath=str(bench))
    stored = addon.context.scene.monocell_cell
    before = (stored.path, stored.folder, stored.text)
    with pytest.raises(RuntimeError, match=r"a cell document ends in \.json"):
        addon.ops.monocell.save_cell(filepath=str(tmp_path / "x.png"))
    with pytest.raises(RuntimeError, match="gone"):
        addon.ops.monocell.save_cell(filepath=str(tmp_path / "gone" / "x.cell.json"))
    assert (stored.path, stored.folder, stored.text) == before


def test_a_search_leaves_what_the_calibration_told(addon, module, bench):
    addon.ops.monocell.open_cell(filepath=str(bench))
    scene = addon.context.scene
    addon.ops.monocell.calibrate()
    report = module("addon.cell.document").stored_report
    before = report(scene)
    addon.ops.monocell.find_all()
    after = report(scene)
    assert (after.verdict, after.rms_pixels, after.surface) == (
        before.verdict,
        before.rms_pixels,
        before.surface,
    )
    assert [seen.status for seen in after.sightings] == ["found"] * 5
    assert after.searched
    step = module("addon.panels.steps").camera_step(scene)
    assert (step.mark, step.said) == ("next", "Balls were found again: calibrate to use them.")
    # the calibration after it is a new one
    addon.ops.monocell.calibrate()
    assert not report(scene).searched
    assert module("addon.panels.steps").camera_step(scene).mark == "done"


def test_a_search_before_any_calibration_tells_of_none(addon, module, raw_bench):
    addon.ops.monocell.open_cell(filepath=str(raw_bench))
    addon.ops.monocell.find_all()
    assert module("addon.cell.document").stored_report(addon.context.scene).verdict == ""
