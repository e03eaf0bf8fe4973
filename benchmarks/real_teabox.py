# SPDX-License-Identifier: GPL-3.0-or-later
"""One photo of a tea box in: its size from the picks against the 165 x 68 x 80 mm it has.

    python benchmarks/real_teabox.py FOLDER [--out OUT]

FOLDER holds `teabox_frame000.png` and `teabox.xml` (the camera), as in ViSP's tutorial on tracking
a model. Nothing but the box tells the scale, so four of its corners, those of its own
`teabox.init`, give the pose as known points; the other three are the test. The box is of cardboard
and bulges by a millimetre or two. The lens is given without distortion.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import cv2
import numpy as np
from monocell.core import Camera, Cell, Intrinsics, ReferencePlane, Sketch
from monocell.core.calibration.calibrate import calibrate_outlines
from monocell.core.modelling.solve import Modelled, model_cell
from monocell.core.picture.overlay import draw_overlay
from monocell.core.sighting import PointSighting
from monocell.headless.pictures import write_picture
from monocell.headless.told import table, warn
from real_cube_cylinder import number_in

PICK_SIGMA_PIXELS = 1.0
LENGTH, WIDTH, HEIGHT = 0.165, 0.068, 0.080
# read off enlargements
TOP_LEFT, TOP_FRONT, TOP_RIGHT, TOP_BACK = (
    (191.8, 84.0),
    (349.5, 204.8),
    (489.7, 185.7),
    (304, 80.5),
)
LEFT, FRONT, RIGHT = (189.3, 220.8), (329.5, 375.5), (459.5, 349.0)
# world: the table is z = 0, the box's length along x, its width along y, away from the camera
KNOWN = {
    TOP_LEFT: (0.0, 0.0, HEIGHT),
    TOP_FRONT: (LENGTH, 0.0, HEIGHT),
    FRONT: (LENGTH, 0.0, 0.0),
    RIGHT: (LENGTH, WIDTH, 0.0),
}
PICKS = {"base": [LEFT, FRONT, RIGHT], "top": [TOP_LEFT, TOP_FRONT, TOP_RIGHT, TOP_BACK]}
TABLE = ReferencePlane("table", np.zeros(3), np.array([0.0, 0.0, 1.0]))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--out", type=Path, help="a folder for the overlay picture")
    arguments = parser.parse_args()
    picture = cv2.imread(str(arguments.folder / "teabox_frame000.png"))
    if picture is None:
        parser.error(f"{arguments.folder / 'teabox_frame000.png'} is missing or no picture")
    camera = _camera((arguments.folder / "teabox.xml").read_text(), picture.shape)
    sketch = Sketch("tea box", "box", "table", PICKS)
    cell = Cell(camera, references=(TABLE,), sketches=(sketch,))
    solved, results = model_cell(cell, PICK_SIGMA_PIXELS)
    _report(results[0])
    if arguments.out:
        arguments.out.mkdir(parents=True, exist_ok=True)
        overlay = draw_overlay(picture, camera, solved.objects)
        write_picture(arguments.out / "teabox.png", overlay)


def _camera(text: str, shape: tuple[int, ...]) -> Camera:
    """Its pose from the four known corners, with its covariance."""
    numbers = (number_in(text, name) for name in ("px", "py", "u0", "v0"))
    sightings = [
        PointSighting("teabox_frame000.png", place, np.array(pixel), PICK_SIGMA_PIXELS)
        for pixel, place in KNOWN.items()
    ]
    lens = Intrinsics(shape[1], shape[0], *numbers)
    calibration = calibrate_outlines(Camera(lens), sightings, [None] * len(sightings))
    warn(calibration.warnings)
    return calibration.camera


def _report(result: Modelled) -> None:
    thing, sigmas = result.object, result.object.size_sigma()
    assert sigmas is not None
    rows = [
        (name, f"{1e3 * size:.2f} ± {1e3 * sigma:.2f}", f"{1e3 * known:.0f}",
         f"{1e3 * (size - known):+.2f}")
        for name, size, sigma, known in zip(
            ("length", "width", "height"), thing.sizes, sigmas, (LENGTH, WIDTH, HEIGHT), strict=True
        )
    ]  # fmt: skip
    print(table(("size", "solved, mm", "known", "error"), rows))
    print(f"{len(result.residual_pixels)} picks, {result.rms_pixels:.2f} px rms")
    warn(result.warnings)


if __name__ == "__main__":
    main()
