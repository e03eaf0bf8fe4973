# SPDX-License-Identifier: GPL-3.0-or-later
import warnings

import numpy as np
from monocell.core.align.window import Window

WINDOW = Window(10, 20, 1, 40, 30)


def test_a_hull_that_reaches_far_out_fills_the_window_without_a_numeric_warning():
    hull = np.array([[-1e12, -1e12], [1e12, -1e12], [1e12, 1e12], [-1e12, 1e12]])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert WINDOW.mask(hull).all()


def test_corners_that_are_nowhere_are_left_out():
    square = [[20.0, 30.0], [30.0, 30.0], [30.0, 40.0], [20.0, 40.0]]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with_gap = WINDOW.mask(np.array([*square, [np.nan, np.nan]]))
        assert not WINDOW.mask(np.full((3, 2), np.nan)).any()
    assert (with_gap == WINDOW.mask(np.array(square))).all()
    assert with_gap.sum() == 11 * 11
