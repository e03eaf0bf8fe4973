# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures are read as they are stored or refused, and light is decoded as sRGB states."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from monocell.core import Intrinsics
from monocell.core.errors import PictureError
from monocell.core.picture.pictures import linear_light, read_picture
from monocell.core.picture.synthetic import Ball, Photographer, photograph

LENS = Intrinsics(64, 48, 60.0, 60.0, 31.5, 23.5)


@pytest.fixture(scope="module")
def picture():
    return photograph(LENS, (Ball((0.0, 0.0, 1.0), 0.2),), Photographer(texture=0.3))


def encoded(picture, ending, *options):
    done, data = cv2.imencode(ending, picture, list(options))
    assert done
    return data.tobytes()


@pytest.mark.parametrize("ending", [".png", ".bmp", ".tiff"])
def test_a_picture_is_read_exactly_as_it_is_stored(tmp_path, picture, ending):
    path = tmp_path / f"a{ending}"
    path.write_bytes(encoded(picture, ending))
    read = read_picture(path, LENS)
    assert read.dtype == np.uint8
    np.testing.assert_array_equal(read, picture)


def test_sixteen_bits_stay_sixteen_and_grey_becomes_three_channels(tmp_path, picture):
    deep = picture.astype(np.uint16) * 257
    (tmp_path / "deep.png").write_bytes(encoded(deep, ".png"))
    np.testing.assert_array_equal(read_picture(tmp_path / "deep.png"), deep)
    (tmp_path / "grey.png").write_bytes(encoded(picture[..., 1], ".png"))
    grey = read_picture(tmp_path / "grey.png")
    np.testing.assert_array_equal(grey, np.repeat(picture[..., 1:2], 3, axis=2))


def test_a_transparent_picture_loses_only_its_alpha(tmp_path, picture):
    alpha = np.dstack([picture, np.full(picture.shape[:2], 200, np.uint8)])
    (tmp_path / "a.png").write_bytes(encoded(alpha, ".png"))
    np.testing.assert_array_equal(read_picture(tmp_path / "a.png"), picture)


def test_a_phone_s_rotation_tag_is_ignored(tmp_path, picture):
    jpeg = encoded(picture, ".jpg")
    # an EXIF segment that says: turn by a quarter
    tag = b"MM\x00*\x00\x00\x00\x08\x00\x01\x01\x12\x00\x03\x00\x00\x00\x01\x00\x06\x00\x00"
    exif = b"Exif\x00\x00" + tag + b"\x00\x00\x00\x00"
    segment = b"\xff\xe1" + (len(exif) + 2).to_bytes(2, "big") + exif
    (tmp_path / "a.jpg").write_bytes(jpeg[:2] + segment + jpeg[2:])
    assert read_picture(tmp_path / "a.jpg", LENS).shape == (48, 64, 3)


@pytest.mark.parametrize("ending", [".png", ".jpg"])
def test_a_picture_that_breaks_off_anywhere_is_refused(tmp_path_factory, picture, capfd, ending):
    whole = encoded(picture, ending)
    path = tmp_path_factory.mktemp("cut") / f"a{ending}"

    @settings(max_examples=40, deadline=None)
    @given(st.integers(0, len(whole) - 13))
    def cut(length):
        path.write_bytes(whole[:length])
        with pytest.raises(PictureError) as refusal:
            read_picture(path)
        assert str(path) in str(refusal.value)
        assert "\n" not in str(refusal.value)

    cut()
    assert capfd.readouterr().err == ""


def test_a_thumbnail_s_end_is_not_taken_for_the_picture_s(tmp_path, picture):
    thumbnail = encoded(cv2.resize(picture, (16, 12)), ".jpg")
    jpeg = encoded(picture, ".jpg")
    segment = b"\xff\xe1" + (len(thumbnail) + 2).to_bytes(2, "big") + thumbnail
    with_thumbnail = jpeg[:2] + segment + jpeg[2:]
    (tmp_path / "a.jpg").write_bytes(with_thumbnail)
    assert read_picture(tmp_path / "a.jpg").shape == (48, 64, 3)
    (tmp_path / "a.jpg").write_bytes(with_thumbnail[:-200])
    with pytest.raises(PictureError, match="breaks off"):
        read_picture(tmp_path / "a.jpg")


def test_a_png_spoilt_anywhere_is_refused(tmp_path, picture):
    whole = encoded(picture, ".png")
    path = tmp_path / "a.png"
    for at in range(60, len(whole) - 40, len(whole) // 25):
        path.write_bytes(whole[:at] + bytes([whole[at] ^ 0x5A]) + whole[at + 1 :])
        with pytest.raises(PictureError, match="no picture OpenCV can read"):
            read_picture(path)


@pytest.mark.parametrize(
    ("content", "told"),
    [(b"", "0 bytes that are no picture"), (b"words", "5 bytes that are no picture")],
)
def test_what_is_no_picture_is_refused(tmp_path, content, told):
    (tmp_path / "a.png").write_bytes(content)
    with pytest.raises(PictureError, match=told):
        read_picture(tmp_path / "a.png")


def test_missing_pictures_and_folders_are_named(tmp_path):
    with pytest.raises(PictureError, match=r"none\.png: there is no such picture"):
        read_picture(tmp_path / "none.png")
    with pytest.raises(PictureError, match="can't be read"):
        read_picture(tmp_path)


def test_a_picture_of_another_size_is_refused_with_both(tmp_path, picture):
    (tmp_path / "a.png").write_bytes(encoded(picture[:, :60], ".png"))
    with pytest.raises(PictureError, match="60 x 48 px, the camera file says 64 x 48"):
        read_picture(tmp_path / "a.png", LENS)


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_light_is_decoded_as_srgb_states(dtype):
    top = np.iinfo(dtype).max
    levels = np.array([0, 0.02, 0.04, 0.05, 0.5, 0.735357, 1.0])
    picture = np.rint(levels * top).astype(dtype).reshape(1, -1, 1).repeat(3, axis=2)
    light = linear_light(picture)[0, :, 0]
    # the standard's own formula, the other way round
    coded = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    np.testing.assert_allclose(coded, levels, atol=0.6 / top)
    assert light[0] == 0
    assert light[-1] == 1
    assert light[-2] == pytest.approx(0.5, abs=0.005)


def test_a_picture_of_other_numbers_than_8_or_16_bits_is_refused():
    with pytest.raises(PictureError, match="float64 values; give it as it was encoded"):
        linear_light(np.zeros((4, 4, 3)))
