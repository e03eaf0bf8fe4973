# SPDX-License-Identifier: GPL-3.0-or-later
import cv2
import numpy as np
import pytest
from monocell.core import Camera, Cell
from monocell.core.distortion import Distortion
from monocell.core.errors import PictureError
from monocell.core.intrinsics import Intrinsics
from monocell.core.picture.plate import encoded, read_plate
from monocell.core.picture.undistortion import undistorted_picture, undistorted_window

LENS = Distortion("plumb_bob", np.array([-0.25, 0.06, 0.001, -0.0005, 0.0]))
INTRINSICS = Intrinsics(160, 120, 120.0, 122.0, 81.0, 57.5, LENS)


def decoded(png):
    return cv2.imdecode(np.frombuffer(png, np.uint8), cv2.IMREAD_UNCHANGED)


@pytest.fixture
def cell(tmp_path):
    picture = np.random.default_rng(2).integers(0, 256, (120, 160, 3)).astype(np.uint8)
    cv2.imwrite(str(tmp_path / "cell.png"), picture)
    return Cell(Camera(INTRINSICS), picture="cell.png", folder=tmp_path)


def test_a_plate_is_the_undistorted_picture_and_tells_what_it_comes_to(cell):
    told = []
    plate = read_plate(cell, "cell.png", told.append)
    picture = cv2.imread(str(cell.path_of("cell.png")))
    assert (decoded(plate.png) == undistorted_picture(picture, INTRINSICS)).all()
    assert (plate.name, plate.told) == ("cell.png", ())
    assert told == ["reading cell.png", "undistorting it", "packing it"]


def test_a_plate_of_a_picture_that_is_not_there_is_refused(cell):
    with pytest.raises(PictureError, match=r"none\.png: there is no such picture"):
        read_plate(cell, "none.png")


def test_sixteen_bits_are_rounded_to_the_nearest_of_eight():
    values = np.arange(65536, dtype=np.uint16).reshape(256, 256)
    levels = decoded(encoded(np.repeat(values[:, :, None], 3, axis=2)))[:, :, 1]
    assert (levels == np.rint(values / 257)).all()


@pytest.mark.parametrize("window", [(0, 0, 23, 17), (70, 50, 9, 9), (140, 100, 20, 20)])
@pytest.mark.parametrize("lens", [INTRINSICS, INTRINSICS.undistorted()])
def test_a_window_of_the_view_is_cut_from_it(cell, window, lens):
    picture = cv2.imread(str(cell.path_of("cell.png")))
    # smooth, since the whole view's map is interpolated to a 200th of a pixel
    picture = cv2.GaussianBlur(picture, (0, 0), 4.0)
    x, y, width, height = window
    whole = undistorted_picture(picture, lens)[y : y + height, x : x + width]
    part = undistorted_window(picture, lens, window)
    assert np.abs(part.astype(int) - whole.astype(int)).max() <= 1
