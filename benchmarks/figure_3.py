# SPDX-License-Identifier: GPL-3.0-or-later
"""The paper's figure 3, rebuilt: one rendered picture and its picks in, errors and pictures out.

    python benchmarks/figure_3.py [--out OUT] [--joint] [--trials 24]

OUT gets the picture, the cell as picked, modelled and as it is, the wire-frames over the picture,
and what was modelled seen from another side, beside the true scene from there. `--trials` has the
scene picked again by so many other hands and tells how often what they state holds the truth. The
paper found the blocks, drum, base and trunk easy, needed the right angle for the shoulder, and
could not model the two balls: here their known radius gives their distance.
"""

from __future__ import annotations

import argparse
import tempfile
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
from figure_3_plan import (
    FLOOR,
    PICK_SIGMA_PIXELS,
    camera,
    other_side,
    sketches,
    true_things,
    work_cell,
)
from monocell.core.camera import Camera
from monocell.core.cell import Cell
from monocell.core.comparison import compare_cells
from monocell.core.document.cell_file import write_cell
from monocell.core.modelling.solve import Modelled, model_cell
from monocell.core.picture.overlay import draw_overlay
from monocell.core.picture.pictures import read_picture
from monocell.core.primitives import Primitive
from monocell.headless.pictures import write_picture
from monocell.headless.told import progress, table, warn
from tabletop_scores import HEADER as THINGS_HEADER
from tabletop_scores import ThingScore, figures, score

SAMPLES = 16
HEADER = (
    "object",
    "kind",
    "sizes, mm",
    "error, mm",
    "± 1 sigma",
    "place mm",
    "±",
    "tilt deg",
    "px",
)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, help="a folder for documents and pictures")
    parser.add_argument("--joint", action="store_true", help="solve all objects together")
    parser.add_argument("--trials", type=int, default=0, help="so many other hands")
    arguments = parser.parse_args()
    truth = Cell(camera(), references=(FLOOR,), objects=true_things())
    picked = Cell(camera(), "figure_3.png", references=(FLOOR,), sketches=sketches())
    solved, modelled = model_cell(picked, PICK_SIGMA_PIXELS, joint=arguments.joint)
    print(table(HEADER, _rows(truth, solved, modelled)))
    warn([warning for one in modelled for warning in one.warnings])
    if arguments.trials:
        print(table(("object", *THINGS_HEADER), _trial_rows(arguments.trials, arguments.joint)))
    if arguments.out:
        arguments.out.mkdir(parents=True, exist_ok=True)
        _write(arguments.out, truth, picked, solved)


def _trial_rows(trials: int, joint: bool) -> list[tuple[str, ...]]:
    """Of each object, and of all: how far many hands are off, and how often they say so."""
    truth = true_things()
    scores: dict[str, list[ThingScore]] = {thing.name: [] for thing in truth}
    for seed in range(1000, 1000 + trials):
        picked = Cell(camera(), references=(FLOOR,), sketches=sketches(seed))
        solved, modelled = model_cell(picked, PICK_SIGMA_PIXELS, joint=joint)
        for true, thing, one in zip(truth, solved.objects, modelled, strict=True):
            scores[true.name].append(score(str(seed), true, thing, one.warnings))
    everything = [one for of_one in scores.values() for one in of_one]
    return [(name, *figures(of_one)) for name, of_one in {**scores, "all": everything}.items()]


def _rows(truth: Cell, solved: Cell, modelled: tuple[Modelled, ...]) -> list[tuple[str, ...]]:
    errors = {error.name: error for error in compare_cells(truth, solved).objects}
    rows = []
    for one in modelled:
        error = errors[one.object.name]
        sigma = error.size_sigma if error.size_sigma is not None else np.zeros(len(error.sizes))
        spread = error.position_sigma if error.position_sigma is not None else np.zeros(3)
        rows.append(
            (
                error.name,
                error.kind,
                " x ".join(f"{1e3 * size:.0f}" for size in error.true_sizes),
                ", ".join(f"{1e3 * e:+.1f}" for e in error.sizes),
                ", ".join(f"{1e3 * s:.1f}" for s in sigma),
                f"{1e3 * np.linalg.norm(error.position):.1f}",
                f"{1e3 * np.linalg.norm(spread):.1f}",
                # a ball has no axis
                "" if error.kind == "sphere" else f"{np.degrees(error.tilt):.2f}",
                f"{one.rms_pixels:.2f}",
            )
        )
    return rows


def _write(out: Path, truth: Cell, picked: Cell, solved: Cell) -> None:
    write_cell(replace(truth, picture="figure_3.png"), out / "truth.cell.json")
    write_cell(picked, out / "picked.cell.json")
    write_cell(solved, out / "modelled.cell.json")
    progress("rendering the scene, and both from the other side")
    picture, true_aside = _rendered(truth.objects, [camera(), other_side()])
    (aside,) = _rendered(solved.objects, [other_side()])
    write_picture(out / "figure_3.png", picture)
    write_picture(out / "figure_3_wires.jpg", draw_overlay(picture, solved.camera, solved.objects))
    both = np.hstack([_titled(true_aside, "the scene"), _titled(aside, "the model")])
    write_picture(out / "figure_3_other_side.jpg", both)


def _rendered(things: tuple[Primitive, ...], cameras: list[Camera]) -> list[np.ndarray]:
    import bpy
    from monocell.scene.stage import Stage

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    pictures = []
    with tempfile.TemporaryDirectory() as folder, Stage(work_cell(things)) as stage:
        for looking in cameras:
            file = Path(folder) / "seen.png"
            stage.render(file, camera=looking, samples=SAMPLES)
            pictures.append(read_picture(file))
    return pictures


def _titled(picture: np.ndarray, title: str) -> np.ndarray:
    titled = picture.copy()
    for color, width in (((20, 16, 14), 5), ((255, 255, 255), 2)):
        place, font = (24, 48), cv2.FONT_HERSHEY_SIMPLEX
        cv2.putText(titled, title, place, font, 1.1, color, width, cv2.LINE_AA)
    return titled


if __name__ == "__main__":
    main()
