# SPDX-License-Identifier: GPL-3.0-or-later
"""A real ball seen by two cameras at eight places: how well do their centres agree?

    python benchmarks/real_gymball.py FOLDER [--out OUT]

FOLDER holds cameras.json and view_a/1.png ... view_b/8.png (Toth and others' SphereCalib pictures).
The ball is looked for in whole pictures without a window. What one rigid motion between the views
leaves is printed in millimetres; the ball's radius scales it and is only known as "about 0.3 m".

Each view is then calibrated on its own against the rough centres that a LiDAR saw, with the radius
refined: the two views know nothing of each other, and have to come to the same radius.
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path

import numpy as np
from monocell.core.ball.find import find_sphere
from monocell.core.ball.outline import SphereOutline
from monocell.core.ball.sphere import outline_pixels
from monocell.core.calibration.calibrate import calibrate_outlines
from monocell.core.calibration.frames import pose_from_points
from monocell.core.camera import Camera
from monocell.core.errors import MonocellError
from monocell.core.intrinsics import Intrinsics
from monocell.core.picture.overlay import BallOutline, draw_overlay
from monocell.core.picture.pictures import read_picture
from monocell.core.pose import Pose
from monocell.core.sighting import SphereSighting
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
    a, b = (np.array([o.centre_camera for o in outlines]) for outlines in views.values())
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
    for name, outlines in views.items():
        _tell_radius(cameras, name, outlines)


def _tell_radius(cameras: dict, name: str, outlines: list[SphereOutline]) -> None:
    """The radius that one view finds, from where the LiDAR had the balls."""
    intrinsics = Intrinsics(cameras["width"], cameras["height"], **cameras[name])
    listed = cameras["lidar_centres_m"]
    sightings = [
        SphereSighting(f"{name}/{i}.png", listed[str(i)], RADIUS) for i in range(1, len(listed) + 1)
    ]
    try:
        found = calibrate_outlines(Camera(intrinsics), sightings, outlines, refine=("radius",))
    except MonocellError as error:
        print(f"{name}: {error}")
        return
    radius = found.refined[0]
    print(
        f"{name}: radius {1e3 * RADIUS * radius.factor:.1f} ± {1e3 * RADIUS * radius.sigma:.1f} mm "
        f"from {found.count_used} of {len(sightings)} sightings, places off by "
        f"{1e3 * found.fit.place_sigma:.0f} mm each"
    )


def _view(args: argparse.Namespace, cameras: dict, name: str) -> list[SphereOutline]:
    intrinsics = Intrinsics(cameras["width"], cameras["height"], **cameras[name])
    outlines = []
    for i in range(1, 9):
        picture = read_picture(args.folder / name / f"{i}.png", intrinsics)
        began = time.perf_counter()
        outline = find_sphere(picture, intrinsics, RADIUS)
        taken = time.perf_counter() - began
        outlines.append(outline)
        print(
            f"{name}/{i}.png: {100 * outline.coverage:.0f} % of the outline seen, "
            f"{outline.rms_pixels:.2f} px rms, {1e3 * taken:.0f} ms"
        )
        if args.out is not None:
            args.out.mkdir(parents=True, exist_ok=True)
            ring = BallOutline(outline_pixels(intrinsics, outline.centre_camera, RADIUS))
            drawn = draw_overlay(picture, Camera(intrinsics, Pose.identity()), (), [ring])
            write_picture(args.out / f"{name}_{i}.png", drawn)
    return outlines


if __name__ == "__main__":
    main()
