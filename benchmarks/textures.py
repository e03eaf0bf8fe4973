# SPDX-License-Identifier: GPL-3.0-or-later
"""How well textures taken from one picture give it back, and what they show from the side.

    python benchmarks/textures.py [--cells 4] [--samples 64] [--out FOLDER]

Cells with printed and plain objects that hide each other are rendered through a distorted lens.
Each object gets its textures from that picture: with the true model and camera, and with estimated
ones (boxes and cylinders solved from picks that are 1 px off, the camera off by its 1 sigma of
0.3 mm and 0.006 degrees). Then the virtual environment is rendered, shining by itself: the light is
in the textures. Columns: the mean absolute difference from the picture, in percent of the range of
an 8-bit sRGB value, over all pixels that truly show an object and over those clear of every edge;
and the same from 20 degrees aside against a true render, over all object pixels, and over those
whose surface the first picture shows too. `plain` is the true model with one colour an object.
"""

from __future__ import annotations

import argparse
import tempfile
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
from monocell.core.camera import Camera
from monocell.core.cell import Cell
from monocell.core.look.looks import looks_of
from monocell.core.look.sure_pixels import Sight
from monocell.core.look.texture_files import with_looks
from monocell.core.look.textures import SMALLEST_ANGLE, eight_bit_srgb
from monocell.core.modelling.solve import model_cell
from monocell.core.shape.charts import chart_of
from monocell.core.shape.hits import SeenMap, bounds, face_names, occluded, seen_map
from monocell.headless.demo.hand import pick_objects
from monocell.headless.told import progress, table
from textured_cells import KINDS, textured_cell, turned_aside

PICK_SIGMA = 1.0
CAMERA_SIGMA = np.array([np.radians(0.006) / np.sqrt(3)] * 3 + [0.3e-3 / np.sqrt(3)] * 3)
ASIDE_DEGREES = 20.0
# what a hand picks here
PICKED = ("box", "cylinder")
HEADER = ("cell", "model", "all px", "off edges", "aside, all", "aside, seen", "seen aside")


