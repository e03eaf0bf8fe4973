# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest
from monocell.core.camera import Camera
from monocell.core.distortion import Distortion
from monocell.core.errors import InvalidValue, MonocellError
from monocell.core.intrinsics import Intrinsics
from monocell.core.pose import Pose

pytestmark = pytest.mark.blender

LENSES = {
    "plumb_bob": Distortion("plumb_bob", np.array([-0.28, 0.09, 0.0006, -0.0004, -0.01])),
    "equidistant": Distortion("equidistant", np.array([0.02, -0.004, 0.001, 0.0])),
    "pincushion": Distortion("plumb_bob", np.array([0.12, 0.02, 0.0, 0.001, 0.0])),
}


@pytest.mark.parametrize("lens", LENSES.values(), ids=LENSES.keys())
def test_distorted_pictures_show_targets_where_the_lens_puts_them(blender, lens):
    from monocell.scene.rendering import render_linear
    from test_blender_camera import centroid, discs

    intrinsics = Intrinsics(320, 240, 230.0, 232.0, 163.0, 115.0, lens)
    pose = Pose.looking_at([1.0, -1.0, 0.6], [0, 0, 0], [0, 0, 1.0])
    pixels = np.array([[30.0, 25.0], [290.4, 30.2], [160.0, 120.0], [40.5, 210.9]])
    centres = intrinsics.rays(pixels)
    centres *= 2.0 / centres[:, 2:]
    # small targets: a large one is bent by the lens, and its centre of light moves
    discs(blender, blender.context.scene, pose, centres, radius=0.02)
    picture = render_linear(blender.context.scene, Camera(intrinsics, pose), samples=256, bounces=0)
    found = [centroid(picture, pixel, 12) for pixel in pixels]
    assert np.abs(found - intrinsics.project(centres)).max() < 0.05


@pytest.mark.parametrize("lens", [Distortion(), LENSES["plumb_bob"]], ids=["perfect", "distorted"])
def test_a_picture_file_holds_the_srgb_of_the_linear_light(blender, tmp_path, lens):
    import cv2
    from monocell.scene.rendering import encoded_srgb, render_linear, render_picture
    from test_blender_camera import discs

    camera = Camera(
        Intrinsics(96, 64, 100.0, 100.0, 47.5, 31.5, lens),
        Pose.looking_at([1.0, -1.0, 0.6], [0, 0, 0], [0, 0, 1.0]),
    )
    scene = blender.context.scene
    discs(blender, scene, camera.pose, np.array([[0.1, 0.0, 1.0]]), radius=0.2)
    tree = blender.data.materials["light"].node_tree
    next(n for n in tree.nodes if n.type == "EMISSION").inputs[0].default_value = (0.1, 0.3, 0.6, 1)
    path = tmp_path / "picture.png"
    render_picture(scene, camera, path, samples=4, bounces=0)
    expected = encoded_srgb(render_linear(scene, camera, samples=4, bounces=0)) * 255
    picture = cv2.cvtColor(cv2.imread(str(path)), cv2.COLOR_BGR2RGB)
    assert picture.shape == (64, 96, 3)
    assert np.abs(picture - expected).max() <= 1.0
    assert list(tmp_path.iterdir()) == [path]


def test_a_window_renders_that_part_alone(blender):
    from monocell.scene.rendering import render_linear
    from test_blender_camera import discs

    camera = Camera(Intrinsics(96, 64, 100.0, 100.0, 47.5, 31.5), Pose.identity())
    discs(blender, blender.context.scene, camera.pose, np.array([[0, 0, 1.0]]), radius=2.0)
    picture = render_linear(
        blender.context.scene, camera, samples=1, bounces=0, window=(10, 20, 30, 16)
    )
    lit = np.argwhere(picture[:, :, 0] > 0.5)
    assert lit.min(axis=0).tolist() == [20, 10]
    assert lit.max(axis=0).tolist() == [35, 39]


def test_a_field_of_view_too_wide_for_a_flat_picture_is_refused(blender, tmp_path):
    from monocell.scene.rendering import render_picture

    fisheye = Distortion("equidistant", np.zeros(4))
    camera = Camera(Intrinsics(320, 240, 90.0, 90.0, 160, 120, fisheye), Pose.identity())
    with pytest.raises(InvalidValue, match="flat picture"):
        render_picture(blender.context.scene, camera, tmp_path / "x.png", samples=1)


def test_nothing_is_left_behind_when_the_folder_is_missing(blender, tmp_path):
    from monocell.scene.rendering import render_picture

    camera = Camera(Intrinsics(32, 24, 30.0, 30.0, 15.5, 11.5), Pose.identity())
    with pytest.raises(MonocellError, match="folder"):
        render_picture(blender.context.scene, camera, tmp_path / "no" / "x.png", samples=1)
    assert list(tmp_path.iterdir()) == []
