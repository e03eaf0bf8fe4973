# SPDX-License-Identifier: GPL-3.0-or-later
"""What the overlay keeps of the objects' lines, and when it looks at them again."""

import json
from types import SimpleNamespace

import bench_cell
import pytest

pytestmark = pytest.mark.blender


@pytest.fixture
def seen(addon, module, monkeypatch, tmp_path):
    """The bench with box and drum; `lines()` draws them and tells what was sent."""
    bpy, ops = addon, addon.ops.monocell
    ops.open_cell(filepath=str(bench_cell.write_bench(tmp_path)))
    ops.add_box("EXEC_DEFAULT", True, picks=json.dumps(bench_cell.box_picks()))
    # the first push starts the undo system, which a Blender without a window leaves off
    bpy.ops.ed.undo_push(message="a box")
    ops.add_cylinder("EXEC_DEFAULT", True, picks=json.dumps(bench_cell.drum_picks()))
    object_lines = module("addon.overlay.object_lines")
    made = []

    class Recorded:
        @classmethod
        def of_ends(cls, ends, color, width):
            made.append(ends)
            return ends

    monkeypatch.setattr(object_lines, "LineBatch", Recorded)
    changes = module("addon.overlay.scene_changes").SceneChanges()
    changes.listen()
    held = object_lines.ObjectLines()
    look = module("addon.settings").DEFAULTS
    space = next(
        area.spaces.active for area in bpy.data.screens["Layout"].areas if area.type == "VIEW_3D"
    )

    def lines():
        bpy.context.view_layer.update()
        made.clear()
        scene, layer = bpy.context.scene, bpy.context.view_layer
        context = SimpleNamespace(scene=scene, view_layer=layer, space_data=space)
        drawn = held.batches(context, look, changes.count)
        return sum(len(ends) for ends in drawn), sum(len(ends) for ends in made)

    yield SimpleNamespace(bpy=bpy, lines=lines, changes=changes)
    changes.end()


def test_a_redraw_without_a_change_sends_nothing(seen):
    drawn, sent = seen.lines()
    assert drawn == sent > 0
    assert seen.lines() == (drawn, 0)


def test_moving_one_object_again_and_again_sends_its_lines_alone(seen):
    drawn, _ = seen.lines()
    box = seen.bpy.data.objects["box"]
    box.location.x += 0.01
    seen.lines()
    box.location.x += 0.01
    after, sent = seen.lines()
    assert 0 < sent < after / 2 + 20
    assert after == pytest.approx(drawn, abs=20)


@pytest.mark.parametrize(
    "deed",
    [
        lambda bpy, box: box.hide_set(True),
        lambda bpy, box: setattr(box, "hide_viewport", True),
        lambda bpy, box: bpy.data.objects.remove(box),
        lambda bpy, box: setattr(
            bpy.context.view_layer.layer_collection.children[0], "exclude", True
        ),
        lambda bpy, box: bpy.ops.ed.undo(),
    ],
    ids=["hidden", "off in viewports", "deleted", "collection left out", "undone"],
)
def test_what_is_gone_from_the_view_is_not_drawn(seen, deed):
    drawn, _ = seen.lines()
    deed(seen.bpy, seen.bpy.data.objects["box"])
    assert seen.lines()[0] < drawn


def test_redo_brings_the_lines_back(seen):
    drawn, _ = seen.lines()
    seen.bpy.ops.ed.undo()
    assert seen.lines()[0] < drawn
    seen.bpy.ops.ed.redo()
    assert seen.lines()[0] == drawn


def test_a_parent_that_is_moved_takes_the_lines_along(seen):
    bpy = seen.bpy
    empty = bpy.data.objects.new("hand", None)
    bpy.context.scene.collection.objects.link(empty)
    bpy.data.objects["box"].parent = empty
    seen.lines()
    empty.location.x += 0.05
    assert seen.lines()[1] > 0


def test_another_frame_moves_what_is_animated(seen):
    box = seen.bpy.data.objects["box"]
    box.keyframe_insert("location", frame=1)
    box.location.x += 0.1
    box.keyframe_insert("location", frame=9)
    seen.bpy.context.scene.frame_set(1)
    seen.lines()
    seen.bpy.context.scene.frame_set(9)
    assert seen.lines()[1] > 0


def test_the_active_object_is_drawn_anew_when_another_becomes_it(seen):
    seen.lines()
    seen.bpy.context.view_layer.objects.active = seen.bpy.data.objects["box"]
    seen.bpy.data.objects["box"].select_set(True)
    assert seen.lines()[1] > 0


def test_nothing_is_heard_after_the_end(seen):
    seen.changes.end()
    before = seen.changes.count
    seen.bpy.data.objects["box"].location.x += 1
    seen.bpy.context.view_layer.update()
    assert seen.changes.count == before
    seen.changes.listen()
