# SPDX-License-Identifier: GPL-3.0-or-later
"""Phone pictures with a rotation tag, read for cameras of the stored and of the upright pixels."""

import struct
import zlib
from dataclasses import replace

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from monocell.core.errors import PictureError
from monocell.core.intrinsics import Intrinsics
from monocell.core.picture.orientation import TURNS, orientation_of, upright
from monocell.core.picture.pictures import read_picture, read_picture_told, upright_size

STORED = Intrinsics(64, 48, 60.0, 60.0, 31.0, 23.0)
UPRIGHT = Intrinsics(48, 64, 60.0, 60.0, 23.0, 31.0)
QUARTERS = (5, 6, 7, 8)


def picture():
    return np.random.default_rng(4).integers(0, 255, (48, 64, 3), dtype=np.uint8)


def tiff(orientation, order):
    sign, kind = (">", b"MM\x00*") if order == "big" else ("<", b"II*\x00")
    other = struct.pack(sign + "HHII", 0x0110, 4, 1, 7)
    entry = struct.pack(sign + "HHIHH", 0x0112, 3, 1, orientation, 0)
    head = kind + struct.pack(sign + "I", 8)
    return head + struct.pack(sign + "H", 2) + other + entry + b"\x00" * 4


def jpeg(orientation, order="big", image=None):
    data = cv2.imencode(".jpg", picture() if image is None else image)[1].tobytes()
    block = b"Exif\x00\x00" + tiff(orientation, order)
    segment = b"\xff\xe1" + struct.pack(">H", len(block) + 2) + block
    return data[:2] + segment + data[2:]


def png(orientation):
    data = cv2.imencode(".png", picture())[1].tobytes()
    block = b"eXIf" + tiff(orientation, "little")
    chunk = struct.pack(">I", len(block) - 4) + block + struct.pack(">I", zlib.crc32(block))
    # the header chunk is 25 bytes long
    return data[:33] + chunk + data[33:]


@pytest.mark.parametrize("orientation", range(1, 9))
def test_a_picture_is_turned_as_opencv_turns_it(tmp_path, orientation):
    path = tmp_path / "a.jpg"
    path.write_bytes(jpeg(orientation))
    turned = upright(read_picture(path), orientation_of(path.read_bytes()))
    assert (turned == cv2.imread(str(path))).all()


@pytest.mark.parametrize("orientation", range(1, 9))
def test_the_tag_is_read_in_either_order_and_from_a_png(orientation):
    assert orientation_of(jpeg(orientation, "big")) == orientation
    assert orientation_of(jpeg(orientation, "little")) == orientation
    assert orientation_of(png(orientation)) == orientation


def test_the_tag_is_found_behind_what_photo_editors_write_first():
    data = jpeg(6)
    assert orientation_of(data[:2] + b"\xff\xe1\x00\x08http:/" + data[2:]) == 6


@given(st.binary(max_size=80), st.integers(0, 70))
def test_damaged_tags_are_none(junk, at):
    data = bytearray(jpeg(6))
    data[2 + at : 2 + at + len(junk)] = junk
    assert 1 <= orientation_of(bytes(data)) <= 8


@pytest.mark.parametrize("orientation", QUARTERS)
def test_a_camera_of_the_upright_pixels_gets_them_and_it_is_said(tmp_path, orientation):
    path = tmp_path / "phone.jpg"
    path.write_bytes(jpeg(orientation))
    pixels, told = read_picture_told(path, UPRIGHT)
    assert (pixels == cv2.imread(str(path))).all()
    assert told[0].startswith(f"phone.jpg: its EXIF tag {TURNS[orientation]}")
    assert "48 x 64 px" in told[0]
    assert upright_size(path) == (48, 64)


@pytest.mark.parametrize("orientation", QUARTERS)
def test_a_camera_of_the_stored_pixels_gets_those(tmp_path, orientation):
    path = tmp_path / "phone.jpg"
    path.write_bytes(jpeg(orientation))
    pixels, told = read_picture_told(path, STORED)
    assert pixels.shape == (48, 64, 3)
    assert told == ()


@pytest.mark.parametrize("orientation", [2, 3, 4])
def test_half_a_turn_that_no_size_can_tell_is_doubted(tmp_path, orientation):
    path = tmp_path / "phone.jpg"
    path.write_bytes(jpeg(orientation))
    pixels, told = read_picture_told(path, STORED)
    assert (pixels == read_picture(path)).all()
    assert "used as stored" in told[0]
    assert upright_size(path) == (64, 48)


def test_a_square_picture_turned_by_a_quarter_is_doubted(tmp_path):
    path = tmp_path / "phone.jpg"
    path.write_bytes(jpeg(6, image=picture()[:, :48]))
    square = replace(STORED, width=48, height=48)
    assert "either way" in read_picture_told(path, square)[1][0]


def test_a_size_that_fits_neither_way_is_refused_with_both_sizes_and_the_tag(tmp_path):
    path = tmp_path / "phone.jpg"
    path.write_bytes(jpeg(6))
    wanted = "turns it by 90 degrees.*64 x 48 px, the camera file says 80 x 60"
    with pytest.raises(PictureError, match=wanted):
        read_picture(path, replace(STORED, width=80, height=60))


def test_a_picture_without_a_tag_is_not_turned(tmp_path):
    path = tmp_path / "a.png"
    path.write_bytes(cv2.imencode(".png", picture())[1].tobytes())
    with pytest.raises(PictureError, match="64 x 48 px, the camera file says 48 x 64"):
        read_picture(path, UPRIGHT)
