# SPDX-License-Identifier: GPL-3.0-or-later
"""`monocell lens`: pictures of a board in, the camera's intrinsics with their errors out."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from ...core.camera import Camera
from ...core.errors import DocumentError, InvalidValue
from ..cli import DONE, NOT_TRUSTED
from ..told import print_json, progress, warn

PICTURE_ENDINGS = (".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff", ".webp", ".pgm", ".ppm")
MODELS = ("auto", "none", "plumb_bob", "rational_polynomial", "equidistant")
# OpenCV's number of the level that tells errors and no warnings
ERRORS_ONLY = 2
# a marker's white rim as a part of its cells, from which on it is found safely
SAFE_RIM = 0.7
WORDS_OF_A_BOARD = {"chessboard": 3, "charuco": 5}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's own arguments."""
    parser.add_argument(
        "pictures", nargs="*", help="pictures of the board, folders of them, or patterns: 'a/*.png'"
    )
    parser.add_argument(
        "--board",
        nargs="+",
        required=True,
        metavar="WORD",
        help="chessboard 9x6 0.025 (inner corners, side of a square in metres), or charuco 7x5 "
        "0.03 0.022 DICT_5X5_100 (squares, side of a square and of a marker, dictionary)",
    )
    parser.add_argument(
        "--model",
        choices=MODELS,
        default="auto",
        help="the distortion model; auto (default) takes the smallest that foretells unseen "
        "corners as well as the best",
    )
    parser.add_argument("--out", type=Path, help="camera file to write: .json, .yaml (ROS) or .yml")
    parser.add_argument("--overlay", type=Path, help="folder for the pictures with their corners")
    parser.add_argument("--print-board", type=Path, help="write the board to print: .pdf .svg .png")
    parser.add_argument("--json", action="store_true", help="print JSON")


def run(args: argparse.Namespace) -> int:
    """Print a board, or calibrate, tell, draw and write; a failed lens is told but not written."""
    from ...core.document.camera_file import check_camera_path, write_camera
    from ...core.lens.board import board_from_words
    from ...core.lens.calibrate_lens import calibrate_lens, pattern_told
    from ...core.picture.pictures import read_picture
    from ..lens_report import document, draw, tell

    words, more = _split(args.board)
    board = board_from_words(words)
    if args.print_board is not None:
        _print_board(args.print_board, board)
        if not args.pictures and not more:
            return DONE
    names = _pictures([*args.pictures, *more])
    if args.out is not None:
        check_camera_path(args.out)
    with _opencv_quiet():
        calibration = calibrate_lens(names, read_picture, board, args.model)
    failed = calibration.verdict == "failed"
    if args.out is not None and not failed:
        write_camera(Camera(calibration.lens), args.out)
    if args.overlay is not None:
        draw(calibration, args.overlay)
    if args.json:
        print_json(document(calibration))
    else:
        tell(calibration)
    told = pattern_told(calibration.board, board)
    warn([*([told] if told else []), *calibration.warnings])
    return NOT_TRUSTED if failed else DONE


@contextmanager
def _opencv_quiet() -> Iterator[None]:
    """OpenCV warns of tight markers once a picture, between our lines."""
    import cv2

    level = cv2.getLogLevel()
    cv2.setLogLevel(ERRORS_ONLY)
    try:
        yield
    finally:
        cv2.setLogLevel(level)


def _split(words: Sequence[str]) -> tuple[list[str], list[str]]:
    """The board's own words, and pictures that were named after them."""
    count = WORDS_OF_A_BOARD.get(words[0], len(words))
    return list(words[:count]), list(words[count:])


def _pictures(given: Sequence[str]) -> list[str]:
    """Every picture named, in a folder named, or that a pattern finds; each once."""
    if not given:
        raise InvalidValue("no pictures given: name the pictures of the board, or their folder")
    names: list[str] = []
    for one in given:
        path = Path(one)
        if path.is_dir():
            found = [str(p) for p in sorted(path.iterdir()) if _is_picture(p)]
            if not found:
                raise DocumentError(f"{path}: there is no picture in this folder")
        elif any(sign in one for sign in "*?[") and not path.exists():
            start = Path(path.anchor) if path.is_absolute() else Path()
            pattern = str(path.relative_to(path.anchor))
            found = [str(p) for p in sorted(start.glob(pattern)) if _is_picture(p)]
            if not found:
                raise DocumentError(f"{one}: no picture is named like this")
        else:
            found = [one]
        names += found
    return list(dict.fromkeys(names))


def _is_picture(path: Path) -> bool:
    return path.is_file() and path.suffix.lower() in PICTURE_ENDINGS


def _print_board(path: Path, board: object) -> None:
    from ...core.lens.board import CharucoBoard, Chessboard
    from ...core.lens.board_print import write_board

    assert isinstance(board, Chessboard | CharucoBoard)
    width, height = write_board(board, path)
    columns, rows = board.squares
    side = 1e3 * board.square
    progress(
        f"{path}: {board}, {width:g} x {height:g} mm with its margin. Print it at 100 % and glue "
        f"it on something flat; then measure: all {columns} squares across are "
        f"{columns * side:g} mm, all {rows} down {rows * side:g} mm. Give the side measured."
    )
    if isinstance(board, CharucoBoard):
        cell = board.marker / (board.markers.markerSize + 2)
        if 0.5 * (board.square - board.marker) < SAFE_RIM * cell:
            most = 1e3 * board.square / (1 + 2 * SAFE_RIM * cell / board.marker)
            warn([f"the markers fill their squares; at most {most:.1f} mm are found safely"])
