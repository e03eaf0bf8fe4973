# SPDX-License-Identifier: GPL-3.0-or-later
"""Clicks beside the visible corners of boxes, each 1 px off, and where snapping takes them.

    python benchmarks/snapping.py [--cells 20] [--clicks 10] [--sigma 1] [--cache FOLDER]

`click`, `corner` and `edge` are median distances to the true corner in pixels: of all clicks and of
what snapped to a corner and to an edge; `held` of all picks, snapped or not. `hurt` are the picks
that snapping took farther off than their click was, by more than one pixel.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from honest_hand import box_corners, corners_seen
from monocell.core.cell import Cell
from monocell.core.document.cell_file import read_cell
from monocell.core.picture.pictures import read_picture
from monocell.core.picture.snapping import snapped
from monocell.core.primitives import Box, Cone, Cylinder, Primitive
from monocell.headless.told import table
from rendered_rigs import CACHE
from rendered_tabletops import rendered_tabletop
from tabletop_plans import random_tabletop

SAMPLES = Path(__file__).resolve().parents[1] / "samples"
RADIUS, HURT = 4.0, 1.0
HEADS = ("picture", "corners", "snapped %", "edge %", "click", "corner", "95 %", "edge", "held",
         "95 % held", "95 % click", "hurt %")  # fmt: skip


@dataclass(frozen=True, eq=False)
class Snapped:
    """Of clicks on a cell's corners: their distances, those after snapping, and to what."""

    corners: int
    click: np.ndarray
    held: np.ndarray
    kind: np.ndarray


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--cells", type=int, default=20)
    parser.add_argument("--clicks", type=int, default=10)
    parser.add_argument("--sigma", type=float, default=1.0)
    parser.add_argument("--cache", type=Path, default=CACHE)
    args = parser.parse_args()
    rows = []
    for name, cells in _groups(args.cells, args.cache):
        parts = [_clicked(*one, args.clicks, args.sigma, i) for i, one in enumerate(cells)]
        rows.append(_row(name, parts))
    print(table(HEADS, rows))


Pictured = tuple[Cell, np.ndarray]


def _groups(count: int, cache: Path) -> Iterator[tuple[str, Iterator[Pictured]]]:
    for name in ("01_table", "03_stack"):
        cell = read_cell(SAMPLES / name / "truth.cell.json")
        yield name, iter([(cell, read_picture(SAMPLES / name / "cell.jpg"))])
    rendered = (rendered_tabletop(random_tabletop(seed), cache) for seed in range(count))
    yield f"{count} table tops", ((one.truth(), one.picture()) for one in rendered)


def true_corners(cell: Cell) -> np.ndarray:
    """Pixels (N, 2) of the corners of boxes that nothing hides."""
    eye, found = cell.camera.centre_world, []
    for box in (thing for thing in cell.objects if isinstance(thing, Box)):
        others = [_hiding(thing) for thing in cell.objects if thing is not box]
        for side in (-1.0, 1.0):
            kept = corners_seen(box, side, eye, others)
            found.append(box_corners(box, side)[kept])
    pixels = cell.camera.project(np.concatenate(found))
    return pixels[cell.camera.intrinsics.contains(pixels)]


def _hiding(thing: Primitive) -> Primitive:
    """What hides at least as much and can be looked past: a cone is as wide as its base."""
    if not isinstance(thing, Cone):
        return thing
    return Cylinder(thing.name, thing.world_from_object, radius=thing.radius, height=thing.height)


def _clicked(cell: Cell, picture: np.ndarray, clicks: int, sigma: float, seed: int) -> Snapped:
    rng = np.random.default_rng([109, seed])
    corners = true_corners(cell)
    click, held, kinds = [], [], []
    for corner in np.repeat(corners, clicks, axis=0):
        at = corner + rng.normal(0.0, sigma, 2)
        snap = snapped(picture, at, RADIUS)
        click.append(np.linalg.norm(at - corner))
        held.append(np.linalg.norm((at if snap is None else snap.pixel) - corner))
        kinds.append("" if snap is None else snap.kind)
    return Snapped(len(corners), np.array(click), np.array(held), np.array(kinds))


def _row(name: str, parts: list[Snapped]) -> tuple[str, ...]:
    click, held = (np.concatenate([getattr(p, k) for p in parts]) for k in ("click", "held"))
    kind = np.concatenate([p.kind for p in parts])
    corner, edge = held[kind == "corner"], held[kind == "edge"]
    figures = [
        np.median(click),
        np.median(corner) if len(corner) else np.nan,
        np.percentile(corner, 95) if len(corner) else np.nan,
        np.median(edge) if len(edge) else np.nan,
        np.median(held),
        np.percentile(held, 95),
        np.percentile(click, 95),
    ]
    hurt = 100 * np.mean(held > click + HURT)
    shares = [f"{100 * np.mean(kind == k):.0f}" for k in ("corner", "edge")]
    told = [f"{value:.2f}" for value in figures]
    return (name, str(sum(p.corners for p in parts)), *shares, *told, f"{hurt:.1f}")


if __name__ == "__main__":
    main()