def main() -> None:
    """Print a row a cell and model, then the means."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cells", type=int, default=4)
    parser.add_argument("--first", type=int, default=0, help="seed of the first cell")
    parser.add_argument("--samples", type=int, default=64)
    parser.add_argument("--out", type=Path, help="keep the pictures in this folder")
    args = parser.parse_args()
    rows, figures = [], {}
    for seed in range(args.first, args.first + args.cells):
        with tempfile.TemporaryDirectory() as scratch:
            folder = Path(scratch) if args.out is None else args.out / f"cell_{seed}"
            folder.mkdir(parents=True, exist_ok=True)
            for model, errors in _measured(seed, args.samples, folder).items():
                rows.append((str(seed), model, *(f"{v:.2f} %" for v in errors)))
                figures.setdefault(model, []).append(errors)
    for model, errors in figures.items():
        rows.append(("mean", model, *(f"{v:.2f} %" for v in np.mean(errors, axis=0))))
    print(table(HEADER, rows))


def _measured(seed: int, samples: int, folder: Path) -> dict[str, tuple[float, ...]]:
    truth = textured_cell(seed, folder, KINDS)
    aside = turned_aside(truth.camera, ASIDE_DEGREES)
    progress(f"cell {seed}: rendering the truth")
    picture, side_picture = _photographs(truth, aside, samples)
    cv2.imwrite(str(folder / "picture.png"), picture)
    cv2.imwrite(str(folder / "aside.png"), side_picture)
    views = {"true": _stripped(truth), "estimated": _estimated(truth, seed)}
    figures = {}
    for model, cell in views.items():
        names = [thing.name for thing in cell.objects]
        looks = list(looks_of(cell, picture, textured=names))
        dressed = with_looks(cell, looks, folder / f"{model}.cell.json")
        plain = cell.with_objects(_without_textures(thing) for thing in dressed.objects)
        shown_as = {model: dressed} if model == "estimated" else {model: dressed, "plain": plain}
        for kind, shown in shown_as.items():
            progress(f"cell {seed}: rendering what was made with the {kind} model")
            figures[kind] = _errors(truth, aside, shown, picture, side_picture, folder, kind)
    return figures


def _errors(
    truth: Cell, aside: Camera, shown: Cell, picture: np.ndarray, side_picture: np.ndarray,
    folder: Path, kind: str,
) -> tuple[float, ...]:  # fmt: skip
    front, side = _flat(shown, shown.camera), _flat(shown, aside)
    sight = Sight.of(truth.objects, truth.camera)
    object_pixels = sight.seen.owner >= 0
    inner = np.zeros_like(object_pixels)
    for index, thing in enumerate(truth.objects):
        for face in range(len(face_names(thing))):
            inner |= sight.sure(index, 1.5, face)
    from_side = seen_map(truth.objects, aside)
    seen_twice = _seen_before(truth, aside, from_side)
    name = kind.replace(", ", "_")
    cv2.imwrite(str(folder / f"{name}_front.png"), np.hstack([picture, front]))
    cv2.imwrite(str(folder / f"{name}_aside.png"), np.hstack([side_picture, side]))
    return (
        _difference(front, picture, object_pixels),
        _difference(front, picture, inner),
        _difference(side, side_picture, from_side.owner >= 0),
        _difference(side, side_picture, seen_twice),
        100 * float(seen_twice.sum() / (from_side.owner >= 0).sum()),
    )


def _difference(a: np.ndarray, b: np.ndarray, mask: np.ndarray) -> float:
    """Mean absolute difference over a mask, in percent of the full range."""
    return 100 * float(np.abs(a[mask].astype(float) - b[mask]).mean()) / 255


def _seen_before(truth: Cell, aside: Camera, view: SeenMap) -> np.ndarray:
    """Pixels of the side view whose point of the surface the first camera sees, and not aslant."""
    rows, columns = np.nonzero(view.owner >= 0)
    origin, rays = aside.rays_world(np.stack([columns, rows], axis=1))
    points = origin + view.depth[rows, columns][:, None] * rays
    owner, face = view.owner[rows, columns], view.face[rows, columns]
    eye = truth.camera.centre_world
    # of an object that is not convex, its own other parts hide some too
    seen = ~occluded(truth.objects, eye, points, -1, tolerance=1e-4)
    steep = np.zeros(len(points), dtype=bool)
    for index, thing in enumerate(truth.objects):
        for number, name in enumerate(face_names(thing)):
            here = (owner == index) & (face == number)
            chart, pose = chart_of(thing, name), thing.world_from_object
            st = chart.coordinates(pose.inverse().apply(points[here]))
            to_eye = eye - points[here]
            rise = np.einsum("ij,ij->i", pose.rotate(chart.normals(st)), to_eye)
            steep[here] = rise > np.sin(SMALLEST_ANGLE) * np.linalg.norm(to_eye, axis=1)
    pixels = truth.camera.project(points)
    mask = np.zeros(view.owner.shape, dtype=bool)
    mask[rows, columns] = seen & steep & truth.camera.intrinsics.contains(pixels)
    return mask


def _estimated(truth: Cell, seed: int) -> Cell:
    """Boxes and cylinders from picks, under a camera that is off by what it states."""
    rng = np.random.default_rng(seed + 1000)
    twist = rng.normal(0, CAMERA_SIGMA)
    camera = truth.camera.placed(truth.camera.pose.perturbed(twist), np.diag(CAMERA_SIGMA**2))
    solvable = tuple(thing for thing in truth.objects if thing.kind in PICKED)
    sketches = pick_objects(truth.camera, solvable, PICK_SIGMA, seed)
    known = tuple(thing for thing in truth.objects if thing.kind not in PICKED)
    solved, _ = model_cell(replace(truth, camera=camera, objects=known, sketches=sketches))
    return _stripped(solved)


def _stripped(cell: Cell) -> Cell:
    """Without appearance: what textures are made of must come from the picture."""
    return cell.with_objects(replace(thing, appearance=None) for thing in cell.objects)


def _without_textures(thing):
    if thing.appearance is None:
        return thing
    return replace(thing, appearance=replace(thing.appearance, textures={}))


def _photographs(truth: Cell, aside: Camera, samples: int) -> tuple[np.ndarray, np.ndarray]:
    import bpy
    from monocell.scene.stage import Stage
    from monocell.scene.work_cell import WorkCell

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with Stage(WorkCell(truth.camera, truth.objects)) as stage:
        first, second = (
            _placed(stage.window(window, camera=camera, samples=samples), window, camera)
            for camera in (truth.camera, aside)
            for window in (_window(truth, camera),)
        )
    return first, second


def _flat(cell: Cell, camera: Camera) -> np.ndarray:
    from monocell.scene.flat_view import flat_view

    window = _window(cell, camera)
    return _placed(flat_view(cell, camera=camera, window=window, samples=16), window, camera)


def _window(cell: Cell, camera: Camera) -> tuple[int, int, int, int]:
    """The part of the picture that the objects are in, with room round it."""
    edges = np.array([bounds(thing, camera) for thing in cell.objects])
    low = np.maximum(edges[:, :2].min(axis=0) - 20, 0)
    inner = camera.intrinsics
    high = np.minimum(edges[:, 2:].max(axis=0) + 20, [inner.width, inner.height])
    return int(low[0]), int(low[1]), int(high[0] - low[0]), int(high[1] - low[1])


def _placed(light: np.ndarray, window: tuple[int, int, int, int], camera: Camera) -> np.ndarray:
    """The window in a picture of the camera's size, 8 bits, blue, green, red; else black."""
    x, y, width, height = window
    picture = np.zeros((camera.intrinsics.height, camera.intrinsics.width, 3), np.uint8)
    picture[y : y + height, x : x + width] = eight_bit_srgb(light)[..., ::-1]
    return picture


if __name__ == "__main__":
    main()
