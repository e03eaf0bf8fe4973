# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects of every kind added, held, resized and dragged in Blender, each in one undo step."""

import json

import bench_cell
import numpy as np
import pytest
from monocell.core.document.cell_file import read_cell, write_cell
from monocell.core.pose import Pose
from monocell.core.primitives import Cylinder

pytestmark = pytest.mark.blender

TOP = 0.12


def opened(bpy, path):
    assert bpy.ops.monocell.open_cell(filepath=str(path)) == {"FINISHED"}
    bpy.ops.ed.undo_push(message="opened")
    return bpy.context.scene


def saved(bpy, path):
    assert bpy.ops.monocell.save_cell(filepath=str(path)) == {"FINISHED"}
    return read_cell(path)


def things(bpy, tmp_path):
    return {thing.name: thing for thing in saved(bpy, tmp_path / "now.cell.json").objects}


def add(bpy, kind, picks, **options):
    operator = getattr(bpy.ops.monocell, f"add_{kind}")
    return operator("EXEC_DEFAULT", True, picks=json.dumps(picks), **options)


CAN = Cylinder("can", Pose(np.eye(3), [0.36, -0.1, TOP + 0.04]), radius=0.04, height=0.08)


def rim_picks(thing):
    """Three points of the base rim and one of the top rim, on the side that is seen."""
    pose = thing.world_from_object
    eye = bench_cell.POSE.inverse().translation - pose.translation
    angles = np.arctan2(eye[1], eye[0]) + np.array([-1.3, 0.0, 1.3, 0.2])
    x, y = thing.radius * np.cos(angles), thing.radius * np.sin(angles)
    z = np.array([-0.5, -0.5, -0.5, 0.5]) * thing.height
    pixels = bench_cell.CAMERA.project(pose.apply(np.stack([x, y, z], axis=1)))
    return {"rim": pixels[:3].tolist(), "top": pixels[3:].tolist()}


@pytest.fixture
def stacked(addon, bench):
    """A box on the floor and a can on the box, whose top is the active reference."""
    scene = opened(addon, bench)
    add(addon, "box", bench_cell.box_picks())
    assert addon.ops.monocell.pick_reference("EXEC_DEFAULT", True, of="box.top") == {"FINISHED"}
    add(addon, "cylinder", rim_picks(CAN), name="can")
    return scene


def test_a_face_becomes_the_active_reference_and_things_stand_on_it(addon, stacked, tmp_path):
    stored = stacked.monocell_cell
    assert stored.references[stored.reference_index].name == "box top"
    can = things(addon, tmp_path)["can"]
    assert can.on == "box top"
    assert [can.radius, can.height] == pytest.approx([0.04, 0.08], abs=1e-6)
    assert can.world_from_object.translation == pytest.approx([0.36, -0.1, 0.16], abs=1e-6)


def test_a_face_that_is_in_the_list_is_chosen_and_not_listed_twice(addon, stacked):
    stored = stacked.monocell_cell
    stored.reference_index = 0
    addon.ops.monocell.pick_reference("EXEC_DEFAULT", True, of="box.top")
    assert [row.name for row in stored.references] == ["floor", "box top"]
    assert stored.reference_index == 1
    addon.ops.monocell.pick_reference("EXEC_DEFAULT", True, of="floor")
    assert stored.reference_index == 0


def test_a_feature_that_is_not_there_is_named(addon, stacked):
    with pytest.raises(RuntimeError, match=r"no feature 'lid'"):
        addon.ops.monocell.pick_reference(of="box.lid")


def test_a_typed_height_lifts_what_stands_on_it(addon, stacked, tmp_path):
    addon.ops.monocell.set_size("EXEC_DEFAULT", True, name="box", size="size_z", metres=0.15)
    after = things(addon, tmp_path)
    assert after["box"].size[2] == 0.15
    assert after["box"].known == {"size_z": 0.15}
    can = after["can"]
    base = can.world_from_object.translation[2] - can.height / 2
    assert base == pytest.approx(0.15, abs=1e-6)
    addon.ops.ed.undo()
    before = things(addon, tmp_path)
    assert before["box"].size[2] == pytest.approx(0.12, abs=1e-6)
    assert before["can"].world_from_object.translation[2] == pytest.approx(0.16, abs=1e-6)
    addon.ops.ed.redo()
    assert things(addon, tmp_path)["box"].size[2] == 0.15


def test_a_size_is_typed_in_the_sidebar_and_given_free_again(addon, stacked, tmp_path):
    addon.context.view_layer.objects.active = stacked.objects["can"]
    fields = stacked.monocell_object
    assert fields.size_0 == pytest.approx(0.04, abs=1e-6)
    fields.size_0 = 0.042
    assert things(addon, tmp_path)["can"].known == {"radius": 0.042}
    assert fields.known_0 and not fields.known_1
    fields.known_0 = False
    can = things(addon, tmp_path)["can"]
    assert not can.known
    assert can.radius == pytest.approx(0.04, abs=1e-6)


