# SPDX-License-Identifier: GPL-3.0-or-later
"""Rendered boards: corners found to hundredths of a pixel, poor pictures named, the lens found."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from board_views import LENSES
from monocell.core.errors import (
    BoardNotFound,
    InvalidValue,
    PictureError,
    TooFewPictures,
)
from monocell.core.lens.board import CharucoBoard, Chessboard
from monocell.core.lens.calibrate_lens import calibrate_lens, pattern_told
from monocell.core.lens.detection import find_board, seen_pattern
from monocell.core.lens.lens_overlay import draw_coverage, draw_view, residual_gain
from monocell.core.lens.parameters import parameters_of
from monocell.core.lens.synthetic_board import (
    BoardPhotographer,
    photograph_boards,
    scattered_poses,
)

CHESS = Chessboard(9, 6, 0.025)
CHARUCO = CharucoBoard(8, 6, 0.03, 0.021, "DICT_5X5_100")
LENS = LENSES["plumb_bob"]


def shot(board, count, seed, lens=LENS, **how):
    rng = np.random.default_rng(seed)
    poses = scattered_poses(lens, board, count, rng)
    return poses, photograph_boards(lens, board, poses, BoardPhotographer(**how))


@pytest.fixture(scope="module")
def chess():
    """Nine pictures of a chessboard, by name."""
    _, pictures = shot(CHESS, 9, 11)
    return {f"{i}.png": picture for i, picture in enumerate(pictures)}


@pytest.fixture(scope="module")
def calibration(chess):
    return calibrate_lens(list(chess), chess.__getitem__, CHESS)


def off_pixels(view, pose, lens=LENS):
    """Seen minus true; a chessboard seen upside down is the same chessboard."""
    truth = lens.project(pose.apply(view.points))
    turned = lens.project(pose.apply(view.points[::-1]))
    return min((view.pixels - t for t in (truth, turned)), key=lambda off: np.abs(off).max())


@pytest.mark.parametrize("board", [CHESS, CHARUCO], ids=["chessboard", "charuco"])
def test_corners_are_found_without_bias(board):
    poses, pictures = shot(board, 3, 2)
    off = np.concatenate(
        [
            off_pixels(find_board(picture, board, "a"), pose)
            for pose, picture in zip(poses, pictures, strict=True)
        ]
    )
    # OpenCV's own ChArUco corners are half a pixel off before 4.13
    assert np.abs(off.mean(axis=0)).max() < 0.015
    assert off.std() < 0.05
    assert np.abs(off).max() < 0.25


def test_the_blur_told_is_that_of_the_picture():
    for blur in (0.8, 2.0):
        _, (picture,) = shot(CHESS, 1, 2, blur_pixels=blur)
        # the pixel's own width comes on top
        assert abs(find_board(picture, CHESS, "a").blur_pixels - np.hypot(blur, 0.3)) < 0.3


def test_a_large_picture_is_searched_small_and_measured_large():
    _, (picture,) = shot(CHESS, 1, 3)
    large = cv2.resize(picture, None, fx=4, fy=4, interpolation=cv2.INTER_CUBIC)
    small, big = find_board(picture, CHESS, "a"), find_board(large, CHESS, "b")
    back = (big.pixels + 0.5) / 4 - 0.5
    same = min(np.abs(small.pixels - p).max() for p in (back, back[::-1]))
    assert same < 0.15


def test_sixteen_bits_and_grey_give_the_same_corners():
    _, (picture,) = shot(CHESS, 1, 3)
    pixels = find_board(picture, CHESS, "a").pixels
    np.testing.assert_array_equal(
        find_board(picture.astype(np.uint16) * 257, CHESS, "a").pixels, pixels
    )
    np.testing.assert_allclose(find_board(picture[:, :, 0], CHESS, "a").pixels, pixels, atol=1e-3)


@pytest.mark.parametrize(
    ("spoil", "told"),
    [
        (lambda p: np.full_like(p, 128), "no chessboard of 9x6 inner corners found"),
        (lambda p: cv2.GaussianBlur(p, (0, 0), 5.5), "blurred: edges of|no chessboard"),
        (lambda p: cv2.resize(p, None, fx=0.2, fy=0.2, interpolation=3), "too small|no chessboard"),
        (lambda p: p[:, :300], "no chessboard"),
    ],
)
def test_a_poor_picture_is_refused_with_the_reason(spoil, told):
    _, (picture,) = shot(CHESS, 1, 6)
    find_board(picture, CHESS, "a")
    with pytest.raises(BoardNotFound, match=told):
        find_board(spoil(picture), CHESS, "a")


def test_too_small_squares_are_named():
    far = scattered_poses(LENS, CHESS, 1, np.random.default_rng(1), fill=0.11)
    (picture,) = photograph_boards(LENS, CHESS, far, BoardPhotographer(0.3, 0.5))
    with pytest.raises(BoardNotFound, match=r"too small: its squares are \d\.\d px"):
        find_board(picture, CHESS, "a")


def test_the_old_charuco_pattern_is_recognised():
    old = CharucoBoard(8, 6, 0.03, 0.021, "DICT_5X5_100", legacy=True)
    _, pictures = shot(old, 4, 2)
    assert seen_pattern(pictures[0], CHARUCO) == old
    assert "of before OpenCV 4.6" in pattern_told(old, CHARUCO)
    found = calibrate_lens(list("0123"), lambda name: pictures[int(name)], CHARUCO, "plumb_bob")
    assert found.board == old
    _, (new,) = shot(CHARUCO, 1, 2)
    assert seen_pattern(new, CHARUCO) == CHARUCO
    assert pattern_told(CHARUCO, CHARUCO) is None
    # an odd number of rows looks the same in both
    odd = CharucoBoard(8, 5, 0.03, 0.021, "DICT_5X5_100")
    assert seen_pattern(new, odd) == odd


def test_pictures_of_a_board_give_the_lens_within_its_sigmas(calibration):
    error = parameters_of(calibration.lens)[:4] - parameters_of(LENS)[:4]
    sigma = np.array(list(calibration.quality.sigmas().values()))[:4]
    assert (np.abs(error) < 4 * sigma).all()
    assert sigma.max() < 0.5
    assert calibration.lens.distortion.model == "plumb_bob"
    assert calibration.fit.rms_pixels < 0.08
    assert {report.status for report in calibration.pictures} == {"used"}
    assert len(calibration.models) == 5


def test_charuco_pictures_through_a_fisheye_give_it_back():
    fisheye = LENSES["equidistant"]
    _, pictures = shot(CHARUCO, 8, 4, lens=fisheye)
    found = calibrate_lens(
        [str(i) for i in range(8)], lambda name: pictures[int(name)], CHARUCO, "equidistant"
    )
    error = parameters_of(found.lens)[:4] - parameters_of(fisheye)[:4]
    assert (np.abs(error) < 4 * np.array(list(found.quality.sigmas().values()))[:4]).all()


def test_each_poor_picture_is_rejected_with_its_own_reason(chess):
    pictures = dict(chess)
    pictures["blank.png"] = np.full_like(chess["0.png"], 90)
    pictures["turned.png"] = np.ascontiguousarray(np.rot90(chess["1.png"]))
    # as a picture of another zoom: the middle, enlarged
    pictures["zoomed.png"] = cv2.resize(chess["2.png"][60:420, 80:560], (640, 480))

    def read(name):
        if name == "broken.png":
            raise PictureError("broken.png: the picture breaks off after 5 bytes; copy it again")
        return pictures[name]

    found = calibrate_lens([*pictures, "broken.png"], read, CHESS, "plumb_bob")
    reasons = {r.picture: r.reason for r in found.pictures if r.status == "rejected"}
    assert reasons.pop("blank.png").startswith("no chessboard")
    assert reasons.pop("turned.png") == "other size: 480 x 640 px, most are 640 x 480"
    assert reasons.pop("broken.png").startswith("the picture breaks off")
    # the zoomed board may have left the picture, but never counts
    assert set(reasons) <= {"zoomed.png"}
    zoomed = next(r for r in found.pictures if r.picture == "zoomed.png")
    assert zoomed.status == "rejected"
    assert found.warnings[0].startswith("4 of 13 pictures rejected: ")
    assert abs(found.lens.fx - LENS.fx) < 2


def test_a_board_that_did_not_move_counts_once(chess):
    pictures = chess | {"again.png": cv2.GaussianBlur(chess["3.png"], (0, 0), 0.6)}
    found = calibrate_lens(list(pictures), pictures.__getitem__, CHESS, "plumb_bob")
    again = next(r for r in found.pictures if r.picture == "again.png")
    assert (again.status, again.reason[:25]) == ("rejected", "the same view as 3.png: m")
    assert len(found.fit.views) == 9


def test_too_few_pictures_are_refused(chess):
    with pytest.raises(TooFewPictures, match=r"^2 of 2 pictures show the chessboard"):
        calibrate_lens(["0.png", "1.png"], chess.__getitem__, CHESS)
    with pytest.raises(TooFewPictures, match="1 of 1 pictures"):
        calibrate_lens(["0.png", "0.png", "0.png"], chess.__getitem__, CHESS)


def test_another_board_than_asked_for_is_named(chess):
    with pytest.raises(BoardNotFound, match=r"did you mean --board chessboard 9x6 0\.03\?"):
        calibrate_lens(["0.png"], chess.__getitem__, Chessboard(8, 6, 0.03))


@pytest.mark.parametrize(
    ("board", "told"),
    [
        (CHESS, r"markers of DICT_5X5_\d+ are seen; did you mean --board charuco"),
        (CharucoBoard(8, 6, 0.03, 0.021, "6X6_50"), r"did you mean DICT_5X5_\d+\?"),
        (CharucoBoard(4, 4, 0.03, 0.021, "5X5_100"), r"a marker of number \d+ is seen, a board"),
    ],
)
def test_markers_of_another_board_are_named(board, told):
    _, (picture,) = shot(CHARUCO, 1, 2)
    with pytest.raises((BoardNotFound, TooFewPictures), match=told):
        calibrate_lens(["a"], lambda name: picture, board)


def test_an_unknown_model_is_refused(chess):
    with pytest.raises(InvalidValue, match="is none of auto, none, plumb_bob"):
        calibrate_lens(["0.png"], chess.__getitem__, CHESS, "thin_prism")


def test_overlays_are_drawn_on_copies(calibration, chess):
    fit, picture = calibration.fit, chess["0.png"]
    before = picture.copy()
    gain = residual_gain(fit)
    drawn = draw_view(picture, fit, 0, gain)
    np.testing.assert_array_equal(picture, before)
    u, v = np.round(fit.views[0].pixels[20]).astype(int)
    assert (drawn[v, u] != picture[v, u]).any()
    assert draw_coverage(fit, gain).shape == picture.shape
    assert gain >= 1
