# SPDX-License-Identifier: GPL-3.0-or-later
"""The cells that come along: what they give away of the truth, and what they do not."""

from pathlib import Path

import cv2
import numpy as np
import pytest
from monocell.core.document.cell_file import read_cell

SAMPLES = Path(__file__).resolve().parents[2] / "samples"
STACK, TABLE = SAMPLES / "03_stack" / "stack.cell.json", SAMPLES / "01_table" / "table.cell.json"
MOST_BYTES = 1_500_000


@pytest.mark.parametrize("document", [STACK, TABLE], ids=["stack", "table"])
def test_a_sample_has_its_pictures_and_neither_pose_nor_objects(document):
    cell = read_cell(document)
    assert cell.camera.camera_from_world is None
    assert not cell.objects
    size = cell.camera.intrinsics
    for name in (cell.picture, cell.sightings[-1].picture):
        assert cv2.imread(str(cell.path_of(name))).shape == (size.height, size.width, 3)
    truth = read_cell(document.with_name("truth.cell.json"))
    assert len(truth.sightings) == len(cell.sightings) == 8
    for given, true in zip(cell.sightings, truth.sightings, strict=True):
        assert (given.center_world == true.center_world).all()


def test_the_sample_to_model_yourself_brings_no_picks_and_stays_small():
    assert not read_cell(STACK).sketches
    assert len(read_cell(TABLE).sketches) == 7
    assert sum(path.stat().st_size for path in STACK.parent.iterdir()) < MOST_BYTES


def test_the_can_of_the_sample_stands_on_the_carton_and_nothing_leaves_the_picture():
    truth = read_cell(STACK.with_name("truth.cell.json"))
    things = {thing.name: thing for thing in truth.objects}
    carton, can = things["carton"], things["can"]
    top = carton.world_from_object.translation[2] + carton.half_extent[2]
    assert can.world_from_object.translation[2] - can.height / 2 == pytest.approx(top, abs=1e-12)
    inside = carton.world_from_object.inverse().apply(can.world_from_object.translation)
    assert (np.abs(inside[:2]) + can.radius < carton.half_extent[:2]).all()
    for thing in things.values():
        reach = thing.half_extent * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1)
                                              for z in (-1, 1)])  # fmt: skip
        pixels = truth.camera.project(thing.world_from_object.apply(reach))
        assert (pixels > 0).all()
        assert (pixels < [1279, 959]).all()
