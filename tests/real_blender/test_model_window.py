# SPDX-License-Identifier: GPL-3.0-or-later
"""Solids of several kinds picked, stacked, typed and dragged in a real window."""

import bench_cell
import numpy as np
import pytest
from model_scene import BALL, CAN, CRATE, WEDGE, clicks, draw_scene
from monocell.core.document.cell_file import read_cell
from window_run import in_window

pytestmark = [pytest.mark.real_blender, pytest.mark.slow]


@pytest.fixture(scope="session")
def worked(window_blender, tmp_path_factory):
    """The folder that one Blender left its work in, and what it found."""
    folder = tmp_path_factory.mktemp("model")
    document = bench_cell.write_bench(folder, balls=False)
    draw_scene(folder / "bench.png")
    job = clicks() | {
        "document": str(document),
        "width": bench_cell.INTRINSICS.width,
        "height": bench_cell.INTRINSICS.height,
    }
    return in_window(window_blender, folder, "model_steps.py", job)


def objects_of(worked, name):
    return {thing.name: thing for thing in read_cell(worked[0] / f"{name}.cell.json").objects}


def off(thing, truth):
    return np.linalg.norm(thing.world_from_object.translation - truth.world_from_object.translation)


def test_no_step_fails(worked):
    _, found, run = worked
    assert "error" not in found, found.get("error")
    assert "Traceback" not in run.stdout + run.stderr
    assert not found["left_over"]


def test_a_ball_on_the_floor_is_found_by_its_outline(worked):
    ball = objects_of(worked, "typed")["sphere"]
    # three clicks to a screen pixel tell it no better
    assert abs(ball.radius - BALL.radius) < 3 * ball.size_sigma()[0]
    assert off(ball, BALL) < 3 * np.linalg.norm(ball.position_sigma())


def test_a_wedge_is_found_by_its_corners(worked):
    wedge = objects_of(worked, "typed")["prism"]
    assert len(wedge.polygon) == 3
    assert wedge.height == pytest.approx(WEDGE.height, abs=4e-3)
    assert off(wedge, WEDGE) < 4e-3


def test_a_typed_height_is_known_and_the_click_is_saved(worked):
    crate = objects_of(worked, "typed")["box"]
    assert crate.known == {"size_z": 0.12}
    assert "top" not in crate.picks
    assert np.allclose(sorted(crate.size[:2]), sorted(CRATE.size[:2]), atol=4e-3)


def test_a_clicked_face_carries_the_can(worked):
    assert worked[1]["active"] == "box top"
    can = objects_of(worked, "stacked")["cylinder"]
    assert can.on == "box top"
    assert can.radius == pytest.approx(CAN.radius, abs=3e-3)
    assert off(can, CAN) < 6e-3


def test_a_dragged_pick_makes_the_can_higher_and_undo_takes_it_back(worked):
    before = objects_of(worked, "stacked")["cylinder"]
    after = objects_of(worked, "dragged")["cylinder"]
    assert after.height > before.height + 0.01
    texts = {
        name: (worked[0] / f"{name}.cell.json").read_text()
        for name in ("stacked", "escaped", "undone", "dragged", "redone")
    }
    assert texts["escaped"] == texts["undone"] == texts["stacked"]
    assert texts["redone"] == texts["dragged"]


def test_a_size_typed_in_the_sidebar_is_held_and_an_impossible_one_is_not(worked):
    before, after = (objects_of(worked, name) for name in ("coloured", "sized"))
    assert after["box"].known == {"size_x": 0.2, "size_z": 0.12}
    assert after["sphere"].radius == before["sphere"].radius
    assert after["cylinder"].on == "box top"


def test_objects_take_their_colours_from_the_picture(worked):
    things = objects_of(worked, "coloured")
    # the ball may be hidden: a can with one pick on its top may be half as high again
    colors = {name: things[name].appearance.color for name in ("box", "prism", "cylinder")}
    assert int(np.argmax(colors["box"])) == 0
    assert int(np.argmax(colors["prism"])) == 1
    assert int(np.argmax(colors["cylinder"])) == 2
