# SPDX-License-Identifier: GPL-3.0-or-later
"""A cell of 1,000 objects is read, written and exported to glTF: seconds and peak memory come out.

Run it as `python benchmarks/gltf_thousand.py`. The time starts before Blender is imported and the
memory is that of the whole process, so the figures are what a user waits and pays for.
"""

from __future__ import annotations

import argparse
import resource
import tempfile
import time
from pathlib import Path

import numpy as np
from monocell.core import Appearance, Box, Camera, Cell, Cylinder, Intrinsics, Pose
from monocell.core.document.cell_file import read_cell, write_cell

COLORS = ((0.7, 0.05, 0.04), (0.03, 0.16, 0.55), (0.9, 0.55, 0.03), (0.03, 0.36, 0.16))


def cell_of(count: int) -> Cell:
    """Boxes and cylinders by turns on a grid, every one of a size of its own."""
    rng = np.random.default_rng(7)
    columns = int(np.ceil(np.sqrt(count)))
    objects = []
    for i in range(count):
        x, y = i % columns * 0.3, i // columns * 0.3
        pose = Pose.from_rotation_vector([0, 0, rng.uniform(0, 3)], [x, y, 0.1])
        look, size = Appearance(COLORS[i % len(COLORS)]), rng.uniform(0.05, 0.2, 3)
        if i % 2:
            objects.append(Box(f"box {i}", pose, size=size, appearance=look))
        else:
            radius, height = size[0] / 2, size[1]
            objects.append(
                Cylinder(f"cylinder {i}", pose, radius=radius, height=height, appearance=look)
            )
    eye = Pose.looking_at([-2, -2, 3], [columns * 0.15, columns * 0.15, 0], [0, 0, 1])
    return Cell(
        Camera(Intrinsics(1280, 960, 1200, 1200, 639.5, 479.5), eye), objects=tuple(objects)
    )


def main() -> None:
    """Print a line a step, then the sum and the peak memory."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--objects", type=int, default=1000)
    count = parser.parse_args().objects
    with tempfile.TemporaryDirectory() as folder:
        document, binary = Path(folder) / "many.cell.json", Path(folder) / "many.glb"
        write_cell(cell_of(count), document)
        ticks = [time.perf_counter()]
        cell = read_cell(document)
        ticks.append(time.perf_counter())
        write_cell(cell, document)
        ticks.append(time.perf_counter())
        from monocell.scene.gltf import export_gltf

        ticks.append(time.perf_counter())
        export_gltf(cell, binary)
        ticks.append(time.perf_counter())
        size = binary.stat().st_size
    steps = ("read", "write", "start Blender", "export glTF")
    for step, seconds in zip(steps, np.diff(ticks), strict=True):
        print(f"{step:<14}{seconds:7.2f} s")
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"{'all':<14}{ticks[-1] - ticks[0]:7.2f} s   {count} objects, {size / 1e6:.1f} MB glTF")
    print(f"{'peak memory':<14}{peak:7.0f} MB")


if __name__ == "__main__":
    main()
