# SPDX-License-Identifier: GPL-3.0-or-later
"""The sample camera says the same in every format, as far as the format can say it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from monocell.core.document.camera_file import read_camera
from monocell.core.lens.board import Chessboard
from monocell.core.lens.calibrate_lens import calibrate_lens
from monocell.core.lens.parameters import parameters_of
from monocell.core.picture.pictures import read_picture

SAMPLES = Path(__file__).resolve().parents[2] / "samples" / "02_cameras"
# what a format has no place for: ViSP knows one radial coefficient, fSpy square pixels alone
LESS = {"visp.xml": [-0.12, 0, 0, 0, 0], "fspy.json": []}


FILES = sorted(path for path in SAMPLES.iterdir() if path.is_file())


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_the_sample_camera_is_one(path):
    lens, same = read_camera(path).intrinsics, read_camera(SAMPLES / "camera.json").intrinsics
    assert (lens.width, lens.height) == (same.width, same.height)
    focal = [1208.5, 1208.5] if path.name == "fspy.json" else [same.fx, same.fy]
    np.testing.assert_allclose([lens.fx, lens.fy], focal, rtol=1e-12)
    np.testing.assert_allclose([lens.cx, lens.cy], [same.cx, same.cy], rtol=1e-12)
    expected = LESS.get(path.name, same.distortion.coefficients)
    np.testing.assert_array_equal(lens.distortion.coefficients, expected)


def test_the_sample_pictures_of_a_board_give_their_lens_back():
    names = [str(path) for path in sorted((SAMPLES / "board").glob("*.jpg"))]
    found = calibrate_lens(names, read_picture, Chessboard(9, 6, 0.025))
    truth = read_camera(SAMPLES / "board" / "truth.json").intrinsics
    error = parameters_of(found.lens)[:4] - parameters_of(truth)[:4]
    sigma = np.array(list(found.quality.sigmas().values()))[:4]
    assert found.verdict == "good"
    assert len(names) == len(found.fit.views) == 12
    assert (np.abs(error) < 4 * sigma).all()
