# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of the scene: what is in them, where, and that they are whole."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from monocell.core import Box, Cylinder, Pose
from monocell.core.errors import DocumentError
from monocell.headless.robot.light import linear_from_srgb, srgb_from_linear
from monocell.headless.robot.stage import View
from monocell.headless.robot.tessellation import ball, rod, triangles_of

SMALL = (240, 180)


def volume(mesh):
    a, b, c = (mesh.vertices[mesh.faces[:, i]] for i in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def test_tessellated_bodies_are_closed_face_outwards_and_have_their_volume():
    pose = Pose.from_rotation_vector([0.3, 0.2, 0.1], [1, 2, 3])
    box = triangles_of(Box("b", pose, size=np.array([0.2, 0.3, 0.4])))
    drum = triangles_of(Cylinder("c", pose, radius=0.1, height=0.5))
    assert volume(box) == pytest.approx(0.024, rel=1e-9)
    assert volume(drum) == pytest.approx(np.pi * 0.01 * 0.5, rel=1e-3)
    assert volume(ball("s", np.ones(3), 0.2)) == pytest.approx(4 / 3 * np.pi * 0.008, rel=0.01)
    stick = rod("r", np.zeros(3), np.array([0.0, -0.3, 0.4]), 0.02)
    assert volume(stick) == pytest.approx(np.pi * 0.0004 * 0.5, rel=0.02)


def test_linear_light_and_screen_values_are_each_others_inverse():
    values = np.linspace(0, 1, 101)
    assert srgb_from_linear(linear_from_srgb(values)) == pytest.approx(values, abs=1e-6)


@pytest.mark.robot
def test_what_a_stage_sees_lies_where_it_was_put():
    from monocell.headless.robot.stage import Stage

    box = Box("b", Pose(np.eye(3), np.array([0.5, 0, 0.1])), size=np.array([0.3, 0.3, 0.2]))
    view = View(np.array([0.5, -0.4, 2.0]), np.array([0.5, 0, 0.2]), 0.4, 0.5, 4.0)
    with Stage() as stage:
        number = stage.add_mesh(triangles_of(box))
        layer = stage.seen(view, 160, 120)
    top = layer.points_world()[50:70, 70:90]
    assert (layer.body[50:70, 70:90] == number).all()
    assert np.abs(top[..., 2] - 0.2).max() < 2e-3
    assert layer.body[0, 0] == -1 and np.isinf(layer.depth[0, 0])


@pytest.mark.robot
def test_a_picture_shows_the_drum_in_its_own_colour_where_it_stands(cell, arm, tmp_path):
    from monocell.headless.robot.picture import draw_scene

    view = View(np.array([1.6, -1.2, 1.2]), np.array([0.35, 0.0, 0.3]), 0.6, 0.3, 6.0)
    out = tmp_path / "cell.png"
    draw_scene(cell, out, joints=arm.rest, view=view, size=SMALL)
    picture = cv2.imread(str(out)).astype(int)
    assert picture.shape == (180, 240, 3)
    x, y, z = view.camera_from_world().apply([0.45, -0.28, 0.12])
    u, v = x / z * view.focal(180) + 119.5, y / z * view.focal(180) + 89.5
    blue, green, red = picture[round(v), round(u)]
    assert blue > green + 20 > red


@pytest.mark.robot
def test_the_path_is_green_and_the_blocked_motion_red(cell, arm, ends, tmp_path):
    from monocell.headless.robot.picture import draw_scene

    over = np.linspace(ends[0], arm.rest, 20)

    def painted(name, **drawn):
        draw_scene(cell, tmp_path / name, joints=ends[0], ghosts=0, size=SMALL, **drawn)
        blue, green, red = np.moveaxis(cv2.imread(str(tmp_path / name)).astype(int), -1, 0)
        return int((green > red + 40).sum()), int((red > 2.5 * np.maximum(green, blue)).sum())

    green, red = zip(
        painted("none.png"),
        painted("path.png", path=over),
        painted("cut.png", blocked=over),
        strict=True,
    )
    assert green[1] > green[0] + 20 and green[2] <= green[0] + 2
    assert red[2] > red[0] + 20 and red[1] <= red[0] + 2


@pytest.mark.robot
def test_the_same_scene_gives_the_same_picture(cell, arm, ends, tmp_path):
    from monocell.headless.robot.picture import draw_scene

    pictures = []
    for name in ("a.png", "b.png"):
        draw_scene(cell, tmp_path / name, joints=arm.rest, path=[ends[0], arm.rest], size=(96, 72))
        pictures.append((tmp_path / name).read_bytes())
    assert pictures[0] == pictures[1]


@pytest.mark.robot
def test_a_picture_in_a_missing_folder_is_refused(cell, arm, tmp_path):
    from monocell.headless.robot.picture import draw_scene

    with pytest.raises(DocumentError, match=r"the folder .* is not there"):
        draw_scene(cell, tmp_path / "no" / "cell.png", joints=arm.rest, size=(96, 72))
