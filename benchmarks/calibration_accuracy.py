# SPDX-License-Identifier: GPL-3.0-or-later
"""Calibration error and honesty on random rigs with ray-traced pictures.

    python benchmarks/calibration_accuracy.py [--rigs 20] [--sightings 8]

For each kind of picture: the median and largest error of the camera's place and turn, for the joint
fit and the paper's three-point frames, and how often the truth lies in the stated 95 % ellipsoid.
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
              "frames mm", "frames deg")  # fmt: skip
    print(table(header, rows))


def _row(name: str, how: Photographer, fingers: bool, rigs: int, sightings: int) -> tuple[str, ...]:
    joint, frames, within = [], [], []
    for seed in range(rigs):
        truth, pictures = random_rig(seed, sightings, how, fingers=fingers)
        intrinsics = truth.camera.intrinsics
        outlines = []
        for sighting in truth.sightings:
            try:
                outlines.append(find_sphere(pictures[sighting.picture], intrinsics, RADIUS))
            except MonocellError:
                outlines.append(None)
        try:
            solved = calibrate_outlines(Camera(intrinsics), truth.sightings, outlines)
            paper = calibrate_outlines(Camera(intrinsics), truth.sightings, outlines, "frames")
        except MonocellError as error:
            print(f"{name}, rig {seed}: {error}")
            continue
        error = pose_error(truth.camera, solved.camera)
        joint.append((np.linalg.norm(error.centre), np.linalg.norm(error.rotation)))
        within.append(error.mahalanobis is not None and error.mahalanobis**2 < ELLIPSOID)
        rough = pose_error(truth.camera, paper.camera)
        frames.append((np.linalg.norm(rough.centre), np.linalg.norm(rough.rotation)))
    j, f = np.array(joint), np.array(frames)
    return (
        name,
        str(len(j)),
        f"{1e3 * np.median(j[:, 0]):.2f}",
        f"{1e3 * j[:, 0].max():.2f}",
        f"{np.degrees(np.median(j[:, 1])):.4f}",
        f"{np.degrees(j[:, 1].max()):.4f}",
        f"{100 * np.mean(within):.0f} %",
        f"{1e3 * np.median(f[:, 0]):.1f}",
        f"{np.degrees(np.median(f[:, 1])):.3f}",
    )


if __name__ == "__main__":
    main()
