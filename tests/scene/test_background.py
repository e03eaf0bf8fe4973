# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest
from monocell.core.distortion import Distortion
from monocell.core.errors import PictureError
from monocell.core.intrinsics import Intrinsics
from monocell.core.picture.undistortion import undistorted_picture

LENS = Distortion("plumb_bob", np.array([-0.25, 0.06, 0.001, -0.0005, 0.0]))
INTRINSICS = Intrinsics(160, 120, 120.0, 122.0, 81.0, 57.5, LENS)


def spots(pixels):
    """Bright, smooth spots of 2.5 px at exact places."""
    v, u = np.mgrid[: INTRINSICS.height, : INTRINSICS.width]
    light = sum(np.exp(-((u - x) ** 2 + (v - y) ** 2) / (2 * 2.5**2)) for x, y in pixels)
    return np.repeat((light * 250).round().astype(np.uint8)[:, :, None], 3, axis=2)


def test_undistorting_moves_spots_to_where_a_perfect_lens_has_them():
    rays = INTRINSICS.rays(np.array([[30.0, 25.0], [130.3, 95.6], [80.0, 60.0]]))
    flat = undistorted_picture(spots(INTRINSICS.project(rays)), INTRINSICS)[:, :, 0].astype(float)
    for u, v in INTRINSICS.undistorted().project(rays):
        x, y = round(u), round(v)
        part = flat[max(y - 9, 0) : y + 10, max(x - 9, 0) : x + 10]
        vs, us = np.mgrid[: part.shape[0], : part.shape[1]]
        centre = np.array([(part * us).sum(), (part * vs).sum()]) / part.sum()
        corner = np.array([max(x - 9, 0), max(y - 9, 0)])
        assert centre + corner == pytest.approx([u, v], abs=0.1)


def test_a_perfect_lens_changes_no_pixel_and_returns_a_copy():
    picture = spots([[40.0, 40.0]])
    flat = undistorted_picture(picture, INTRINSICS.undistorted())
    assert (flat == picture).all()
    assert flat is not picture


def test_a_picture_of_another_size_is_refused():
    with pytest.raises(PictureError, match=r"\(120, 160, 3\)"):
        undistorted_picture(np.zeros((60, 80, 3), np.uint8), INTRINSICS)


@pytest.fixture
def camera(blender):
    camera = blender.data.objects.new("camera", blender.data.cameras.new("camera"))
    blender.context.scene.collection.objects.link(camera)
    return camera


@pytest.mark.blender
@pytest.mark.parametrize("kind", [np.uint8, np.uint16])
def test_the_background_holds_the_pictures_pixels_upright(blender, camera, kind):
    from monocell.scene.background import show_background

    perfect = INTRINSICS.undistorted()
    picture = np.random.default_rng(1).integers(0, 256, (120, 160, 3)).astype(kind)
    picture *= np.iinfo(kind).max // 255
    image = show_background(camera, picture, perfect, alpha=0.5)
    pixels = np.array(image.pixels[:]).reshape(120, 160, 4)[::-1, :, :3]
    assert np.abs(pixels - picture[:, :, ::-1] / np.iinfo(kind).max).max() < 1e-6
    (background,) = camera.data.background_images
    assert background.frame_method == "STRETCH"
    assert background.alpha == 0.5
    assert camera.data.show_background_images


@pytest.mark.blender
def test_a_second_background_replaces_the_first_even_in_another_size(blender, camera):
    from monocell.scene.background import show_background

    show_background(camera, np.zeros((120, 160, 3), np.uint8), INTRINSICS)
    small = Intrinsics(80, 60, 60.0, 60.0, 40.0, 30.0)
    image = show_background(camera, np.full((60, 80, 3), 200, np.uint8), small)
    assert len(camera.data.background_images) == 1
    assert len(blender.data.images) == 1
    assert tuple(image.size) == (80, 60)
    assert image.pixels[0] == pytest.approx(200 / 255)


@pytest.mark.blender
def test_the_background_is_in_the_saved_file(blender, camera, tmp_path):
    from monocell.scene.background import show_background

    picture = np.full((120, 160, 3), 77, np.uint8)
    for value in (10, 77):
        picture[:] = value
        show_background(camera, picture, INTRINSICS.undistorted())
    blender.ops.wm.save_as_mainfile(filepath=str(tmp_path / "x.blend"))
    blender.ops.wm.open_mainfile(filepath=str(tmp_path / "x.blend"))
    (background,) = blender.data.objects["camera"].data.background_images
    assert background.image.pixels[0] == pytest.approx(77 / 255)
