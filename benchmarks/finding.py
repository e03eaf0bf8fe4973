# SPDX-License-Identifier: GPL-3.0-or-later
"""Times of finding a ball and of the joint pose, and the cost of importing core.

python benchmarks/finding.py
"""

from __future__ import annotations

import resource
import subprocess
import sys
import time
from collections.abc import Callable

import numpy as np
from monocell.core.ball.find import find_sphere
from monocell.core.calibration.calibrate import calibrate_outlines
from monocell.core.camera import Camera
from monocell.core.picture.synthetic import Photographer
from monocell.headless.told import table
from rigs import RADIUS, random_rig


def main() -> None:
    """Time each, print the medians of several runs."""
    truth, pictures = random_rig(3, 8, Photographer(texture=0.15))
    intrinsics = truth.camera.intrinsics
    sighting = truth.sightings[0]
    picture = pictures[sighting.picture]
    u, v = truth.camera.project(sighting.center_world[None])[0]
    window = (u - 60, v - 60, 120.0, 120.0)
    outlines = [find_sphere(pictures[s.picture], intrinsics, RADIUS) for s in truth.sightings]
    rows = [
        (
            "a ball in a window of 120 px",
            _median(lambda: find_sphere(picture, intrinsics, RADIUS, window)),
        ),
        (
            "a ball in a picture of 1280x960",
            _median(lambda: find_sphere(picture, intrinsics, RADIUS)),
        ),
        (
            "the joint pose of 8 sightings",
            _median(lambda: calibrate_outlines(Camera(intrinsics), truth.sightings, outlines)),
        ),
        ("importing monocell.core", _import_time()),
    ]
    print(table(("what", "median ms"), [(name, f"{1e3 * s:.1f}") for name, s in rows]))
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"peak memory {peak:.0f} MB")


def _median(job: Callable[[], object], runs: int = 15) -> float:
    times = []
    for _ in range(runs + 2):
        began = time.perf_counter()
        job()
        times.append(time.perf_counter() - began)
    return float(np.median(times[2:]))


def _import_time() -> float:
    def job() -> object:
        return subprocess.run([sys.executable, "-c", "import monocell.core"], check=True)

    bare = _median(lambda: subprocess.run([sys.executable, "-c", ""], check=True), 5)
    return _median(job, 5) - bare


if __name__ == "__main__":
    main()
