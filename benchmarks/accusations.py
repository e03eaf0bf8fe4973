# SPDX-License-Identifier: GPL-3.0-or-later
"""What calibration says to be wrong, against what is: how often it accuses, and rightly.

    python benchmarks/accusations.py [--rigs 1000] [--wrong 100]

Random rigs of outlines with noise of 0.2 px and an edge bias of the size that the fit allows for.
In good rigs any accusation is a false one. In the others one thing is stated wrongly: it is found
when it is named, alone or among what it can't be told apart from. The last column counts poses more
than 5 of their own sigmas off (over all six numbers) under the verdict good.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from monocell.core.ball.outline import SphereOutline
from monocell.core.ball.sphere import OutlineRays, outline_pixels, sphere_from_rays, tangency
from monocell.core.calibration.calibrate import Calibration, calibrate_outlines
from monocell.core.calibration.joint_pose import BIAS_SIGMA_PIXELS
from monocell.core.camera import Camera
from monocell.core.distortion import Distortion
from monocell.core.errors import MonocellError
from monocell.core.intrinsics import Intrinsics
from monocell.core.pose import Pose
from monocell.core.sighting import SphereSighting
from monocell.headless.told import table

RADIUS, POINTS, NOISE, CONFIDENT_SIGMAS = 0.04, 90, 0.2, 5.0
COUNTS = (4, 5, 6, 8, 12)
LENS = Intrinsics(
    1280, 960, 1200.0, 1197.0, 652.0, 471.0, Distortion("plumb_bob", [-0.12, 0.04, 5e-4, -3e-4, 0])
)
WORDS = {"radius": "radius seems", "focal": "focal length", "lens": "distortion right"}


@dataclass(frozen=True)
class Case:
    """The true lens and ball, what is wrong with them, and the robot's own error in metres."""

    name: str
    guilty: str = ""
    lens: Intrinsics = LENS
    radius: float = RADIUS
    robot: float = 0.0


def _bent(by: float) -> Intrinsics:
    return replace(LENS, distortion=Distortion("plumb_bob", [-0.12 + by, 0.04, 5e-4, -3e-4, 0]))


CASES = (
    Case("good"),
    Case("places off by 0.3 mm", robot=3e-4),
    Case("focal length 1 % off", "focal", replace(LENS, fx=1212.0, fy=1208.97)),
    Case("radius 2 % off", "radius", radius=1.02 * RADIUS),
    Case("k1 off by 0.05", "lens", _bent(0.05)),
)


def main() -> None:
    """One row for each case and number of positions."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rigs", type=int, default=1000, help="good rigs for each number")
    parser.add_argument("--wrong", type=int, default=100, help="rigs of each other case")
    args = parser.parse_args()
    rows = [
        _row(case, count, args.wrong if case.name != "good" else args.rigs)
        for case in CASES
        for count in COUNTS
    ]
    header = ("stated", "positions", "rigs", "accused %", "found %", "good %", "good, > 5 sigma %")
    print(table(header, rows))


def _row(case: Case, count: int, rigs: int) -> tuple[str, ...]:
    accused, found, good, confident = 0, 0, 0, 0
    for seed in range(rigs):
        pose, calibration = _calibrated(case, count, seed)
        if calibration is None:
            continue
        names = [n for n, word in WORDS.items() if any(word in w for w in calibration.warnings)]
        accused += bool(names)
        found += case.guilty in names
        good += calibration.verdict == "good"
        confident += calibration.verdict == "good" and _sigmas(calibration, pose) > CONFIDENT_SIGMAS
    share: Callable[[int], str] = lambda number: f"{100 * number / rigs:.1f}"  # noqa: E731
    told = share(found) if case.guilty else "-"
    return case.name, str(count), str(rigs), share(accused), told, share(good), share(confident)


def _calibrated(case: Case, count: int, seed: int) -> tuple[Pose, Calibration | None]:
    rng = np.random.default_rng(1000 * count + seed)
    eye = np.array([2.0, 0.0, 1.3]) + rng.uniform(-0.4, 0.4, 3)
    pose = Pose.looking_at(eye, [0.25, 0.0, 0.35], [0, 0, 1])
    bias, sightings, outlines = rng.normal(0, BIAS_SIGMA_PIXELS), [], []
    while len(sightings) < count:
        place = rng.uniform([-0.3, -0.5, 0.05], [0.7, 0.5, 0.8])
        u, v = case.lens.project(pose.apply(place)[None])[0]
        if not (60 < u < 1220 and 60 < v < 900):
            continue
        outlines.append(_outline(rng, pose.apply(place), case, bias))
        stated = place + rng.normal(0, case.robot, 3)
        sightings.append(SphereSighting(f"{len(sightings)}", stated, RADIUS))
    try:
        return pose, calibrate_outlines(Camera(LENS), sightings, outlines)
    except MonocellError:
        return pose, None


def _outline(
    rng: np.random.Generator, centre: np.ndarray, case: Case, bias: float
) -> SphereOutline:
    exact = outline_pixels(case.lens, centre, case.radius, POINTS)
    normals = tangency(OutlineRays.of(case.lens, exact), centre, case.radius).normals
    pixels = exact + normals * (bias + rng.normal(0, NOISE, POINTS))[:, None]
    rays = OutlineRays.of(LENS, pixels)
    found = sphere_from_rays(rays.rays, RADIUS)
    left = tangency(rays, found, RADIUS).residual_pixels
    sigma, used = np.full(POINTS, NOISE), np.ones(POINTS, dtype=bool)
    return SphereOutline(
        found, 1e-6 * np.eye(3), RADIUS, pixels, sigma, left, used, 1.0, 10.0, 0.0, NOISE, 0.7
    )


def _sigmas(calibration: Calibration, truth: Pose) -> float:
    motion = calibration.camera.pose @ truth.inverse()
    twist = np.concatenate([motion.rotation_vector(), motion.translation])
    return float(np.sqrt(twist @ np.linalg.solve(calibration.fit.covariance, twist)))


if __name__ == "__main__":
    main()
