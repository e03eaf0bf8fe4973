# SPDX-License-Identifier: GPL-3.0-or-later
"""A million pixels onto the floor: prints the time and the error for every distortion model."""

from __future__ import annotations

import time

import numpy as np
from monocell.core import Camera, Distortion, Intrinsics, Pose, ReferencePlane
from monocell.core.arrays import Array
from monocell.core.modelling.reverse_mapping import points_on_plane

PIXELS = 1_000_000
REPEATS = 5
LENSES = {
    "none": (),
    "plumb_bob": (-0.28, 0.09, 0.0006, -0.0004, -0.01),
    "rational_polynomial": (0.3, -0.2, 0.0005, -0.0003, 0.02, 0.5, -0.1, 0.01),
    "equidistant": (-0.02, 0.004, -0.001, 0.0002),
}


def main() -> None:
    floor = ReferencePlane("floor", np.zeros(3), np.array([0.0, 0.0, 1.0]))
    pixels = np.random.default_rng(0).uniform([0, 0], [1279, 959], (PIXELS, 2))
    print(f"{PIXELS} pixels of 1280 x 960 onto a plane, the best of {REPEATS} runs")
    print(f"{'model':22}{'seconds':>9}{'largest error, px':>20}")
    for model, coefficients in LENSES.items():
        lens = Distortion(model, np.array(coefficients))
        camera = Camera(
            Intrinsics(1280, 960, 1200.0, 1195.0, 652.3, 471.8, lens),
            Pose.looking_at([2.0, -1.5, 2.5], [0.0, 0.0, 0.0], [0.0, 0.0, 1.0]),
        )
        seconds = min(_seconds(camera, floor, pixels) for _ in range(REPEATS))
        points = points_on_plane(camera, floor, pixels)
        error = float(np.abs(camera.project(points) - pixels).max())
        print(f"{model:22}{seconds:9.3f}{error:20.1e}")


def _seconds(camera: Camera, plane: ReferencePlane, pixels: Array) -> float:
    start = time.perf_counter()
    points_on_plane(camera, plane, pixels)
    return time.perf_counter() - start


if __name__ == "__main__":
    main()
