# SPDX-License-Identifier: GPL-3.0-or-later
"""A cell's sketches become objects, its picked objects follow the camera, the rest stays."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from monocell.core import Appearance, Box, Camera, Cell, Pose, ReferenceLine, Sketch
from monocell.core.errors import InvalidValue, NoPose
from monocell.core.modelling.solve import model_cell, solve_sketch
from picked_scene import (
    FLOOR,
    WALL,
    box_on,
    box_picks,
    camera,
    cylinder_on,
    cylinder_picks,
    deviation,
)

EDGE = ReferenceLine("edge", np.zeros(3), np.array([1.0, 0.0, 0.0]))
RED = Appearance([0.8, 0.1, 0.1])


def block_sketch(cam, name="block"):
    return Sketch(name, "box", "floor", box_picks(box_on(FLOOR), cam), {}, RED)


def test_a_cell_of_sketches_is_solved_whole():
    cam = camera()
    drum = cylinder_on(WALL, x=0.3, y=0.1)
    sketches = (
        block_sketch(cam),
        Sketch("drum", "cylinder", "wall", cylinder_picks(drum, cam)),
    )
    cell, results = model_cell(Cell(cam, references=(FLOOR, WALL), sketches=sketches))
    assert cell.sketches == ()
    assert [o.name for o in cell.objects] == ["block", "drum"]
    assert [r.object for r in results] == list(cell.objects)
    np.testing.assert_allclose(deviation(cell.objects[0], box_on(FLOOR)), 0, atol=1e-9)
    np.testing.assert_allclose(deviation(cell.objects[1], drum), 0, atol=1e-9)


def test_a_solved_object_keeps_what_the_operator_said():
    cam = camera()
    sketch = Sketch("block", "box", "floor", block_sketch(cam).picks, {"size_x": 0.2}, RED)
    solved = solve_sketch(cam, sketch, [FLOOR]).object
    assert (solved.name, solved.on, solved.appearance) == ("block", "floor", RED)
    assert solved.picks == sketch.picks
    assert solved.known == {"size_x": 0.2}


def test_objects_with_picks_follow_a_better_calibration_and_others_stay():
    cam = camera()
    typed = Box("typed", Pose.identity(), size=[0.1, 0.1, 0.1])
    cell, _ = model_cell(
        Cell(cam, references=(FLOOR,), objects=(typed,), sketches=(block_sketch(cam),))
    )
    # the same pixels seen by a camera 5 mm higher: the same picture of everything 5 mm higher
    lifted = camera(pose=cam.pose @ Pose(np.eye(3), np.array([0.0, 0.0, -0.005])))
    again, results = model_cell(cell.with_camera(lifted))
    assert again.objects[0] is typed
    assert [r.object.name for r in results] == ["block"]
    moved = deviation(again.objects[1], cell.objects[1])
    assert 1e-3 < np.linalg.norm(moved[3:6]) < 2e-2
    back, _ = model_cell(again.with_camera(cam))
    np.testing.assert_allclose(deviation(back.objects[1], cell.objects[1]), 0, atol=1e-9)


def test_objects_come_first_then_sketches_in_the_document_order():
    cam = camera()
    cell, _ = model_cell(Cell(cam, references=(FLOOR,), sketches=(block_sketch(cam, "a"),)))
    more = Cell(
        cam,
        references=(FLOOR,),
        objects=cell.objects,
        sketches=(block_sketch(cam, "z"), block_sketch(cam, "c")),
    )
    solved, results = model_cell(more)
    assert [o.name for o in solved.objects] == ["a", "z", "c"]
    assert [r.object.name for r in results] == ["a", "z", "c"]


def test_a_reference_line_carries_no_box():
    on_edge = replace(block_sketch(camera()), on="edge")
    with pytest.raises(InvalidValue, match="block: stands_on needs a plane, and edge is a line"):
        solve_sketch(camera(), on_edge, [EDGE])


def test_a_camera_without_pose_models_nothing():
    with pytest.raises(NoPose):
        solve_sketch(Camera(camera().intrinsics), block_sketch(camera()), [FLOOR])


@pytest.mark.parametrize("sigma", [0.0, -1.0, float("nan")])
def test_a_pick_noise_that_is_none_is_refused(sigma):
    with pytest.raises(InvalidValue, match="pick_sigma_pixels"):
        solve_sketch(camera(), block_sketch(camera()), [FLOOR], (), sigma)


def test_sigma_scales_what_picks_alone_determine():
    one = solve_sketch(camera(), block_sketch(camera()), [FLOOR], (), 1.0).object.size_sigma()
    half = solve_sketch(camera(), block_sketch(camera()), [FLOOR], (), 0.5).object.size_sigma()
    np.testing.assert_allclose(half, one / 2, rtol=1e-6)
