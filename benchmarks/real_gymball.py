# SPDX-License-Identifier: GPL-3.0-or-later
"""A real ball seen by two cameras at eight places: how well do their centres agree?

    python benchmarks/real_gymball.py FOLDER [--out OUT]

FOLDER holds cameras.json and view_a/1.png ... view_b/8.png (Toth and others' SphereCalib pictures).
The ball is looked for in whole pictures without a window. What one rigid motion between the views
leaves is printed in millimetres; the ball's radius scales it and is only known as "about 0.3 m".
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path

import numpy as np
from monocell.core.ball.find import find_sphere
from monocell.core.ball.sphere import outline_pixels
from monocell.core.calibration.frames import pose_from_points
from monocell.core.camera import Camera
from monocell.core.intrinsics import Intrinsics
from monocell.core.picture.overlay import BallOutline, draw_overlay
from monocell.core.picture.pictures import read_picture
from monocell.core.pose import Pose
from monocell.headless.pictures import write_picture
from monocell.headless.told import table

RADIUS = 0.3


def main() -> None:
    """Find, align, print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--out", type=Path, help="write overlays here")
    args = parser.parse_args()
    cameras = json.loads((args.folder / "cameras.json").read_text())
    views = {name: _view(args, cameras, name) for name in ("view_a", "view_b")}
    a, b = views["view_a"], views["view_b"]
    left = pose_from_points(a, b).apply(a) - b
    rows = [
        (str(i + 1), f"{a[i][2]:.3f}", f"{b[i][2]:.3f}", *(f"{1e3 * v:+.1f}" for v in left[i]))
        for i in range(len(a))
    ]
    print(table(("place", "depth a m", "depth b m", "x mm", "y mm", "z mm"), rows))
    length = np.linalg.norm(left, axis=1)
    print(
        f"left after one rigid motion: {1e3 * np.sqrt((length**2).mean()):.1f} mm rms, "
        f"{1e3 * np.median(length):.1f} mm median, {1e3 * length.max():.1f} mm largest"
    )


def _view(args: argparse.Namespace, cameras: dict, name: str) -> np.ndarray:
    intrinsics = Intrinsics(cameras["width"], cameras["height"], **cameras[name])
    centres = []
    for i in range(1, 9):
        picture = read_picture(args.folder / name / f"{i}.png", intrinsics)
        began = time.perf_counter()
        outline = find_sphere(picture, intrinsics, RADIUS)
        taken = time.perf_counter() - began
        centres.append(outline.centre_camera)
        print(
            f"{name}/{i}.png: {100 * outline.coverage:.0f} % of the outline seen, "
            f"{outline.rms_pixels:.2f} px rms, {1e3 * taken:.0f} ms"
        )
        if args.out is not None:
            args.out.mkdir(parents=True, exist_ok=True)
            ring = BallOutline(outline_pixels(intrinsics, outline.centre_camera, RADIUS))
            drawn = draw_overlay(picture, Camera(intrinsics, Pose.identity()), (), [ring])
            write_picture(args.out / f"{name}_{i}.png", drawn)
    return np.array(centres)


if __name__ == "__main__":
    main()
