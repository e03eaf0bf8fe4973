# SPDX-License-Identifier: GPL-3.0-or-later
"""Ten photos of a cube and a cylinder in: their sizes against the truth and overlays out.

    python benchmarks/real_cube_cylinder.py FOLDER [--out OUT]

FOLDER holds `image0000.png` to `image0180.png`, `cube.xml` (the camera) and `cube.0.pos` (its pose:
translation, then rotation vector), as in Debian's package visp-images-data (`mbt/cube`). The camera
stands still (what stands behind moves by less than half a pixel); the sheet with both is pushed
over the table. The edge of 84 mm and the radius of 40 mm are known from the package. The cylinder
ends above the picture, so its height is given.

Every frame is solved with two cameras. `as given` takes the pose that comes with the pictures: it
lies 1 to 4 px beside the cube's corners and states no error, so that error is not in the 1 sigma.
`from the cube` finds the pose from the corners of the cube of the first frame, as points that are
known: that cube is then no test, all else is. Last all other frames are solved together with that
camera's error, every cube of the same size as the others and every cylinder too. The lens is given
without distortion.
"""

from __future__ import annotations

import argparse
import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
from cube_cylinder_picks import CUBE, CYLINDER
from monocell.core import Camera, Cell, Intrinsics, Pose, ReferencePlane, Sketch
from monocell.core.align.align import align
from monocell.core.calibration.calibrate import calibrate_outlines
from monocell.core.errors import MonocellError
from monocell.core.modelling.solve import Modelled, model_cell
from monocell.core.picture.overlay import draw_overlay
from monocell.core.relation import Relation
from monocell.core.sighting import PointSighting
from monocell.headless.pictures import write_picture
from monocell.headless.told import table, warn

PICK_SIGMA_PIXELS = 0.7
CUBE_EDGE_MM, CYLINDER_RADIUS_MM, CYLINDER_HEIGHT = 84.0, 40.0, 0.25
EDGE = CUBE_EDGE_MM / 1e3
# the corners picked in the first frame: base, then top, in the order of the picks
CUBE_CORNERS = np.array(
    [
        *[(-EDGE, 0, 0), (0, 0, 0), (0, EDGE, 0)],
        *[(-EDGE, 0, EDGE), (0, 0, EDGE), (0, EDGE, EDGE), (-EDGE, EDGE, EDGE)],
    ]
)
TABLE = ReferencePlane("table", np.zeros(3), np.array([0.0, 0.0, 1.0]))
HEADER = ("frame", "edge x", "edge y", "edge z", "rms px", "radius", "rms px")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--out", type=Path, help="a folder for the overlay pictures")
    arguments = parser.parse_args()
    pictures = {frame: _picture(arguments.folder, frame, parser) for frame in CUBE}
    given = _given(arguments.folder, pictures[0].shape)
    for name, camera in (("as given", given), ("from the cube", _from_cube(given))):
        print(f"\ncamera {name}: sizes in mm, ± 1 sigma")
        solved = {frame: _solved(camera, frame) for frame in CUBE}
        print(table(HEADER, [_row(frame, *pair) for frame, pair in solved.items()]))
        _tell_spread([pair[0] for pair in solved.values()], [CUBE_EDGE_MM] * 3)
        _tell_spread([pair[1] for pair in solved.values()], [CYLINDER_RADIUS_MM])
        _tell_aligned(camera, solved, pictures)
        if arguments.out:
            _write_overlays(pictures, camera, solved, arguments.out / name.replace(" ", "_"))
    print("\ncamera from the cube, all frames but its own together, of one size each")
    _tell_together(_from_cube(given))


def _tell_aligned(
    camera: Camera,
    solved: dict[int, tuple[Modelled | None, Modelled | None]],
    pictures: dict[int, np.ndarray],
) -> None:
    """Where the picture's edges put them from the picks, believed or not."""
    rows, cubes, radii = [], [], []
    for frame, pair in solved.items():
        things = [one.object for one in pair if one is not None]
        found = align(things, camera, pictures[frame], [TABLE]).objects
        row = [str(frame)]
        for name, sizes, count in (("cube", cubes, 3), ("cylinder", radii, 1)):
            one = found.get(name)
            if one is None or one.tried is None:
                row += ["-"] * (count + 1)
                continue
            sizes.append(1e3 * one.tried.sizes[:count])
            row += [*(f"{size:.2f}" for size in sizes[-1]), "yes" if one.believed else "no"]
        rows.append(row)
    print("aligned on the edges")
    print(table(("frame", "edge x", "edge y", "edge z", "believed", "radius", "believed"), rows))
    _tell_sizes("cube", np.array(cubes), CUBE_EDGE_MM)
    _tell_sizes("cylinder", np.array(radii), CYLINDER_RADIUS_MM)


def _tell_sizes(name: str, sizes: np.ndarray, known: float) -> None:
    off, spreads = np.abs(sizes - known), sizes.std(axis=0, ddof=1)
    print(
        f"{name}: mean {sizes.mean():.2f}, off by {off.mean():.2f} on average, {off.max():.2f} at "
        f"most; from frame to frame {', '.join(f'{spread:.2f}' for spread in spreads)}"
    )


