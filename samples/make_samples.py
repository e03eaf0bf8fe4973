# SPDX-License-Identifier: GPL-3.0-or-later
"""The demo's files in, the sample cell out: `python samples/make_samples.py DEMO`.

Pictures become JPEGs, as a site would send them; the document is given back as it was before
calibration, so that a newcomer does the work.
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path

import cv2
from monocell.core.camera import Camera
from monocell.core.cell import Cell
from monocell.core.document.cell_file import read_cell, write_cell
from monocell.core.sketch import Sketch

QUALITY = 92
HERE = Path(__file__).parent / "01_table"


def main() -> None:
    """Write sample 01."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("demo", type=Path, help="folder that monocell demo wrote")
    args = parser.parse_args()
    HERE.mkdir(exist_ok=True)
    solved = read_cell(args.demo / "cell.cell.json")
    given = replace(
        solved,
        camera=Camera(solved.camera.intrinsics),
        objects=(),
        sketches=tuple(Sketch.of(thing) for thing in solved.objects),
    )
    truth = read_cell(args.demo / "truth.cell.json")
    for name in [solved.picture, *(s.picture for s in solved.sightings)]:
        picture = cv2.imread(str(args.demo / str(name)))
        jpeg = str(HERE / Path(str(name)).with_suffix(".jpg"))
        cv2.imwrite(jpeg, picture, [cv2.IMWRITE_JPEG_QUALITY, QUALITY])
    write_cell(_with_jpegs(given), HERE / "table.cell.json")
    write_cell(_with_jpegs(truth), HERE / "truth.cell.json")


def _with_jpegs(cell: Cell) -> Cell:
    def jpeg(name: str) -> str:
        return Path(name).with_suffix(".jpg").name

    return replace(
        cell,
        picture=jpeg(str(cell.picture)),
        sightings=tuple(replace(s, picture=jpeg(s.picture)) for s in cell.sightings),
        folder=HERE,
    )


if __name__ == "__main__":
    main()
