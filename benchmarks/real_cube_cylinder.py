# SPDX-License-Identifier: GPL-3.0-or-later
"""A folder with a photo of a cube and a cylinder in: their sizes against the truth, an overlay out.

    python benchmarks/real_cube_cylinder.py FOLDER [--out OUT]

FOLDER holds `image0000.png`, `cube.xml` (the camera) and `cube.0.pos` (its pose: translation, then
rotation vector), as in Debian's package visp-images-data (`mbt/cube`). The pixels below were picked
by hand in an enlargement of the picture; the edge of 84 mm and the radius of 40 mm are known from
the package and used for nothing but the comparison. The cylinder ends above the picture, so its
height is given. The pose that comes with the picture lies 1 to 3 px beside the cube's corners and
states no error: that error is not in the 1 sigma.
"""

from __future__ import annotations

import argparse
import re
from pathlib import Path

import cv2
import numpy as np
from monocell.core import Camera, Cell, Intrinsics, Pose, ReferencePlane, Sketch
from monocell.core.atomic import atomic_path
from monocell.core.modelling.solve import Modelled, model_cell
from monocell.core.picture.overlay import draw_overlay

PICK_SIGMA_PIXELS = 0.5
CUBE_EDGE_MM, CYLINDER_RADIUS_MM, CYLINDER_HEIGHT = 84.0, 40.0, 0.25
CUBE = {
    "base": [(315.2, 291.2), (361.5, 350.9), (430.0, 312.2)],
    "top": [(314.6, 234.0), (366.9, 292.0), (443.3, 254.2), (385.4, 203.0)],
}
CYLINDER = {
    "rim": [
        *[(225.0, 271.9), (230.0, 275.1), (235.0, 277.5), (240.0, 278.6), (250.0, 279.7)],
        *[(260.0, 279.2), (270.0, 275.7), (275.0, 273.1), (280.0, 269.7), (284.6, 265.0)],
    ],
    "sides": [
        *[(173.0, 25.0), (174.6, 35.0), (187.9, 105.0), (189.3, 115.0), (203.3, 185.0)],
        *[(205.0, 195.0), (275.3, 40.0), (279.9, 115.0), (280.7, 125.0), (284.7, 195.0)],
        (285.4, 205.0),
    ],
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--out", type=Path, help="a folder for the overlay picture")
    arguments = parser.parse_args()
    picture = cv2.imread(str(arguments.folder / "image0000.png"))
    if picture is None:
        parser.error(f"{arguments.folder / 'image0000.png'} is missing or no picture")
    cell, results = model_cell(_cell(arguments.folder, picture.shape), PICK_SIGMA_PIXELS)
    _report(*results)
    if arguments.out:
        overlay = draw_overlay(picture, cell.camera, cell.objects)
        arguments.out.mkdir(parents=True, exist_ok=True)
        with atomic_path(arguments.out / "cube_cylinder.png") as path:
            cv2.imwrite(str(path), overlay)


def _cell(folder: Path, shape: tuple[int, ...]) -> Cell:
    text = (folder / "cube.xml").read_text()
    px, py, u0, v0 = (_number(text, name) for name in ("px", "py", "u0", "v0"))
    pose = np.array((folder / "cube.0.pos").read_text().split(), dtype=float)
    camera = Camera(
        Intrinsics(shape[1], shape[0], px, py, u0, v0),
        Pose.from_rotation_vector(pose[3:], pose[:3]),
    )
    table = ReferencePlane("table", np.zeros(3), np.array([0.0, 0.0, 1.0]))
    sketches = (
        Sketch("cube", "box", "table", CUBE),
        Sketch("cylinder", "cylinder", "table", CYLINDER, {"height": CYLINDER_HEIGHT}),
    )
    return Cell(camera, references=(table,), sketches=sketches)


def _number(text: str, name: str) -> float:
    found = re.search(rf"<{name}>([^<]*)</{name}>", text)
    if found is None:
        raise SystemExit(f"cube.xml holds no <{name}>")
    return float(found[1])


def _report(cube: Modelled, cylinder: Modelled) -> None:
    print(f"{'size':22}{'solved, mm':>12}{'1 sigma':>9}{'known':>8}{'error':>8}")
    for result, known in ((cube, [CUBE_EDGE_MM] * 3), (cylinder, [CYLINDER_RADIUS_MM])):
        thing, sigmas = result.object, result.object.size_sigma()
        assert sigmas is not None
        for name, size, sigma, truth in zip(
            thing.size_names, 1e3 * thing.sizes, 1e3 * sigmas, known, strict=False
        ):
            label = f"{thing.name} {name}"
            print(f"{label:22}{size:12.2f}{sigma:9.2f}{truth:8.1f}{size - truth:+8.2f}")
        print(f"  {len(result.residual_pixels)} picks, {result.rms_pixels:.2f} px rms")
        for warning in result.warnings:
            print(f"  warning: {warning}")
    print("1 sigma holds the picks' error alone: the folder states none for its pose")


if __name__ == "__main__":
    main()
