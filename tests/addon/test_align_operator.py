# SPDX-License-Identifier: GPL-3.0-or-later
"""Align in Blender: the sample's objects move onto the picture's edges, and nearer to the truth."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from monocell.core.document.cell_file import read_cell, write_cell
from monocell.core.modelling.solve import model_cell

pytestmark = pytest.mark.blender
SAMPLE = Path(__file__).parents[2] / "samples" / "01_table"


@pytest.fixture
def modelled(addon, tmp_path):
    """The sample as its true camera sees it, solved from a hand's picks and opened in Blender."""
    picked, truth = (read_cell(SAMPLE / f"{n}.cell.json") for n in ("table", "truth"))
    cell, _ = model_cell(replace(picked, camera=truth.camera))
    write_cell(cell, tmp_path / "modelled.cell.json")
    assert addon.ops.monocell.open_cell(filepath=str(tmp_path / "modelled.cell.json")) == {
        "FINISHED"
    }
    return cell, {thing.name: thing for thing in truth.objects}


def errors(bpy, truth, folder):
    bpy.ops.monocell.save_cell(filepath=str(folder / "now.cell.json"))
    now = read_cell(folder / "now.cell.json")
    return {
        thing.name: float(np.abs(np.sort(thing.sizes) - np.sort(truth[thing.name].sizes)).max())
        for thing in now.objects
    }


def test_all_objects_are_aligned_and_nearer_to_the_truth(addon, modelled, tmp_path):
    _, truth = modelled
    before = errors(addon, truth, tmp_path)
    assert addon.ops.monocell.align(everything=True) == {"FINISHED"}
    after = errors(addon, truth, tmp_path)
    assert np.median(list(after.values())) < 0.5 * np.median(list(before.values()))


def test_one_object_is_aligned_by_name_and_the_others_stay(addon, modelled, tmp_path):
    _, truth = modelled
    before = errors(addon, truth, tmp_path)
    assert addon.ops.monocell.align(name="crate") == {"FINISHED"}
    after = errors(addon, truth, tmp_path)
    moved = [name for name in before if after[name] != before[name]]
    assert moved == ["crate"]


def test_an_object_that_is_not_there_is_refused_in_one_line(addon, modelled):
    with pytest.raises(RuntimeError, match="nothing"):
        addon.ops.monocell.align(name="nothing")


@pytest.mark.slow
def test_what_stands_on_the_table_is_proposed_and_added(addon, modelled, tmp_path):
    cell, truth = modelled
    write_cell(replace(cell, objects=()), tmp_path / "bare.cell.json")
    addon.ops.monocell.open_cell(filepath=str(tmp_path / "bare.cell.json"))
    assert addon.ops.monocell.propose() == {"FINISHED"}
    addon.ops.monocell.save_cell(filepath=str(tmp_path / "now.cell.json"))
    found = read_cell(tmp_path / "now.cell.json").objects
    assert len(found) >= 3
    for thing in found:
        away = [
            np.linalg.norm(
                thing.world_from_object.translation - other.world_from_object.translation
            )
            for other in truth.values()
        ]
        # each stands where something does
        assert min(away) < 0.005
