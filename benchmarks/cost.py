# SPDX-License-Identifier: GPL-3.0-or-later
"""What calibration costs: seconds and memory by the number of sightings and the size of pictures.

    python benchmarks/cost.py [--most 1000]

A cell of ray-traced balls is written as JPEG files, one ball and one file a sighting, and
calibrated by `calibrate_cell` in a process of its own, whose peak memory is then asked for. With a
window a ball is looked for in 160 px around it (at 1280 x 960, in proportion at other sizes);
without, in the whole picture. `busy` are seconds of the processor, which other programs do not
disturb much; the two columns after it are milliseconds of those. Growth is linear where they stay.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from monocell.core.ball.sphere import outline_pixels
from monocell.core.camera import Camera
from monocell.core.cell import Cell
from monocell.core.document.cell_file import write_cell
from monocell.core.intrinsics import Intrinsics
from monocell.core.pose import Pose
from monocell.core.sighting import SphereSighting
from monocell.headless.told import progress, table

RADIUS, SUPERSAMPLING, HALF_WINDOW = 0.04, 4, 80
# the child tells on its last line: seconds, of the processor, megabytes before and at the peak,
# verdict, where the camera is. A process starts with the peak of its parent but on Linux's own page
CHILD = """
import json, resource, sys, time
from pathlib import Path
from monocell.core.calibration.calibrate import calibrate_cell
from monocell.core.document.cell_file import read_cell

def megabytes():
    status = Path("/proc/self/status")
    if status.exists():
        line = next(l for l in status.read_text().splitlines() if l.startswith("VmHWM"))
        return int(line.split()[1]) / 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024

cell, before = read_cell(Path(sys.argv[1])), megabytes()
began, busy = time.perf_counter(), time.process_time()
solved, calibration = calibrate_cell(cell)
seconds, busy = time.perf_counter() - began, time.process_time() - busy
print(json.dumps([seconds, busy, before, megabytes(), calibration.verdict,
                  solved.camera.centre_world.tolist()]))
"""


@dataclass(frozen=True)
class Load:
    """How many sightings, in pictures of how many pixels, with windows or not."""

    sightings: int
    width: int
    height: int
    windows: bool

    @property
    def megapixels(self) -> float:
        return self.width * self.height / 1e6


SIZES = ((640, 480), (1280, 960), (2592, 1944), (4000, 3000), (6000, 4000))
COUNTS = (8, 30, 100, 300, 1000)


def loads(most: int) -> list[Load]:
    """Growth by number in pictures of usual size, with windows and without; growth by size."""
    counts = [count for count in COUNTS if count <= most]
    rows = [Load(count, 1280, 960, windows) for windows in (True, False) for count in counts]
    return rows + [Load(8, *size, windows) for windows in (True, False) for size in SIZES]


def main() -> None:
    """Print one row a load."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--most", type=int, default=1000, help="sightings at most")
    args = parser.parse_args()
    rows = []
    for load in loads(args.most):
        with tempfile.TemporaryDirectory(prefix="monocell-bench-") as folder:
            truth = write_load(load, Path(folder))
            row = _measured(load, truth, Path(folder) / "cell.cell.json")
        rows.append(row)
        progress(" ".join(row))
    header = ("sightings", "megapixels", "window", "seconds", "busy", "ms a sighting",
              "ms a megapixel", "peak MB", "at start", "verdict", "mm")  # fmt: skip
    print(table(header, rows))


def _measured(load: Load, truth: Camera, cell: Path) -> tuple[str, ...]:
    child = [sys.executable, "-c", CHILD, str(cell)]
    done = subprocess.run(child, capture_output=True, text=True, check=False)
    start = (str(load.sightings), f"{load.megapixels:.1f}", "yes" if load.windows else "no")
    if done.returncode:
        return (*start, *[""] * 6, done.stderr.strip().splitlines()[-1][:60], "")
    seconds, busy, before, peak, verdict, place = json.loads(done.stdout.splitlines()[-1])
    off = float(np.linalg.norm(np.array(place) - truth.centre_world))
    each = 1e3 * busy / load.sightings
    return (
        *start,
        f"{seconds:.2f}",
        f"{busy:.2f}",
        f"{each:.1f}",
        f"{each / load.megapixels:.1f}",
        f"{peak:.0f}",
        f"{before:.0f}",
        verdict,
        f"{1e3 * off:.2f}",
    )


