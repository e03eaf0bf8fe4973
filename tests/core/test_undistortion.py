# SPDX-License-Identifier: GPL-3.0-or-later
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from monocell.core.distortion import Distortion
from monocell.core.errors import InvalidValue
from monocell.core.intrinsics import Intrinsics
from monocell.core.picture.undistortion import (
    distorted_picture,
    distorted_window,
    pinhole_around,
    view_map,
    window_behind,
)

LENSES = {
    "plumb_bob": Distortion("plumb_bob", [-0.28, 0.09, 0.001, -0.002, 0.0]),
    "fisheye": Distortion("equidistant", [0.02, -0.004, 0.0, 0.0]),
}
WIDTH, HEIGHT = 96, 72


def lens(name):
    return Intrinsics(WIDTH, HEIGHT, 90.0, 91.0, 45.0, 37.0, LENSES[name])


@cache
def pictures(name):
    """A finer pinhole, its picture of noise, and what the lens makes of the whole of it."""
    pinhole = pinhole_around(lens(name), 2)
    rng = np.random.default_rng(1)
    perfect = rng.random((pinhole.height, pinhole.width, 3), dtype=np.float32)
    return pinhole, perfect, distorted_picture(perfect, pinhole, lens(name))


@pytest.mark.parametrize("name", LENSES)
@settings(deadline=None, max_examples=40)
@given(
    x=st.integers(0, WIDTH - 4),
    y=st.integers(0, HEIGHT - 4),
    width=st.integers(4, 40),
    height=st.integers(4, 40),
)
def test_a_window_of_a_distorted_picture_needs_only_what_lies_behind_it(name, x, y, width, height):
    intrinsics, (pinhole, perfect, whole) = lens(name), pictures(name)
    window = (x, y, min(width, WIDTH - x), min(height, HEIGHT - y))
    left, top, w, h = window_behind(pinhole, intrinsics, window)
    part = perfect[top : top + h, left : left + w]
    seen = distorted_window(part, (left, top), pinhole, intrinsics, window)
    expected = whole[y : y + window[3], x : x + window[2]]
    # OpenCV interpolates to 1/32 px; a pixel's neighbour differs by a third
    off = np.abs(seen - expected)
    assert off[1:-1, 1:-1].max() < 0.01
    # at a window's rim a pixel's area is known from one side only
    assert off.max() < 0.05


def test_a_window_where_the_lens_sees_nothing_is_refused():
    folded = Intrinsics(
        400, 300, 90.0, 90.0, 200.0, 150.0, Distortion("plumb_bob", [-0.28, 0, 0, 0, 0])
    )
    pinhole = Intrinsics(800, 600, 180.0, 180.0, 400.0, 300.0)
    with pytest.raises(InvalidValue, match="images nothing"):
        window_behind(pinhole, folded, (0, 0, 20, 20))


MAPPED = {
    "plain": (800, 600, 760.0, Distortion("plumb_bob", [-0.22, 0.07, 0.0006, -0.0004, -0.01])),
    "seeing less than its frame": (
        801,
        603,
        300.0,
        Distortion("plumb_bob", [-0.35, 0.12, 0, 0, -0.02]),
    ),
    "turning over": (640, 480, 150.0, Distortion("plumb_bob", [-0.4, 0.1, 0.001, 0, 0])),
    "fisheye": (640, 480, 200.0, Distortion("equidistant", [0.02, -0.01, 0.003, 0])),
    "smaller than a block": (7, 5, 8.0, Distortion("plumb_bob", [-0.2, 0, 0, 0, 0])),
}


@pytest.mark.parametrize("name", MAPPED)
def test_the_map_of_a_view_is_that_of_every_pixel(name):
    width, height, focal, distortion = MAPPED[name]
    i = Intrinsics(width, height, focal, focal, 0.51 * width, 0.48 * height, distortion)
    v, u = np.mgrid[:height, :width]
    true = i.project(i.undistorted().rays(np.stack([u.ravel(), v.ravel()], 1).astype(float)))
    error = np.abs(view_map(i) - true.reshape(height, width, 2))
    assert (np.isnan(error) == np.isnan(true.reshape(height, width, 2))).all()
    assert np.nanmax(error) <= 0.005
