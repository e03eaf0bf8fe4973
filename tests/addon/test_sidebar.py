# SPDX-License-Identifier: GPL-3.0-or-later
"""Which panels of the sidebar are there, step by step."""

import json

import bench_cell
import pytest

pytestmark = pytest.mark.blender

# each with the module that holds it
PANELS = {
    "LensPanel": "panel_picture",
    "AccuracyPanel": "panel_camera",
    "SightingsPanel": "panel_camera",
    "ObjectPanel": "panel_object",
    "ReferencesPanel": "panel_model",
    "AllObjectsPanel": "panel_model",
}


@pytest.fixture
def shown(addon, module):
    def names():
        classes = {name: getattr(module(f"addon.panels.{at}"), name) for name, at in PANELS.items()}
        return {name for name, cls in classes.items() if cls.poll(addon.context)}

    return names


def test_an_empty_scene_has_the_four_steps_alone(addon, shown):
    assert shown() == set()


def test_before_the_calibration_only_the_lens_and_more_sightings_fold(addon, shown, raw_bench):
    addon.ops.monocell.open_cell(filepath=str(raw_bench))
    assert shown() == {"LensPanel", "SightingsPanel"}


def test_the_object_s_panel_comes_with_the_object(addon, shown, bench):
    addon.ops.monocell.open_cell(filepath=str(bench))
    folded = {"LensPanel", "AccuracyPanel", "SightingsPanel", "ReferencesPanel", "AllObjectsPanel"}
    assert shown() == folded
    picks = json.dumps(bench_cell.box_picks())
    addon.ops.monocell.add_box("EXEC_DEFAULT", True, picks=picks)
    assert shown() == {*folded, "ObjectPanel"}


def test_the_calibration_is_told_in_one_line_in_the_user_s_unit(addon, module, bench):
    addon.ops.monocell.open_cell(filepath=str(bench))
    addon.ops.monocell.calibrate()
    told, report = (
        module("addon.panels.panel_camera").verdict,
        module("addon.cell.document").stored_report,
    )
    first = told(report(addon.context.scene), "mm")
    assert first.endswith(" mm on floor") and ": ± " in first
    assert told(report(addon.context.scene), "in").endswith(" in on floor")
    addon.ops.monocell.find_all()
    assert "before the search: ± " in told(report(addon.context.scene), "mm")


def test_a_lock_of_a_size_that_the_object_has_not_changes_nothing(addon, module, bench, capfd):
    addon.ops.monocell.open_cell(filepath=str(bench))
    picks = json.dumps(bench_cell.drum_picks())
    addon.ops.monocell.add_cylinder("EXEC_DEFAULT", True, picks=picks)
    addon.context.scene.monocell_object.known_2 = True
    (drum,) = module("addon.cell.document").read_scene(addon.context.scene).objects
    assert drum.known == {}
    assert "Traceback" not in "".join(capfd.readouterr())