def test_a_size_that_can_not_be_is_told_where_it_was_typed(addon, stacked, tmp_path):
    addon.context.view_layer.objects.active = stacked.objects["can"]
    fields = stacked.monocell_object
    fields.size_1 = -1.0
    assert fields.refusal == "can: height must be above zero, got -1000 mm; type a length"
    assert not things(addon, tmp_path)["can"].known
    fields.size_1 = 0.08
    assert fields.refusal == ""
    with pytest.raises(RuntimeError, match="has no size 'width'"):
        addon.ops.monocell.set_size(name="can", size="width", metres=0.1)


def test_what_does_not_depend_on_an_edit_stays_where_it_was_put(addon, stacked, tmp_path):
    add(addon, "cylinder", bench_cell.drum_picks(), name="drum", on="floor")
    stacked.objects["drum"].location.x += 0.1
    addon.ops.monocell.set_size("EXEC_DEFAULT", True, name="box", size="size_z", metres=0.15)
    after = things(addon, tmp_path)
    assert after["drum"].world_from_object.translation[0] == pytest.approx(0.44, abs=1e-6)


def test_a_box_without_picks_keeps_its_base_when_its_height_is_typed(addon, bench, tmp_path):
    document = read_cell(bench)
    path = bench.parent / "plain.cell.json"
    write_cell(document.with_objects([bench_cell.BOX]), path)
    opened(addon, path)
    addon.ops.monocell.set_size("EXEC_DEFAULT", True, name="box", size="size_z", metres=0.2)
    box = things(addon, tmp_path)["box"]
    assert box.size[2] == 0.2
    assert box.world_from_object.translation[2] == pytest.approx(0.1, abs=1e-9)


def test_what_is_solved_together_shares_what_is_known(addon, stacked, tmp_path):
    addon.ops.monocell.set_size("EXEC_DEFAULT", True, name="can", size="height", metres=0.08)
    alone = things(addon, tmp_path)
    addon.ops.monocell.solve_again("EXEC_DEFAULT", True, joint=True)
    together = things(addon, tmp_path)
    # the can's known height tells how far away it is, and with it the box it stands on
    assert together["box"].size_sigma()[2] < alone["box"].size_sigma()[2]
    assert together["can"].known == {"height": 0.08}


def test_a_relation_is_kept_and_taken_away_again(addon, stacked, tmp_path):
    add(addon, "cylinder", bench_cell.drum_picks(), name="drum", on="floor")
    addon.ops.monocell.add_relation(
        "EXEC_DEFAULT", True, name="drum", kind="same_size", to="can", own="radius"
    )
    after = things(addon, tmp_path)
    assert after["drum"].radius == pytest.approx(after["can"].radius, abs=1e-7)
    addon.ops.monocell.remove_relation("EXEC_DEFAULT", True, name="drum", index=0)
    assert things(addon, tmp_path)["drum"].radius == pytest.approx(0.06, abs=1e-6)
    with pytest.raises(RuntimeError, match="has 0 relations"):
        addon.ops.monocell.remove_relation(name="drum", index=0)


def test_a_relation_to_nothing_is_refused_and_changes_nothing(addon, stacked):
    text = stacked.monocell_cell.text
    with pytest.raises(RuntimeError, match="no reference is called 'roof'"):
        addon.ops.monocell.add_relation(name="can", kind="leans_on", to="roof")
    assert stacked.monocell_cell.text == text


def test_an_object_is_put_on_another_reference(addon, stacked, tmp_path):
    addon.ops.monocell.stand_on("EXEC_DEFAULT", True, name="can", on="floor")
    can = things(addon, tmp_path)["can"]
    assert can.on == "floor"
    assert can.world_from_object.translation[2] == pytest.approx(can.height / 2, abs=1e-6)


def test_a_moved_pick_moves_the_object_and_what_stands_on_it(addon, stacked, tmp_path):
    before = things(addon, tmp_path)
    u, v = before["box"].picks["top"][1]
    addon.ops.monocell.move_pick(
        "EXEC_DEFAULT", True, name="box", role="top", index=1, pixel_at=(u, v - 10)
    )
    after = things(addon, tmp_path)
    assert after["box"].size[2] > before["box"].size[2] + 0.005
    rise = after["can"].world_from_object.translation[2] - 0.16
    assert rise > 0.005
    addon.ops.ed.undo()
    assert things(addon, tmp_path)["box"].picks["top"][1] == pytest.approx([u, v])
    with pytest.raises(RuntimeError, match=r"has no pick top\[0\]"):
        addon.ops.monocell.move_pick(name="box", role="top", index=0, pixel_at=(u, v))


