# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of a chessboard through a known lens: `python samples/make_board_pictures.py`.

Writes 02_cameras/board/*.jpg and, as the lens they were taken through, 02_cameras/board/truth.json.
"""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
from monocell.core import Camera, Distortion, Intrinsics
from monocell.core.document.camera_file import write_camera
from monocell.core.lens.board import Chessboard
from monocell.core.lens.synthetic_board import (
    BoardPhotographer,
    photograph_boards,
    scattered_poses,
)

HERE = Path(__file__).parent / "02_cameras" / "board"
LENS = Intrinsics(
    640, 480, 605.0, 603.5, 322.9, 236.8, Distortion("plumb_bob", [-0.12, 0.05, 4e-4, -3e-4, 0])
)
BOARD = Chessboard(9, 6, 0.025)
COUNT, QUALITY, SEED = 12, 80, 4


def main() -> None:
    """Write the pictures and the truth."""
    HERE.mkdir(exist_ok=True)
    poses = scattered_poses(LENS, BOARD, COUNT, np.random.default_rng(SEED), 40.0, 0.5)
    for i, picture in enumerate(photograph_boards(LENS, BOARD, poses, BoardPhotographer(0.7, 1.0))):
        grey = cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY)
        how = [cv2.IMWRITE_JPEG_QUALITY, QUALITY]
        cv2.imwrite(str(HERE / f"board_{i:02d}.jpg"), grey, how)
    write_camera(Camera(LENS), HERE / "truth.json")


if __name__ == "__main__":
    main()
