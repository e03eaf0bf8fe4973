# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest
from monocell.core.camera import Camera
from monocell.core.distortion import Distortion
from monocell.core.errors import InvalidValue
from monocell.core.intrinsics import Intrinsics
from monocell.core.pose import Pose

pytestmark = pytest.mark.blender

POSE = Pose.looking_at([1.2, -0.8, 0.8], [0.3, 0.0, 0.2], [0, 0, 1.0])
PLAIN = Camera(Intrinsics(160, 120, 300.0, 300.0, 79.5, 59.5), POSE)
BENT = Camera(
    Intrinsics(
        160, 120, 150.0, 151.0, 77.0, 61.0, Distortion("plumb_bob", [-0.28, 0.09, 0.001, 0, 0])
    ),
    POSE,
)
# from above, so that the table's top fills the picture
ABOVE = Camera(
    PLAIN.intrinsics, Pose.looking_at([0.35, 0.0, 1.8], [0.35, 0.01, 0.0], [1.0, 0.0, 0.0])
)


def cell(camera, ball=None, **lab):
    from monocell.scene.work_cell import Ball, Lab, WorkCell

    held = None if ball is None else Ball(np.array(ball), 0.05, np.array([0.02, 0.6, 0.05]))
    return WorkCell(camera, ball=held, lab=Lab(**lab))


@pytest.mark.parametrize("camera", [PLAIN, BENT], ids=["plain", "bent"])
@pytest.mark.parametrize("window", [(60, 40, 47, 57), (0, 0, 160, 120), (121, 93, 39, 27)])
def test_a_window_is_that_part_of_the_whole_picture(blender, camera, window):
    from monocell.scene.stage import Stage

    x, y, width, height = window
    with Stage(cell(camera, [0.3, 0.0, 0.2])) as stage:
        whole = stage.linear(samples=4)
        part = stage.window(window, samples=4)
    assert part.shape == (height, width, 3)
    # between a pixel and its neighbour a picture of noise differs by far more
    assert part == pytest.approx(whole[y : y + height, x : x + width], abs=2e-3)


@pytest.mark.parametrize(
    "window", [(-1, 0, 10, 10), (0, 0, 161, 10), (0, 119, 10, 2), (5, 5, 0, 9)]
)
def test_a_window_that_leaves_the_picture_is_refused(blender, window):
    from monocell.scene.stage import Stage

    with Stage(cell(PLAIN)) as stage, pytest.raises(InvalidValue, match="not inside the picture"):
        stage.window(window, samples=1)


def test_the_table_has_the_colours_it_is_given(blender):
    from monocell.scene.stage import Stage

    grey, red = np.full(3, 0.4), np.array([0.6, 0.05, 0.05])
    with Stage(cell(ABOVE, table_dark=grey, table_light=grey)) as stage:
        plain = stage.linear(samples=4).mean(axis=(0, 1))
    with Stage(cell(ABOVE, table_dark=red, table_light=red)) as stage:
        painted = stage.linear(samples=4).mean(axis=(0, 1))
    assert painted[0] > 1.2 * plain[0]
    assert painted[2] < 0.5 * plain[2]


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_the_shadow_falls_away_from_the_lamp(blender, side):
    from monocell.scene.room import lamp_place
    from monocell.scene.stage import Stage

    ball = np.array([0.35, 0.0, 0.2])
    look = {"to_lamp": np.array([0.0, 0.6 * side, 1.0]), "lamp_size": 0.05, "ambient": 0.1}
    lit = cell(ABOVE, ball, **look)
    with Stage(lit) as stage:
        held = stage.linear(samples=16).sum(axis=2)
        stage.move((), None)
        empty = stage.linear(samples=16).sum(axis=2)
    lamp = lamp_place(lit)
    shadow = lamp + (ball - lamp) * lamp[2] / (lamp[2] - ball[2])
    assert shadow[1] * side < 0
    u, v = np.rint(ABOVE.project(shadow[None])[0]).astype(int)
    assert held[v, u] < 0.5 * empty[v, u]


def test_a_lab_s_numbers_are_checked():
    from monocell.scene.work_cell import Lab

    with pytest.raises(InvalidValue, match=r"lab\.wall"):
        Lab(wall=np.zeros(2))
    with pytest.raises(InvalidValue, match=r"lab\.lamp_size"):
        Lab(lamp_size=0.0)


def panel_at(flange=None, turned=0.0):
    from monocell.scene.work_cell import Panel

    albedo = np.full((4, 6), 0.8)
    albedo[0, 0] = albedo[3, 1:3] = 0.02
    place = PLAIN.pose.inverse() @ Pose.from_rotation_vector([0, turned, 0.1], [0.0, 0.0, 1.0])
    return Panel(place, np.array([0.3, 0.2]), albedo, flange)


def test_a_panel_shows_its_print_where_it_is(blender):
    from monocell.scene.stage import Stage

    panel = panel_at(turned=0.3)
    with Stage(cell(PLAIN)) as stage:
        stage.hold(panel)
        light = stage.linear(samples=16).sum(axis=2)
    rows, columns = np.mgrid[:4, :6]
    x, y = (columns + 0.5) * 0.05 - 0.15, (rows + 0.5) * 0.05 - 0.1
    points = np.stack([x.ravel(), y.ravel(), np.zeros(24)], axis=1)
    u, v = np.rint(PLAIN.project(panel.world_from_panel.apply(points))).astype(int).T
    seen = light[v, u].reshape(4, 6)
    assert ((seen > 0.5 * np.median(seen)) == (panel.albedo > 0.5)).all()


def test_a_panel_comes_and_goes_and_the_ball_with_it(blender):
    from monocell.scene.stage import Stage
    from monocell.scene.work_cell import Ball

    kinds = ("objects", "meshes", "materials", "scenes", "worlds", "lights", "cameras")
    before = {k: len(getattr(blender.data, k)) for k in kinds}
    flange = panel_at().world_from_panel @ Pose(np.diag([1.0, -1.0, -1.0]), [0.0, 0.0, 0.2])
    with Stage(cell(PLAIN)) as stage:
        empty = stage.linear(samples=1)
        built = len(blender.data.objects)
        stage.hold(panel_at(flange))
        held = len(blender.data.objects)
        assert held > built + 2
        stage.hold(panel_at(flange, 0.2))
        assert len(blender.data.objects) == held
        stage.move((), Ball(np.array([0.3, 0, 0.2]), 0.05, np.array([0.0, 0.6, 0.0])))
        stage.move((), None)
        assert (stage.linear(samples=1) == empty).all()
        stage.hold(panel_at(flange))
    assert {k: len(getattr(blender.data, k)) for k in kinds} == before
    assert [image.name for image in blender.data.images] == ["Render Result"]