def test_motion_goes_into_the_document(addon, stacked, tmp_path):
    addon.ops.monocell.set_motion("EXEC_DEFAULT", True, name="can", kind="movable", mass=0.4)
    motion = things(addon, tmp_path)["can"].motion
    assert (motion.kind, motion.mass) == ("movable", pytest.approx(0.4, abs=1e-6))
    addon.ops.monocell.set_motion(
        "EXEC_DEFAULT", True, name="can", kind="attached", to="box", joint="hinge", axis=(0, 0, 1)
    )
    motion = things(addon, tmp_path)["can"].motion
    assert (motion.to, motion.joint) == ("box", "hinge")
    with pytest.raises(RuntimeError, match="`to`"):
        addon.ops.monocell.set_motion(name="can", kind="attached", to="", joint="fixed")


def test_a_wall_and_a_post_stand_on_their_feet(addon, bench, tmp_path):
    scene = opened(addon, bench)
    feet = bench_cell.CAMERA.project(np.array([[0.2, 0.3, 0.0], [0.6, 0.3, 0.0]])).tolist()
    addon.ops.monocell.add_upright_plane("EXEC_DEFAULT", True, picks=json.dumps(feet))
    addon.ops.monocell.add_upright_line(
        "EXEC_DEFAULT", True, picks=json.dumps(feet[:1]), on="floor"
    )
    by_name = {r.name: r for r in saved(addon, tmp_path / "x.cell.json").references}
    assert np.abs(by_name["plane"].normal) == pytest.approx([0, 1, 0], abs=1e-6)
    assert by_name["line"].point[:2] == pytest.approx([0.2, 0.3], abs=1e-6)
    assert np.abs(by_name["line"].direction) == pytest.approx([0, 0, 1], abs=1e-9)
    stored = scene.monocell_cell
    assert stored.references[stored.reference_index].name == "line"
    with pytest.raises(RuntimeError, match="is a line"):
        add(addon, "box", bench_cell.box_picks())


def test_a_parallel_plane_follows_its_face(addon, stacked, tmp_path):
    addon.ops.monocell.add_parallel_plane(
        "EXEC_DEFAULT", True, to="box.top", distance=0.1, name="shelf"
    )
    addon.ops.monocell.set_size("EXEC_DEFAULT", True, name="box", size="size_z", metres=0.15)
    by_name = {r.name: r for r in saved(addon, tmp_path / "x.cell.json").references}
    assert by_name["shelf"].point[2] == pytest.approx(0.25, abs=1e-6)


def test_a_reference_that_is_needed_stays(addon, stacked):
    with pytest.raises(RuntimeError, match="box top: is needed by can"):
        addon.ops.monocell.remove_reference(name="box top")
    addon.ops.monocell.stand_on("EXEC_DEFAULT", True, name="can", on="floor")
    addon.ops.monocell.remove_reference("EXEC_DEFAULT", True, name="box top")
    assert [row.name for row in stacked.monocell_cell.references] == ["floor"]


def test_a_lying_cylinder_is_said_to_lie(addon, bench, tmp_path):
    opened(addon, bench)
    log = Cylinder(
        "log",
        Pose.from_rotation_vector([np.pi / 2, 0, 0], [0.35, 0, 0.06]),
        radius=0.06,
        height=0.3,
    )
    near, far = sorted(
        (-0.15, 0.15),
        key=lambda z: bench_cell.POSE.apply(log.world_from_object.apply([0, 0, z]))[2],
    )

    def points(z, angles):
        at = np.array(angles)
        local = np.stack([0.06 * np.cos(at), 0.06 * np.sin(at), np.full(len(at), z)], axis=1)
        return bench_cell.CAMERA.project(log.world_from_object.apply(local)).tolist()

    picks = {"rim": points(near, [0.3, 1.8, 3.4, 5.0]), "top": points(far, [0.4, 1.2, 2.0])}
    add(addon, "cylinder", picks, way="LYING", name="log")
    found = things(addon, tmp_path)["log"]
    assert [found.radius, found.height] == pytest.approx([0.06, 0.3], abs=1e-5)
    assert [(r.kind, r.to) for r in found.relations] == [("lies_on", "floor")]
    assert found.on == "floor"


def test_known_sizes_of_a_script_are_held(addon, bench, tmp_path):
    opened(addon, bench)
    picks = {"base": bench_cell.box_picks()["base"]}
    add(addon, "box", picks, known=json.dumps({"size_z": 0.12}))
    assert things(addon, tmp_path)["box"].size[2] == 0.12
    with pytest.raises(RuntimeError, match="no size 'tall'"):
        add(addon, "box", picks, known=json.dumps({"tall": 0.12}))


def test_a_renamed_box_takes_its_face_along(addon, stacked, tmp_path):
    stacked.objects["box"].name = "crate"
    addon.ops.monocell.set_size("EXEC_DEFAULT", True, name="crate", size="size_z", metres=0.15)
    after = things(addon, tmp_path)
    can = after["can"]
    base = can.world_from_object.translation[2] - can.height / 2
    assert base == pytest.approx(0.15, abs=1e-6)
