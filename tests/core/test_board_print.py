# SPDX-License-Identifier: GPL-3.0-or-later
"""Boards as they are said, drawn as OpenCV draws them, and printed in exact millimetres."""

from __future__ import annotations

import re
import zlib

import cv2
import numpy as np
import pytest
from monocell.core.errors import DocumentError, InvalidValue
from monocell.core.lens.board import CharucoBoard, Chessboard, board_from_words
from monocell.core.lens.board_print import page_millimetres, write_board
from monocell.core.lens.detection import find_board
from monocell.core.lens.drawing import board_picture

CHESS = Chessboard(9, 6, 0.025)
CHARUCO = CharucoBoard(8, 6, 0.03, 0.021, "DICT_5X5_100")


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ([], "give it as chessboard"),
        (["circles", "9x6", "0.02"], "give it as chessboard"),
        (["chessboard", "9x6"], "give it as chessboard"),
        (["chessboard", "9by6", "0.02"], "two numbers such as 9x6"),
        (["chessboard", "9x6", "wide"], "the square's side must be a number"),
        (["chessboard", "9x6", "25"], r"25 m is no board's; sides are in metres \(0.025 for 25"),
        (["chessboard", "9x6", "-1"], "must be above zero"),
        (["chessboard", "9x6", "nan"], "must be finite"),
        (["chessboard", "2x6", "0.02"], "at least 3 corners"),
        (["chessboard", "99x6", "0.02"], "at most 60 squares"),
        (["charuco", "7x5", "0.02", "0.03", "5X5_50"], "must be smaller than its square"),
        (["charuco", "7x5", "0.03", "0.02", "9X9_50"], "'9X9_50' is no dictionary"),
        (["charuco", "20x20", "0.03", "0.02", "5X5_50"], "needs 200 markers, DICT_5X5_50 has 50"),
    ],
)
def test_a_board_that_can_t_be_is_refused(words, told):
    with pytest.raises(InvalidValue, match=told):
        board_from_words(words)


def test_boards_are_read_as_they_are_said():
    assert board_from_words(["chessboard", "9x6", "0.025"]) == CHESS
    assert board_from_words(["charuco", "8x6", "0.03", "0.021", "5x5_100"]) == CHARUCO
    april = board_from_words(["charuco", "7X5", "0.03", "0.02", "dict_apriltag_36H11"])
    assert april.dictionary.upper() == "DICT_APRILTAG_36H11"


@pytest.mark.parametrize("legacy", [False, True])
@pytest.mark.parametrize("size", [(7, 5), (7, 6), (6, 6)])
def test_our_drawing_is_opencv_s(size, legacy):
    board = CharucoBoard(*size, 0.03, 0.02, "DICT_5X5_100", legacy)
    drawn = board.opencv().generateImage((size[0] * 84, size[1] * 84), marginSize=0)
    np.testing.assert_array_equal(board_picture(board, 84, 0.0), drawn)


@pytest.mark.parametrize("board", [CHESS, CHARUCO], ids=["chessboard", "charuco"])
def test_a_printed_board_has_the_size_it_states_and_is_found(tmp_path, board):
    width, height = page_millimetres(board)
    columns, rows = board.squares
    side = 1e3 * board.square
    assert (width, height) == pytest.approx(((columns + 2) * side, (rows + 2) * side))
    assert write_board(board, tmp_path / "a.png") == (width, height)
    data = (tmp_path / "a.png").read_bytes()
    at = data.index(b"pHYs")
    assert zlib.crc32(data[at : at + 13]).to_bytes(4, "big") == data[at + 13 : at + 17]
    picture = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR)
    dots_per_metre = int.from_bytes(data[at + 4 : at + 8], "big")
    assert picture.shape[1] / dots_per_metre * 1e3 == pytest.approx(width, rel=1e-3)
    small = cv2.resize(picture, None, fx=0.25, fy=0.25, interpolation=cv2.INTER_AREA)
    assert len(find_board(small, board, "a").numbers) == len(board.corners)


def test_vector_prints_hold_every_black_square_in_millimetres(tmp_path):
    write_board(CHESS, tmp_path / "a.svg")
    write_board(CHESS, tmp_path / "a.pdf")
    svg, pdf = (tmp_path / "a.svg").read_text(), (tmp_path / "a.pdf").read_bytes().decode()
    assert 'width="300mm" height="225mm"' in svg
    squares = re.findall(r'<rect x="([\d.]+)" y="([\d.]+)" width="25" height="25"/>', svg)
    assert len(squares) == 35
    boxes = re.findall(r"^([\d.]+) ([\d.]+) ([\d.]+) ([\d.]+) re$", pdf, re.MULTILINE)
    millimetres = np.array(boxes, float) * 25.4 / 72
    np.testing.assert_allclose(millimetres[:, 2:], 25, atol=1e-4)
    np.testing.assert_allclose(millimetres[:, 0], np.array(squares, float)[:, 0], atol=1e-4)
    # a PDF's y points up
    up = 225 - np.array(squares, float)[:, 1] - 25
    np.testing.assert_allclose(millimetres[:, 1], up, atol=1e-4)
    # the table at a PDF's end says at which byte each object begins
    for number, place in enumerate(re.findall(r"^(\d{10}) 00000 n", pdf, re.MULTILINE), 1):
        assert pdf[int(place) :].startswith(f"{number} 0 obj")


def test_a_board_is_not_printed_into_another_ending(tmp_path):
    with pytest.raises(DocumentError, match=r"ends in \.pdf, \.svg, \.png"):
        write_board(CHESS, tmp_path / "a.doc")
