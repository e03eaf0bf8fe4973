# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures with a phone's rotation tag in Blender: upright where the camera says so, and told."""

import struct

import bench_cell
import cv2
import numpy as np
import pytest

pytestmark = pytest.mark.blender


def tagged(path, image, orientation):
    """A JPEG file whose EXIF tag states an orientation."""
    data = cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, 98])[1].tobytes()
    entry = struct.pack(">HHIHH", 0x0112, 3, 1, orientation, 0)
    block = b"Exif\x00\x00MM\x00*\x00\x00\x00\x08\x00\x01" + entry + b"\x00" * 4
    path.write_bytes(data[:2] + b"\xff\xe1" + struct.pack(">H", len(block) + 2) + block + data[2:])


@pytest.fixture
def upright(tmp_path):
    """The bench's first ball as a standing picture would show it."""
    bench_cell.write_bench(tmp_path)
    return cv2.imread(str(tmp_path / "ball_0.png"))


def shown(bpy):
    image = bpy.context.scene.monocell_cell.camera.data.background_images[0].image
    width, height = image.size
    pixels = np.empty(width * height * 4, np.float32)
    image.pixels.foreach_get(pixels)
    return pixels.reshape(height, width, 4)[::-1, :, 2::-1]


def test_a_typed_camera_is_that_of_the_picture_as_viewers_show_it(addon, upright, tmp_path):
    tagged(tmp_path / "phone.jpg", cv2.rotate(upright, cv2.ROTATE_90_COUNTERCLOCKWISE), 6)
    addon.context.scene.monocell_inputs.camera_source = "ANGLE"
    addon.ops.monocell.open_picture(picture=str(tmp_path / "phone.jpg"))
    scene = addon.context.scene
    assert (scene.render.resolution_x, scene.render.resolution_y) == (800, 600)
    assert np.abs(shown(addon) * 255 - upright).mean() < 3
    assert "turns it by 90 degrees" in scene.monocell_cell.shown_told


def test_what_was_said_of_a_picture_goes_with_it(addon, upright, tmp_path):
    tagged(tmp_path / "ball_0.jpg", upright, 3)
    document = tmp_path / "bench.cell.json"
    document.write_text(document.read_text().replace("ball_0.png", "ball_0.jpg"))
    addon.ops.monocell.open_cell(filepath=str(document))
    stored = addon.context.scene.monocell_cell
    assert stored.shown_told == ""
    addon.ops.monocell.show_picture(picture="ball_0.jpg")
    assert "turns it by 180 degrees" in stored.shown_told
    addon.ops.monocell.show_picture(picture="bench.png")
    assert stored.shown_told == ""
