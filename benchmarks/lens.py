# SPDX-License-Identifier: GPL-3.0-or-later
"""Lens calibration against known lenses: errors, stated sigmas, models chosen; then real pictures.

    python benchmarks/lens.py [FOLDER] [--sets 12] [--pictures 12]

Boards are rendered through each lens, found and calibrated from, `--sets` times. z is error over
stated sigma, its root mean square over fx, fy, cx, cy and all sets: 1 is honest. FOLDER holds
eye_in_hand/franka_image-*.png of ViSP's Franka set (a 9x6 chessboard, squares of 23.6 mm) with the
camera file franka_camera.xml beside them.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path

import numpy as np
from monocell.core import Distortion, Intrinsics
from monocell.core.document.camera_file import read_camera
from monocell.core.lens.board import Board, CharucoBoard, Chessboard
from monocell.core.lens.calibrate_lens import LensCalibration, calibrate_lens
from monocell.core.lens.parameters import parameters_of
from monocell.core.lens.synthetic_board import (
    BoardPhotographer,
    photograph_boards,
    scattered_poses,
)
from monocell.core.picture.pictures import read_picture
from monocell.headless.lens_report import tell
from monocell.headless.told import progress, table, warn

BROWN, FISHEYE = [-0.28, 0.09, 6e-4, -4e-4, -0.01], [-0.02, 0.004, -0.001, 2e-4]
RATIONAL = [0.35, -0.12, 5e-4, -3e-4, 0.02, 0.6, -0.05, 0.03]
LENSES = {
    "none": Intrinsics(640, 480, 600, 602, 322, 238),
    "plumb_bob": Intrinsics(640, 480, 520, 521, 325, 236, Distortion("plumb_bob", BROWN)),
    "rational_polynomial": Intrinsics(
        640, 480, 420, 421, 325, 236, Distortion("rational_polynomial", RATIONAL)
    ),
    "equidistant": Intrinsics(640, 480, 300, 301, 318, 244, Distortion("equidistant", FISHEYE)),
}
BOARDS: dict[str, Board] = {
    "chessboard": Chessboard(9, 6, 0.025),
    "charuco": CharucoBoard(8, 6, 0.03, 0.021, "DICT_5X5_100"),
}


def main() -> None:
    """Synthetic lenses, then the real one."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, nargs="?")
    parser.add_argument("--sets", type=int, default=12)
    parser.add_argument("--pictures", type=int, default=12)
    args = parser.parse_args()
    rows = []
    for lens in LENSES:
        for board in BOARDS:
            rows.append(_row(lens, board, args.sets, args.pictures))
            progress("  ".join(rows[-1]))
    header = ("lens, board", "rms px", "error fx", "cx", "sigma fx", "cx", "z", "model", "s a set")
    print(table(header, rows))
    if args.folder is not None:
        _real(args.folder / "eye_in_hand")


def _row(lens_name: str, board_name: str, sets: int, count: int) -> tuple[str, ...]:
    truth, board = LENSES[lens_name], BOARDS[board_name]
    began = time.perf_counter()
    found = [_calibrated(truth, board, count, seed) for seed in range(sets)]
    taken = (time.perf_counter() - began) / sets
    errors = np.array([parameters_of(c.lens)[:4] - parameters_of(truth)[:4] for c in found])
    sigmas = np.array([list((c.quality.sigmas() or {}).values())[:4] for c in found])
    error, sigma = np.sqrt((errors**2).mean(0)), np.sqrt((sigmas**2).mean(0))
    right = sum(c.lens.distortion.model == lens_name for c in found)
    return (
        f"{lens_name}, {board_name}",
        f"{np.median([c.fit.rms_pixels for c in found]):.3f}",
        *(f"{v:.2f}" for v in (error[0], error[2], sigma[0], sigma[2])),
        f"{np.sqrt(((errors / sigmas) ** 2).mean()):.2f}",
        f"{right} of {sets}",
        f"{taken:.1f}",
    )


def _calibrated(truth: Intrinsics, board: Board, count: int, seed: int) -> LensCalibration:
    rng = np.random.default_rng(seed)
    how = BoardPhotographer(rng.uniform(0.4, 1.2), rng.uniform(1, 4), seed)
    poses = scattered_poses(truth, board, count, rng)
    pictures = dict(enumerate(photograph_boards(truth, board, poses, how)))
    return calibrate_lens([str(i) for i in pictures], lambda name: pictures[int(name)], board)


def _real(folder: Path) -> None:
    given = read_camera(folder / "franka_camera.xml").intrinsics
    names = [str(path) for path in sorted(folder.glob("*.png"))]
    calibration = calibrate_lens(names, read_picture, Chessboard(9, 6, 0.0236))
    print(f"\n{folder}: the maker gives fx {given.fx:.1f}, cx {given.cx:.1f}, cy {given.cy:.1f}")
    tell(calibration)
    warn(calibration.warnings)


if __name__ == "__main__":
    main()