def _tell_together(camera: Camera) -> None:
    """One problem: the camera's error and sizes are shared, places are each frame's own."""
    frames = [frame for frame in CUBE if frame != 0]
    cell = Cell(camera, references=(TABLE,), sketches=tuple(_of_one_size(frames)))
    _, modelled = model_cell(cell, PICK_SIGMA_PIXELS, joint=True)
    cube, cylinder = modelled[0], modelled[len(frames)]
    *edges, _ = _told(cube, 3)
    radius, _ = _told(cylinder, 1)
    every = [result.residual_pixels for result in modelled]
    rms = float(np.sqrt(np.mean(np.concatenate(every) ** 2)))
    print(f"edges {', '.join(edges)}; radius {radius} mm; {rms:.2f} px rms")
    warn([warning for result in modelled for warning in result.warnings])


def _of_one_size(frames: Sequence[int]) -> list[Sketch]:
    sketches = []
    for kind, name, picks, known in (
        ("box", "cube", CUBE, {}),
        ("cylinder", "cylinder", CYLINDER, {"height": CYLINDER_HEIGHT}),
    ):
        for frame in frames:
            held = () if frame == frames[0] else (Relation("same_size", f"{name} {frames[0]}"),)
            sketches.append(
                Sketch(f"{name} {frame}", kind, "table", picks[frame], known, relations=held)
            )
    return sketches


def _solved(camera: Camera, frame: int) -> tuple[Modelled | None, Modelled | None]:
    """The cube and the cylinder of a frame, None for one that is refused."""
    cube = Sketch("cube", "box", "table", CUBE[frame])
    known = {"height": CYLINDER_HEIGHT}
    return _one(camera, cube), _one(
        camera, Sketch("cylinder", "cylinder", "table", CYLINDER[frame], known)
    )


def _one(camera: Camera, sketch: Sketch) -> Modelled | None:
    try:
        cell = Cell(camera, references=(TABLE,), sketches=(sketch,))
        return model_cell(cell, PICK_SIGMA_PIXELS)[1][0]
    except MonocellError as error:
        warn([str(error)])
        return None


def _from_cube(given: Camera) -> Camera:
    """The pose from the first frame's cube, with its covariance."""
    pixels = [*CUBE[0]["base"], *CUBE[0]["top"]]
    sightings = [
        PointSighting("image0000.png", place, np.array(pixel), PICK_SIGMA_PIXELS)
        for place, pixel in zip(CUBE_CORNERS, pixels, strict=True)
    ]
    unplaced = Camera(given.intrinsics)
    calibration = calibrate_outlines(unplaced, sightings, [None] * len(sightings))
    warn(calibration.warnings)
    return replace(calibration.camera, intrinsics=given.intrinsics)


def _given(folder: Path, shape: tuple[int, ...]) -> Camera:
    text = (folder / "cube.xml").read_text()
    px, py, u0, v0 = (number_in(text, name) for name in ("px", "py", "u0", "v0"))
    pose = np.array((folder / "cube.0.pos").read_text().split(), dtype=float)
    return Camera(
        Intrinsics(shape[1], shape[0], px, py, u0, v0),
        Pose.from_rotation_vector(pose[3:], pose[:3]),
    )


def _picture(folder: Path, frame: int, parser: argparse.ArgumentParser) -> np.ndarray:
    file = folder / f"image{frame:04d}.png"
    picture = cv2.imread(str(file))
    if picture is None:
        parser.error(f"{file} is missing or no picture")
    return picture


def number_in(text: str, name: str) -> float:
    """The number between the tags of that name."""
    found = re.search(rf"<{name}>([^<]*)</{name}>", text)
    if found is None:
        raise SystemExit(f"the camera file holds no <{name}>")
    return float(found[1])


def _row(frame: int, cube: Modelled | None, cylinder: Modelled | None) -> tuple[str, ...]:
    return (str(frame), *_told(cube, 3), *_told(cylinder, 1))


def _told(one: Modelled | None, count: int) -> list[str]:
    if one is None:
        return ["-"] * (count + 1)
    sigmas = one.object.size_sigma()
    assert sigmas is not None
    sizes = zip(1e3 * one.object.sizes[:count], 1e3 * sigmas[:count], strict=True)
    return [*(f"{size:.2f} ± {sigma:.2f}" for size, sigma in sizes), f"{one.rms_pixels:.2f}"]


def _tell_spread(results: Sequence[Modelled | None], known: Sequence[float]) -> None:
    sizes = np.array([1e3 * r.object.sizes[: len(known)] for r in results if r is not None])
    name = next(r.object.name for r in results if r is not None)
    off = np.abs(sizes - known)
    print(
        f"{name}: {sizes.mean():.2f} mm on average, known {known[0]:g}; from frame to frame ± "
        f"{float(sizes.std(axis=0).max()):.2f}; off by {off.mean():.2f} on average, "
        f"{off.max():.2f} at most"
    )


def _write_overlays(
    pictures: dict[int, np.ndarray],
    camera: Camera,
    solved: dict[int, tuple[Modelled | None, Modelled | None]],
    folder: Path,
) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for frame, picture in pictures.items():
        things = [m.object for m in solved[frame] if m is not None]
        write_picture(folder / f"frame_{frame:04d}.png", draw_overlay(picture, camera, things))


if __name__ == "__main__":
    main()
