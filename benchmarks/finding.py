# SPDX-License-Identifier: GPL-3.0-or-later
"""Times of finding a ball and of the joint pose, the paper's vote beside it, the cost of importing.

python benchmarks/finding.py
"""

from __future__ import annotations

import resource
import subprocess
import sys
import time
from collections.abc import Callable

import cv2
import numpy as np
from monocell.core.arrays import Array
from monocell.core.ball.find import find_sphere
from monocell.core.ball.three_parameter_vote import vote_for_sphere
from monocell.core.calibration.calibrate import calibrate_outlines
from monocell.core.camera import Camera
from monocell.core.intrinsics import Intrinsics
from monocell.core.picture.pictures import Picture
from monocell.core.picture.synthetic import Photographer
from monocell.headless.told import table
from rigs import RADIUS, random_rig

# metres around the predicted place that the vote searches
REACH = 0.06


def main() -> None:
    """Time each, print the medians of several runs."""
    truth, pictures = random_rig(3, 8, Photographer(texture=0.15))
    intrinsics = truth.camera.intrinsics
    sighting = truth.sightings[0]
    picture = pictures[sighting.picture]
    u, v = truth.camera.project(sighting.center_world[None])[0]
    window = (u - 60, v - 60, 120.0, 120.0)
    outlines = [find_sphere(pictures[s.picture], intrinsics, RADIUS) for s in truth.sightings]
    near = truth.camera.pose.apply(sighting.center_world) + np.array([0.02, -0.02, 0.03])
    large, lens = _enlarged(picture, intrinsics)
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
            f"a ball in a picture of {lens.width}x{lens.height}",
            _median(lambda: find_sphere(large, lens, RADIUS), 3),
        ),
        (
            "the paper's vote, 60 mm around",
            _median(lambda: vote_for_sphere(picture, intrinsics, RADIUS, near, REACH)),
        ),
        (
            "the joint pose of 8 sightings",
            _median(lambda: calibrate_outlines(Camera(intrinsics), truth.sightings, outlines)),
        ),
        ("importing monocell.core", _import_time()),
    ]
    print(table(("what", "median ms"), [(name, f"{1e3 * s:.1f}") for name, s in rows]))
    centres = [truth.camera.pose.apply(s.center_world) for s in truth.sightings]
    shots = [pictures[s.picture] for s in truth.sightings]
    print(_accuracy(intrinsics, shots, centres, [o.centre_camera for o in outlines]))
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"peak memory {peak:.0f} MB")


def _enlarged(picture: Picture, intrinsics: Intrinsics) -> tuple[Picture, Intrinsics]:
    """The picture at 24 megapixels, and its camera."""
    factor = 24e6**0.5 / (intrinsics.width * intrinsics.height) ** 0.5
    size = round(factor * intrinsics.width), round(factor * intrinsics.height)
    large = cv2.resize(picture, size, interpolation=cv2.INTER_CUBIC)
    scale = size[0] / intrinsics.width
    # the corner of the picture, not the middle of its first pixel, stays where it is
    centre = scale * (np.array([intrinsics.cx, intrinsics.cy]) + 0.5) - 0.5
    focal = scale * intrinsics.fx, scale * intrinsics.fy
    return large, Intrinsics(*size, *focal, *centre, intrinsics.distortion)


def _accuracy(
    intrinsics: Intrinsics, shots: list[Picture], centres: list[Array], measured: list[Array]
) -> str:
    """Median errors of the vote and of the outline over the sightings."""
    rng = np.random.default_rng(1)
    voted = [
        vote_for_sphere(shot, intrinsics, RADIUS, centre + rng.uniform(-0.03, 0.03, 3), REACH)
        for shot, centre in zip(shots, centres, strict=True)
    ]
    rows = []
    for name, found in (("the paper's vote", voted), ("the measured outline", measured)):
        both = zip(found, centres, strict=True)
        errors = [
            (intrinsics.project(np.stack(pair)), np.linalg.norm(pair, axis=1)) for pair in both
        ]
        aside = float(np.median([np.linalg.norm(np.subtract(*pixels)) for pixels, _ in errors]))
        deep = float(np.median([abs(far[0] / far[1] - 1) for _, far in errors]))
        rows.append((name, f"{aside:.3f}", f"{100 * deep:.2f}"))
    return table(("8 sightings, median error", "aside px", "depth %"), rows)


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
