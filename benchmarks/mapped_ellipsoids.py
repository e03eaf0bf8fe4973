# SPDX-License-Identifier: GPL-3.0-or-later
"""How often the truth lies inside the 95 % ellipsoid of a pixel mapped onto a reference.

    python benchmarks/mapped_ellipsoids.py [--draws 400] [--seed 11]

A cell on a table: picks with 1 px of noise, a camera off by its stated covariance, a box solved
from its picks, and references made from picks, from the box, and from each other. Beside it what
the same errors would hold if the reference's were taken for independent of the camera's.
"""

from __future__ import annotations

import argparse
from dataclasses import replace

import numpy as np
from monocell.core import Box, Camera, Cell, Distortion, Intrinsics, Pose, ReferencePlane, Sketch
from monocell.core.arrays import Array
from monocell.core.modelling.map_pixels import map_pixels
from monocell.core.modelling.solve import model_cell
from monocell.core.reference import PendingReference, Reference
from monocell.core.references.resolve import resolve_references
from monocell.core.references.sources import (
    FacingCamera,
    FeatureOf,
    Intersection,
    Parallel,
    PickedPoints,
    Source,
    Upright,
)
from monocell.headless.told import table

LENS = Intrinsics(
    1280, 960, 1200.0, 1195.0, 652.3, 471.8, Distortion("plumb_bob", [-0.12, 0.05, 4e-4, -3e-4, 0])
)
# 1 mrad and 2 mm, with a turn that goes with a move, as calibrations have them
SPREAD = np.diag([1e-6] * 3 + [4e-6] * 3) - 1.5e-6 * np.eye(6)[[4, 3, 5, 1, 0, 2]]
FLOOR = ReferencePlane("floor", [0, 0, 0], [0, 0, 1])
CRATE = Box(
    "crate", Pose.from_rotation_vector([0, 0, 0.5], [0.1, -0.1, 0.08]), size=[0.3, 0.2, 0.16]
)
RAMP = np.array([[-0.2, 0.2, 0.1], [0.2, 0.2, 0.1], [0.2, 0.5, 0.25], [-0.2, 0.5, 0.25]])
FOOT = np.array([[-0.5, -0.5, 0.0], [-0.5, 0.0, 0.0], [-0.5, 0.5, 0.0]])
SPOT = np.array([[0.3, 0.35, 0.0]])
WITHIN_95 = {2: 5.991, 3: 7.815}


def main() -> None:
    """Print one row a reference."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--draws", type=int, default=400)
    parser.add_argument("--seed", type=int, default=11)
    args = parser.parse_args()
    rng = np.random.default_rng(args.seed)
    points = _points()
    held = {name: [] for name in points}
    for _ in range(args.draws):
        for name, inside in _draw(rng, points).items():
            held[name].append(inside)
    rows = [
        (name, *(f"{100 * share:.1f} %" for share in np.mean(inside, axis=0)))
        for name, inside in held.items()
    ]
    print(f"{args.draws} draws: how many 95 % ellipsoids hold the true point")
    print(table(("on", "stated", "if independent"), rows))


def _points() -> dict[str, Array]:
    """A true point of each reference."""
    eye = Camera(LENS, _pose(np.zeros(3))).centre_world
    axis, corner = CRATE.world_from_object.translation, CRATE.corners_world()
    sight = eye - axis
    sideways = np.cross([0, 0, 1], sight) / np.linalg.norm(np.cross([0, 0, 1], sight))
    return {
        "floor": np.array([0.2, -0.4, 0.0]),
        "ramp": RAMP.mean(axis=0),
        "wall": np.array([-0.5, 0.1, 0.3]),
        "post": np.array([0.3, 0.35, 0.2]),
        "crate.top": corner[4:].mean(axis=0),
        "crate.x+top": corner[[5, 7]].mean(axis=0),
        "loft": np.add(corner[4:].mean(axis=0), [0.05, 0.05, 0.2]),
        "sheet": axis + 0.1 * sideways + [0, 0, 0.15],
        "seam": np.array([-0.5, 0.1, 0.36]),
    }


def _pose(shift: Array) -> Pose:
    return Pose.looking_at(np.array([1.7, -1.2, 1.3]) + shift, [0.0, 0.05, 0.1], [0, 0, 1])


def _sources(camera: Camera, rng: np.random.Generator) -> dict[str, tuple[str, Source]]:
    def picked(points: Array) -> Array:
        return camera.project(points) + rng.normal(0, 1.0, (len(points), 2))

    return {
        "ramp": ("plane", PickedPoints(picked(RAMP), RAMP[:, 2], "floor")),
        "wall": ("plane", Upright(picked(FOOT), "floor")),
        "post": ("line", Upright(picked(SPOT), "floor")),
        "lid": ("plane", FeatureOf("crate.top")),
        "loft": ("plane", Parallel("lid", 0.2)),
        "sheet": ("plane", FacingCamera("crate.axis")),
        "seam": ("line", Intersection(("wall", "loft"))),
    }


def _draw(rng: np.random.Generator, points: dict[str, Array]) -> dict[str, tuple[bool, bool]]:
    """Whether each point lies in its ellipsoid: as stated, and if the errors were independent."""
    true = Camera(LENS, _pose(rng.uniform(-0.2, 0.2, 3)))
    sources = _sources(true, rng)
    pending = [PendingReference(name, kind, source) for name, (kind, source) in sources.items()]
    twist = rng.multivariate_normal(np.zeros(6), SPREAD)
    camera = true.placed(true.pose.perturbed(twist), SPREAD)
    sketch = Sketch("crate", "box", "floor", _picks(true, rng))
    cell = Cell(camera, references=(FLOOR, *pending), sketches=(sketch,))
    solved = resolve_references(model_cell(cell)[0])[0]
    inside = {}
    for name, point in points.items():
        if name == "sheet":
            point = _on_sheet(point, true)
        pixel = true.project(point[None]) + rng.normal(0, 1.0, (1, 2))
        reference = solved.reference(name)
        alone = replace(reference, by_camera=None, source=None)
        stated, independent = (_holds(camera, r, pixel, point) for r in (reference, alone))
        inside[name] = (stated, independent)
    return inside


def _on_sheet(point: Array, true: Camera) -> Array:
    """The point moved onto the plane that truly faces the true camera."""
    axis = CRATE.world_from_object.translation
    sight = (true.centre_world - axis) * [1, 1, 0]
    normal = sight / np.linalg.norm(sight)
    return point - normal * ((point - axis) @ normal)


def _picks(true: Camera, rng: np.random.Generator) -> dict[str, list[list[float]]]:
    corners = true.project(CRATE.corners_world()) + rng.normal(0, 1.0, (8, 2))
    return {"base": corners[[0, 1, 3]].tolist(), "top": corners[[4, 5, 7]].tolist()}


def _holds(camera: Camera, reference: Reference, pixel: Array, point: Array) -> bool:
    mapped = map_pixels(camera, reference, pixel)
    off, covariance = mapped.points[0] - point, mapped.covariances[0]
    values, vectors = np.linalg.eigh(covariance)
    # a point of a plane that is known exactly errs in two directions only
    kept = values > 1e-9 * values[-1]
    distance = float(np.sum((vectors[:, kept].T @ off) ** 2 / values[kept]))
    return distance < WITHIN_95[int(kept.sum())]


if __name__ == "__main__":
    main()
