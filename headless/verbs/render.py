# SPDX-License-Identifier: GPL-3.0-or-later
"""`monocell render`: a true cell in, its pictures through Cycles and the truth beside them out."""

from __future__ import annotations

import argparse
import os
from dataclasses import replace
from pathlib import Path

import numpy as np

from ...core.atomic import made_folder
from ...core.cell import Cell
from ...core.document.cell_file import read_cell, write_cell
from ...core.errors import InvalidValue
from ...core.primitives import Primitive
from ...core.sighting import SphereSighting
from ..blender import require_blender
from ..told import progress

BALL_COLOR = np.array([0.06, 0.42, 0.05])
TRUTH = "truth.cell.json"
MOST_SAMPLES = 65536


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's own arguments."""
    parser.add_argument("cell", type=Path, help="cell document with camera pose and objects")
    parser.add_argument("out", type=Path, help="folder for the pictures, made if it is not there")
    parser.add_argument(
        "--samples", type=int, default=8, help="light paths per pixel (default 8); more, less grain"
    )


def run(args: argparse.Namespace) -> int:
    """Render the cell's picture and each sighting's, and write the truth with their names."""
    if not 1 <= args.samples <= MOST_SAMPLES:
        raise InvalidValue(
            f"--samples: must be 1 or more, up to {MOST_SAMPLES}, got {args.samples}"
        )
    cell = read_cell(args.cell)
    cell.standing_camera()  # without a pose it is refused before anything is made
    _refuse_what_is_not_held(cell)
    if args.out.resolve() == cell.folder.resolve():
        raise InvalidValue(f"{args.out}: is the cell's own folder, with its pictures; name another")
    truth = _named(cell, args.out)
    _refuse_shared_names(truth)
    require_blender()
    made_folder(args.out)
    _render_all(truth, args.samples)
    write_cell(truth, args.out / TRUTH)
    for name in (truth.picture or "", *(s.picture for s in truth.sightings)):
        print(args.out / name)
    print(args.out / TRUTH)
    return 0


def _named(cell: Cell, out: Path) -> Cell:
    """Pictures by their bare names in the new folder; a cell without a picture gets one."""
    return replace(
        cell,
        objects=tuple(_moved_textures(thing, cell, out) for thing in cell.objects),
        picture=Path(cell.picture or "cell.png").with_suffix(".png").name,
        sightings=tuple(
            replace(s, picture=Path(s.picture).with_suffix(".png").name) for s in cell.sightings
        ),
        folder=out,
    )


def _moved_textures(thing: Primitive, cell: Cell, out: Path) -> Primitive:
    """Textures stay where they are; from the new folder they have other names."""
    if thing.appearance is None:
        return thing

    def moved(name: str) -> str:
        return Path(os.path.relpath(cell.path_of(name).resolve(), out.resolve())).as_posix()

    return replace(thing, appearance=thing.appearance.with_pictures(moved))


def _refuse_shared_names(truth: Cell) -> None:
    """One file can't hold two renderings: the last would stand for all that name it."""
    names = [truth.picture, *(sighting.picture for sighting in truth.sightings)]
    for name in names:
        if names.count(name) > 1:
            raise InvalidValue(
                f"{name}: {names.count(name)} pictures of the cell would have this name; "
                "give each sighting a picture of its own"
            )


def _refuse_what_is_not_held(cell: Cell) -> None:
    """A ball is rendered where it is known to be, and before a camera that stands still."""
    if cell.mount is not None and cell.sightings:
        raise InvalidValue("mount: sightings of a camera on the flange are not rendered")
    for i, sighting in enumerate(cell.sightings):
        if not isinstance(sighting, SphereSighting) or sighting.center_world is None:
            raise InvalidValue(
                f"sightings[{i}]: only balls at known places are rendered; give center and radius"
            )


def _render_all(truth: Cell, samples: int) -> None:
    from ...scene.stage import Stage
    from ...scene.work_cell import Ball, WorkCell

    assert truth.picture is not None
    progress(f"rendering {truth.picture}")
    with Stage(WorkCell(truth.camera, truth.objects, folder=truth.folder)) as stage:
        stage.render(truth.folder / truth.picture, samples=samples)
    with Stage(WorkCell(truth.camera)) as stage:
        for sighting in truth.sightings:
            assert isinstance(sighting, SphereSighting)
            progress(f"rendering {sighting.picture}")
            stage.move((), Ball(sighting.center_world, sighting.radius, BALL_COLOR))
            stage.render(truth.folder / sighting.picture, samples=samples)
