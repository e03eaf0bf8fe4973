# SPDX-License-Identifier: GPL-3.0-or-later
"""How often the truth lies inside the stated 95 % ellipsoid, by the error of the robot's positions.

    python benchmarks/ellipsoids.py [--rigs 120] [--seed 4242]

Outlines are projected exactly, with noise of 0.2 px and a shared bias of 0.05 px; the robot's
positions are off by a Gaussian error in each axis that the fit is not told of.
"""

from __future__ import annotations

import argparse

import numpy as np
from efficiency import LENS, POINTS, RADIUS
from monocell.core.ball.sphere import OutlineRays, outline_pixels, tangency
from monocell.core.calibration.ellipsoid import pose_error
from monocell.core.calibration.joint_pose import fit_pose
from monocell.core.calibration.observation import OutlineObservation, Place
from monocell.core.camera import Camera
from monocell.core.errors import MonocellError
from monocell.core.pose import Pose
from monocell.headless.told import table

NOISE_PIXELS, BIAS_PIXELS = 0.2, 0.05
COUNTS, ROBOT_ERRORS = (3, 4, 6, 10), (0.0, 1e-4, 3e-4, 1e-3)


def main() -> None:
    """Print one row a number of balls."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rigs", type=int, default=120)
    parser.add_argument("--seed", type=int, default=4242)
    args = parser.parse_args()
    rows = []
    for count in COUNTS:
        cells = []
        for robot in ROBOT_ERRORS:
            rng = np.random.default_rng([args.seed, count, round(1e6 * robot)])
            inside = [_inside(rng, count, robot) for _ in range(args.rigs)]
            known = [one for one in inside if one is not None]
            cells.append(f"{100 * np.mean(known):.0f} % of {len(known)}")
        rows.append((str(count), *cells))
    print(table(("balls", *(f"{1e3 * robot:g} mm" for robot in ROBOT_ERRORS)), rows))


def _inside(rng: np.random.Generator, count: int, robot: float) -> bool | None:
    """Whether the camera's place lies in its ellipsoid; None where the positions hold no pose."""
    eye = np.array([2.0, 0.0, 1.2]) + rng.uniform(-0.4, 0.4, 3)
    pose = Pose.looking_at(eye, [0.3, 0.0, 0.3], [0, 0, 1])
    places = rng.uniform([0.0, -0.45, 0.05], [0.7, 0.45, 0.7], (count, 3))
    bias = rng.normal(0, BIAS_PIXELS)
    observations = [_observation(rng, pose, place, bias, robot) for place in places]
    try:
        fit = fit_pose(observations, pose)
    except MonocellError:
        return None
    camera = Camera(LENS, fit.camera_from_base, fit.covariance)
    error = pose_error(camera, fit)
    if error is None:
        return None
    off = error.position.directions @ (camera.centre_world - pose.inverse().translation)
    return bool(np.linalg.norm(off / error.position.semi_axes) < 1)


def _observation(
    rng: np.random.Generator, pose: Pose, place: np.ndarray, bias: float, robot: float
) -> OutlineObservation:
    centre = pose.apply(place)
    exact = outline_pixels(LENS, centre, RADIUS, POINTS)
    normals = tangency(OutlineRays.of(LENS, exact), centre, RADIUS).normals
    off = bias + rng.normal(0, NOISE_PIXELS, POINTS)
    rays = OutlineRays.of(LENS, exact + normals * off[:, None])
    told = Place(place + rng.normal(0, robot, 3) if robot else place)
    return OutlineObservation(rays, np.full(POINTS, NOISE_PIXELS), told, RADIUS, LENS)


if __name__ == "__main__":
    main()
