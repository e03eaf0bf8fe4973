# SPDX-License-Identifier: GPL-3.0-or-later
"""Lenses, and what pictures of a board would show through them: corners with noise, no pixels."""

from __future__ import annotations

import numpy as np
from monocell.core import Distortion, Intrinsics
from monocell.core.lens.board import Chessboard
from monocell.core.lens.synthetic_board import scattered_poses
from monocell.core.lens.view import BoardView

BOARD = Chessboard(9, 6, 0.025)
SIZE = (640, 480)
LENSES = {
    "none": Intrinsics(640, 480, 600, 602, 322, 238),
    "plumb_bob": Intrinsics(
        640, 480, 520, 521, 325, 236, Distortion("plumb_bob", [-0.28, 0.09, 6e-4, -4e-4, -0.01])
    ),
    "equidistant": Intrinsics(
        640, 480, 300, 301, 318, 244, Distortion("equidistant", [-0.02, 0.004, -0.001, 2e-4])
    ),
    "rational_polynomial": Intrinsics(
        *(640, 480, 420, 421, 325, 236),
        Distortion("rational_polynomial", [0.35, -0.12, 5e-4, -3e-4, 0.02, 0.6, -0.05, 0.03]),
    ),
}
NOISE = 0.05


def views_through(lens, count, seed, noise=NOISE, **how):
    """`count` views of the board at random poses."""
    rng = np.random.default_rng(seed)
    poses = scattered_poses(lens, BOARD, count, rng, **how)
    numbers = np.arange(len(BOARD.corners))
    return [
        BoardView(
            f"{i}.png",
            BOARD,
            numbers,
            lens.project(pose.apply(BOARD.corners)) + rng.normal(0, noise, (len(numbers), 2)),
            0.8,
        )
        for i, pose in enumerate(poses)
    ]
