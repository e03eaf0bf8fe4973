# SPDX-License-Identifier: GPL-3.0-or-later
"""A cell's sketches become objects, its picked objects follow the camera, the rest stays."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from monocell.core import (
    Appearance,
    Box,
    Camera,
    Cell,
    Pose,
    ReferenceLine,
    ReferencePlane,
    Relation,
    Sketch,
)
from monocell.core.errors import DegenerateReference, InvalidValue, NoPose, PickError
from monocell.core.modelling.solve import model, model_cell, solve_sketch
from monocell.core.reference import PendingReference
from monocell.core.references.sources import FeatureOf
from monocell.core.shape.features import feature
from picked_scene import (
    FLOOR,
    TWIST_COVARIANCE,
    WALL,
    box_on,
    box_picks,
    camera,
    cylinder_on,
    cylinder_picks,
    deviation,
    noisy,
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


def stacked_cell(cam, rng=None, **known):
    """A crate on the floor, a block on the crate by a reference made from its top, both picked."""
    crate = box_on(FLOOR, size=(0.25, 0.2, 0.12))
    top = feature(crate, "top")
    on_top = ReferencePlane("lid", top.point, top.direction)
    block = replace(box_on(on_top, x=0.02, y=0.01, yaw=-0.2, size=(0.1, 0.07, 0.08)), name="block")
    picks = {
        "crate": box_picks(replace(crate, name="crate"), cam, 4, (0, 1, 2, 3)),
        "block": box_picks(block, cam, 4, (0, 1, 2, 3)),
    }
    if rng is not None:
        picks = {name: noisy(p, rng, 1.0) for name, p in picks.items()}
    lid = PendingReference("lid", "plane", FeatureOf("crate.top"))
    sketches = (
        Sketch("block", "box", "lid", picks["block"]),
        Sketch("crate", "box", "floor", picks["crate"], known),
    )
    return Cell(cam, references=(FLOOR, lid), sketches=sketches), crate, block


@pytest.mark.parametrize("joint", [False, True])
def test_what_stands_on_an_object_is_solved_after_it_and_stays_on_it(joint):
    cam = camera()
    cell, crate, block = stacked_cell(cam)
    solved = model(cell, joint=joint).cell
    assert [thing.name for thing in solved.objects] == ["block", "crate"]
    np.testing.assert_allclose(deviation(solved.objects[0], block), 0, atol=1e-8)
    np.testing.assert_allclose(deviation(solved.objects[1], crate), 0, atol=1e-8)
    # the reference follows the crate, and remembers where it comes from
    lid = solved.reference("lid")
    assert lid.point[2] == pytest.approx(0.12, abs=1e-9)
    assert lid.source.of == "crate.top"


def test_a_typed_height_of_the_crate_lifts_what_stands_on_it():
    cam = camera(covariance=TWIST_COVARIANCE)
    cell, _, _ = stacked_cell(cam, np.random.default_rng(1), size_z=0.13)
    for joint in (False, True):
        solved = {thing.name: thing for thing in model(cell, joint=joint).cell.objects}
        foot = solved["block"].world_from_object.translation[2] - solved["block"].size[2] / 2
        assert foot == pytest.approx(0.13, abs=1e-9)


def test_a_wrong_size_is_told_by_what_it_does_to_the_picks():
    cam = camera(covariance=TWIST_COVARIANCE)
    cell, _, _ = stacked_cell(cam, np.random.default_rng(2), size_z=0.16)
    told = [w for result in model(cell, joint=True).results for w in result.warnings]
    assert any("crate: the picks miss the box" in warning for warning in told)


def test_a_wrong_calibration_is_told_when_known_sizes_pull_it():
    true = camera(covariance=TWIST_COVARIANCE)
    cell, _, _ = stacked_cell(true, None, size_x=0.25, size_y=0.2, size_z=0.12)
    assert not model(cell, joint=True).warnings
    wrong = true.placed(true.pose.perturbed([0.015, 0, 0, 0, -0.01, 0]), TWIST_COVARIANCE)
    told = model(cell.with_camera(wrong), 0.3, joint=True).warnings
    assert any("pull camera and references" in warning for warning in told)


def test_a_second_joint_run_changes_nothing():
    cam = camera(covariance=TWIST_COVARIANCE)
    cell, _, _ = stacked_cell(cam, np.random.default_rng(3))
    once = model(cell, joint=True).cell
    twice = model(once, joint=True).cell
    for a, b in zip(once.objects, twice.objects, strict=True):
        np.testing.assert_allclose(deviation(a, b), 0, atol=1e-7)
        np.testing.assert_allclose(a.covariance, b.covariance, rtol=1e-3, atol=1e-12)


def test_objects_that_hold_each_other_are_solved_together():
    cam = camera()
    twins = [box_on(FLOOR, x=x, size=(0.1, 0.1, 0.1)) for x in (-0.15, 0.15)]
    sketches = tuple(
        Sketch(
            name, "box", "floor", box_picks(twin, cam), relations=(Relation("same_size", other),)
        )
        for name, other, twin in (("a", "b", twins[0]), ("b", "a", twins[1]))
    )
    solved = model(Cell(cam, references=(FLOOR,), sketches=sketches)).cell.objects
    for thing, twin in zip(solved, twins, strict=True):
        np.testing.assert_allclose(deviation(thing, twin), 0, atol=1e-8)


def test_what_nobody_picked_follows_what_holds_it():
    cam = camera()
    cell, _, _ = stacked_cell(cam)
    lamp = Box("lamp", Pose(np.eye(3), [0.1, 0.05, 0.5]), on="block.top", size=[0.03, 0.03, 0.1])
    typed = Box("typed", Pose(np.eye(3), [0.3, 0, 0.3]), on="floor", size=[0.1, 0.1, 0.1])
    solved = model(replace(cell, objects=(lamp, typed))).cell
    now = {thing.name: thing for thing in solved.objects}
    foot = now["lamp"].world_from_object.translation[2] - 0.05
    block = now["block"]
    assert foot == pytest.approx(block.world_from_object.translation[2] + block.size[2] / 2)
    # it moves no farther than it has to, and keeps its size
    np.testing.assert_allclose(now["lamp"].world_from_object.translation[:2], [0.1, 0.05])
    np.testing.assert_allclose(now["lamp"].size, [0.03, 0.03, 0.1])
    # what a person put above the floor stays where it was put
    assert now["typed"] is typed
    assert {thing.name: thing for thing in model(solved).cell.objects}["lamp"] is now["lamp"]


@pytest.mark.parametrize("lid", [True, False])
def test_two_that_stand_on_each_other_are_refused(lid):
    cell, _, _ = stacked_cell(camera())
    block, crate = cell.sketches
    around = (replace(block, on="crate.top"), replace(crate, on="block.top"))
    references = cell.references if lid else (FLOOR,)
    with pytest.raises(DegenerateReference, match=r"break the circle|held by block in turn"):
        model(replace(cell, references=references, sketches=around))


def test_a_box_whose_foot_is_hidden_asks_for_one_of_its_corners():
    cam = camera()
    picks = box_picks(box_on(FLOOR), cam, 3, (0, 1, 2, 3)) | {"base": []}
    with pytest.raises(PickError, match="block: no corner of its base is picked"):
        solve_sketch(cam, Sketch("block", "box", "floor", picks), [FLOOR])
    known = solve_sketch(cam, Sketch("block", "box", "floor", picks, {"size_x": 0.2}), [FLOOR])
    np.testing.assert_allclose(known.object.sizes, [0.2, 0.1, 0.15], atol=1e-7)