def write_load(load: Load, folder: Path) -> Camera:
    """Write the cell and its pictures; the true camera is returned and not written."""
    focal = 1200 * load.width / 1280
    middle = (load.width - 1) / 2, (load.height - 1) / 2
    intrinsics = Intrinsics(load.width, load.height, focal, focal, *middle)
    truth = Camera(intrinsics, Pose.looking_at([2.2, 0.1, 1.2], [0.3, 0, 0.3], [0, 0, 1]))
    rng = np.random.default_rng(load.sightings)
    wall = _wall(load, rng)
    sightings = []
    for i in range(load.sightings):
        place = rng.uniform([-0.1, -0.35, 0.1], [0.6, 0.35, 0.6])
        name = f"pose_{i:04d}.jpg"
        picture = wall.copy()
        _paint(picture, truth, place)
        cv2.imwrite(str(folder / name), picture, [cv2.IMWRITE_JPEG_QUALITY, 90])
        sightings.append(SphereSighting(name, place, RADIUS, _window(truth, place, load)))
    cell = Cell(Camera(intrinsics), sightings=tuple(sightings), folder=folder)
    write_cell(cell, folder / "cell.cell.json")
    return truth


def _window(truth: Camera, place: np.ndarray, load: Load) -> tuple[float, ...] | None:
    if not load.windows:
        return None
    half = HALF_WINDOW * load.width / 1280
    u, v = np.rint(truth.project(place[None])[0])
    return (u - half, v - half, 2 * half, 2 * half)


def _wall(load: Load, rng: np.random.Generator) -> np.ndarray:
    """A wall with soft blotches, the same in every picture, as that of a fixed camera is."""
    coarse = rng.normal(120, 18, (load.height // 24 + 2, load.width // 24 + 2, 3))
    size = (load.width, load.height)
    smooth = cv2.resize(coarse.astype(np.float32), size, interpolation=cv2.INTER_CUBIC)
    return np.clip(smooth + rng.normal(0, 1.5, smooth.shape), 0, 255).astype(np.uint8)


def _paint(picture: np.ndarray, truth: Camera, place: np.ndarray) -> None:
    """Mix a shaded ball into the picture, each pixel by the share of it that the ball covers."""
    middle = truth.pose.apply(place)
    outline = outline_pixels(truth.intrinsics, middle, RADIUS)
    low = np.floor(outline.min(axis=0)).astype(int) - 1
    high = np.ceil(outline.max(axis=0)).astype(int) + 2
    v, u = np.mgrid[low[1] : high[1], low[0] : high[0]]
    covered, shade = np.zeros(u.shape), np.zeros(u.shape)
    steps = (np.arange(SUPERSAMPLING) + 0.5) / SUPERSAMPLING - 0.5
    for dv in steps:
        for du in steps:
            rays = truth.intrinsics.rays(np.stack([u.ravel() + du, v.ravel() + dv], axis=1))
            along = rays @ middle
            inside = along**2 - (middle @ middle - RADIUS**2)
            depth = along - np.sqrt(np.maximum(inside, 0))
            normal = (rays * depth[:, None] - middle) / RADIUS
            light = 0.35 + 0.65 * np.maximum(normal @ [-0.5, -0.7, -0.5], 0)
            covered += (inside > 0).reshape(u.shape) / SUPERSAMPLING**2
            shade += np.where(inside > 0, light, 0).reshape(u.shape) / SUPERSAMPLING**2
    part = picture[low[1] : high[1], low[0] : high[0]]
    # mixed as light, encoded by a square root: near enough to sRGB for edges to lie right
    linear = (part / 255.0) ** 2 * (1 - covered[..., None]) + shade[..., None] * [0.05, 0.25, 0.7]
    part[...] = np.rint(255 * np.sqrt(np.clip(linear, 0, 1)))


if __name__ == "__main__":
    main()
