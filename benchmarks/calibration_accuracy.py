# SPDX-License-Identifier: GPL-3.0-or-later
"""Calibration error and honesty on random rigs with ray-traced pictures.

    python benchmarks/calibration_accuracy.py [--rigs 20] [--sightings 8]

For each kind of picture: the median and largest error of the camera's place and turn of the joint
fit, how often the truth lies in its stated 95 % ellipsoid, and the median error in place of the
baselines on the same outlines.
"""

from __future__ import annotations

import argparse

import numpy as np
from monocell.core.ball.find import find_sphere
from monocell.core.calibration.calibrate import calibrate_outlines
from monocell.core.camera import Camera
from monocell.core.comparison import pose_error
from monocell.core.errors import MonocellError
from monocell.core.picture.synthetic import Photographer
from monocell.headless.told import table
from rigs import RADIUS, random_rig

# chi-squared of six degrees of freedom, 95 %
ELLIPSOID = 12.59
BASELINES = ("pnp", "p3p", "frames")
KINDS = {
    "clean": (Photographer(), False),
    "gripper over the ball": (Photographer(), True),
    "texture behind": (Photographer(texture=0.3), False),
    "noise 4, blur 0.8, JPEG 80, gripper": (
        Photographer(noise_grey_levels=4, jpeg_quality=80, blur_pixels=0.8),
        True,
    ),
}


def main() -> None:
    """Run all kinds and print one table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rigs", type=int, default=20)
    parser.add_argument("--sightings", type=int, default=8)
    args = parser.parse_args()
    rows = [_row(name, *kind, args.rigs, args.sightings) for name, kind in KINDS.items()]
    header = ("pictures", "rigs", "place mm", "largest", "turn deg", "largest", "in 95 %",
              *(f"{method} mm" for method in BASELINES))  # fmt: skip
    print(table(header, rows))


def _row(name: str, how: Photographer, fingers: bool, rigs: int, sightings: int) -> tuple[str, ...]:
    joint, within = [], []
    baselines: dict[str, list[float]] = {method: [] for method in BASELINES}
    for seed in range(rigs):
        truth, pictures = random_rig(seed, sightings, how, fingers=fingers)
        camera = Camera(truth.camera.intrinsics)
        outlines = [_found(pictures[s.picture], camera) for s in truth.sightings]
        try:
            solved = calibrate_outlines(camera, truth.sightings, outlines)
        except MonocellError as error:
            print(f"{name}, rig {seed}: {error}")
            continue
        error = pose_error(truth.camera, solved.camera)
        joint.append((np.linalg.norm(error.centre), np.linalg.norm(error.rotation)))
        within.append(error.mahalanobis is not None and error.mahalanobis**2 < ELLIPSOID)
        for method, errors in baselines.items():
            rough = calibrate_outlines(camera, truth.sightings, outlines, method).camera
            errors.append(float(np.linalg.norm(pose_error(truth.camera, rough).centre)))
    place, turn = np.array(joint).T
    return (
        name,
        str(len(joint)),
        f"{1e3 * np.median(place):.2f}",
        f"{1e3 * place.max():.2f}",
        f"{np.degrees(np.median(turn)):.4f}",
        f"{np.degrees(turn.max()):.4f}",
        f"{100 * np.mean(within):.0f} %",
        *(f"{1e3 * np.median(errors):.2f}" for errors in baselines.values()),
    )


def _found(picture, camera: Camera):
    try:
        return find_sphere(picture, camera.intrinsics, RADIUS)
    except MonocellError:
        return None


if __name__ == "__main__":
    main()
