# SPDX-License-Identifier: GPL-3.0-or-later
"""What modelling costs: milliseconds of the processor by the number of objects.

    python benchmarks/model_cost.py [--most 1000]

Boxes and cylinders stand in rows on a table, all their visible corners and ten points a rim picked
with 1 px error, by a camera with a covariance. `reverse` maps every pick to the table, with its
covariance. `solve` is `model_cell` from the picks alone; `again` is the fit from where the objects
are already, as when a pick is dragged, and `joint` the same of all objects and the camera's error
together. `wires` computes the lines of the overlay, `drawn` also draws them, with names and sizes,
into 1280 x 960 px. Each is the best of some runs in one process, of processor time, which other
programs do not disturb much. Growth is linear where milliseconds an object stay.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable

import numpy as np
from honest_hand import box_picks, can_picks, hand_of
from monocell.core.camera import Camera
from monocell.core.cell import Cell
from monocell.core.distortion import Distortion
from monocell.core.intrinsics import Intrinsics
from monocell.core.modelling.mapped_covariance import point_covariance_on_plane
from monocell.core.modelling.model_fit import fit_model
from monocell.core.modelling.pick_equations import pick_observer
from monocell.core.modelling.reverse_mapping import points_on_plane_or_nan
from monocell.core.modelling.solve import model_cell
from monocell.core.modelling.starts.start import start
from monocell.core.picture.overlay import draw_overlay
from monocell.core.picture.wireframe import wireframes
from monocell.core.pose import Pose
from monocell.core.primitives import Box, Cylinder, Primitive
from monocell.core.reference import ReferencePlane
from monocell.core.rotation import rotation_from_vector
from monocell.core.sketch import Sketch
from monocell.headless.told import table

TABLE = ReferencePlane("table", np.zeros(3), np.array([0.0, 0.0, 1.0]))
COUNTS = (1, 10, 100, 1000)
SIDE = 1.4
RUNS, LONGEST = 5, 4.0
# of the camera's pose: radians and metres, as a good calibration states
TURN_SIGMA, MOVE_SIGMA = 2e-4, 5e-4
COLUMNS = ("reverse", "solve", "again", "wires", "drawn", "joint")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--most", type=int, default=1000)
    arguments = parser.parse_args()
    counts = [count for count in COUNTS if count <= arguments.most]
    spent = [_spent(count) for count in counts]
    rows = [
        (str(count), *(f"{1e3 * s:.1f}" for s in seconds))
        for count, seconds in zip(counts, spent, strict=True)
    ]
    print("milliseconds")
    print(table(("objects", *COLUMNS), rows))
    print("\nmilliseconds an object")
    each = [
        (str(count), *(f"{1e3 * s / count:.3f}" for s in seconds))
        for count, seconds in zip(counts, spent, strict=True)
    ]
    print(table(("objects", *COLUMNS), each))


def _spent(count: int) -> list[float]:
    cell = picked_cell(count)
    solved, _ = model_cell(cell)
    planes = {TABLE.name: TABLE}
    pixels = np.array([p for s in cell.sketches for role in s.picks.values() for p in role if p])
    picture = np.zeros((960, 1280, 3), np.uint8)

    def reverse() -> object:
        seen = ~np.isnan(points_on_plane_or_nan(cell.camera, TABLE, pixels)[:, 0])
        return point_covariance_on_plane(cell.camera, TABLE, pixels[seen])

    observe = pick_observer({s.name: start(cell.camera, s, planes, {}).plan for s in cell.sketches})

    def fit(joint: bool) -> object:
        names = [thing.name for thing in solved.objects]
        return fit_model(cell.camera, planes, solved.objects, observe, names, joint=joint)

    jobs: list[Callable[[], object]] = [
        reverse,
        lambda: model_cell(cell),
        lambda: fit(False),
        lambda: wireframes(solved.objects, cell.camera),
        lambda: draw_overlay(picture, cell.camera, solved.objects),
        lambda: fit(True),
    ]
    return [_best(job) for job in jobs]


def picked_cell(count: int) -> Cell:
    """So many things picked, and none solved."""
    camera = _camera()
    hand = hand_of(camera, np.random.default_rng(count), 1.0)
    sketches = []
    for thing in _in_rows(count):
        pick = box_picks if isinstance(thing, Box) else can_picks
        picks = pick(thing, camera.centre_world, (), hand)
        sketches.append(Sketch(thing.name, thing.kind, "table", picks))
    return Cell(camera, references=(TABLE,), sketches=tuple(sketches))


def _camera() -> Camera:
    lens = Distortion("plumb_bob", np.array([-0.12, 0.04, 3e-4, -4e-4, 0.0]))
    intrinsics = Intrinsics(1280, 960, 1200.0, 1198.0, 641.0, 478.0, lens)
    pose = Pose.looking_at([1.9, -1.2, 1.5], [0.0, 0.0, 0.0], [0.0, 0.0, 1.0])
    sigma = np.repeat([TURN_SIGMA, MOVE_SIGMA], 3)
    return Camera(intrinsics, pose, np.diag(sigma**2))


def _in_rows(count: int) -> list[Primitive]:
    """Boxes and cylinders in turn, in a square of rows, all of them apart."""
    rng = np.random.default_rng(7)
    across = int(np.ceil(np.sqrt(count)))
    # alone or among a thousand a thing is as large, so that its pixels are as many
    step, size = SIDE / max(across, 6), SIDE / 40
    things: list[Primitive] = []
    for i in range(count):
        x, y = (np.array([i % across, i // across]) - (across - 1) / 2) * step
        sizes = size * rng.uniform(0.6, 1.0, 3)
        turn = rotation_from_vector(np.array([0, 0, rng.uniform(-np.pi, np.pi)]))
        pose = Pose(turn, np.array([x, y, sizes[2] / 2]))
        if i % 2:
            things.append(Cylinder(f"can {i}", pose, radius=sizes[0] / 2, height=sizes[2]))
        else:
            things.append(Box(f"box {i}", pose, size=sizes))
    return things


def _best(job: Callable[[], object]) -> float:
    """Seconds of the processor of the best of some runs; fewer where one takes long."""
    best, began = np.inf, time.perf_counter()
    for _ in range(RUNS):
        start = time.process_time()
        job()
        best = min(best, time.process_time() - start)
        if time.perf_counter() - began > LONGEST:
            break
    return float(best)


if __name__ == "__main__":
    main()
