# SPDX-License-Identifier: GPL-3.0-or-later
"""Rigs rendered once with Cycles and kept: a plan in, linear light of each sighting out.

    python benchmarks/rendered_rigs.py [--family varied] [--rigs 40] [--bare] [--cache FOLDER]

The empty cell is rendered once a rig; each sighting adds three patches, each finer than the one
below: what its shadow reaches, the gripper, and the ball. A rig is one file, and a run that was
broken off goes on where it ended. Blur, noise and encoding are added afterwards
(`photographs.py`), so that one rendering serves many cameras.
"""

from __future__ import annotations

import argparse
import hashlib
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from monocell.core.atomic import atomic_path
from monocell.core.ball.sphere import outline_pixels
from monocell.headless.told import progress
from monocell.scene.work_cell import Ball, WorkCell
from rig_plans import FAMILIES, RADIUS, RigPlan, corners_world, gripper_of, random_plan

CACHE = Path.home() / ".cache" / "monocell-bench"
BACKGROUND_SAMPLES, SHADOW_SAMPLES, GRIPPER_SAMPLES, BALL_SAMPLES = 4, 4, 16, 64
# pixels around the ball that blur and edge search reach, around the gripper, around a shadow
BALL_MARGIN, GRIPPER_MARGIN, SHADOW_MARGIN = 16, 8, 12
# a new number makes all rigs be rendered again
EDITION = 1
Window = tuple[int, int, int, int]


@dataclass(frozen=True, eq=False)
class Patch:
    """Linear light (h, w, 3) whose top left pixel is at `corner` (x, y) of the picture."""

    corner: tuple[int, int]
    light: np.ndarray


@dataclass(frozen=True, eq=False)
class RenderedRig:
    """A plan with the light of its empty cell and the patches of each sighting."""

    plan: RigPlan
    background: np.ndarray
    patches: tuple[tuple[Patch, ...], ...]

    def light(self, sighting: int) -> np.ndarray:
        """The whole picture of a sighting, (H, W, 3) linear light, red green blue, float32."""
        light = self.background.astype(np.float32)
        for patch in self.patches[sighting]:
            (x, y), (height, width) = patch.corner, patch.light.shape[:2]
            light[y : y + height, x : x + width] = patch.light
        return light


def rendered_rig(plan: RigPlan, *, bare: bool = False, cache: Path = CACHE) -> RenderedRig:
    """The rig from the cache, or rendered now and put there. `bare`: the ball without gripper."""
    digest = digest_of(plan)
    empty = cache / f"{plan.name}-{digest}-empty.npz"
    file = cache / f"{plan.name}-{digest}-{'bare' if bare else 'held'}.npz"
    if not (empty.is_file() and file.is_file()):
        _render(plan, bare, empty, file)
    with np.load(file) as kept:
        patches = kept_patches(kept, len(plan.positions))
    with np.load(empty) as kept:
        return RenderedRig(plan, kept["light"], patches)


def digest_of(plan: RigPlan) -> str:
    """Of all that shows in the pictures, to nine digits: processors differ in the last."""
    lens, lab = plan.camera.intrinsics, plan.lab
    numbers = [
        [EDITION, lens.fx, lens.fy, lens.cx, lens.cy, plan.ball_roughness],
        [*lens.distortion.coefficients, *plan.ball_color],
        [*plan.camera.pose.matrix().ravel(), *plan.positions.ravel()],
        [float(v) for flange in plan.flanges for v in flange.matrix().ravel()],
        [float(v) for part in vars(lab).values() for v in np.ravel(part)],
    ]
    told = [[f"{v:.9f}" for v in part] for part in numbers]
    return hashlib.sha256(repr(told).encode()).hexdigest()[:10]


def _render(plan: RigPlan, bare: bool, empty: Path, file: Path) -> None:
    import bpy
    from monocell.scene.stage import Stage

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    empty.parent.mkdir(parents=True, exist_ok=True)
    with Stage(WorkCell(plan.camera, lab=plan.lab)) as stage:
        if not empty.is_file():
            light = stage.linear(samples=BACKGROUND_SAMPLES)
            keep(empty, {"light": light.astype(np.float16)})
        kept: dict[str, np.ndarray] = {}
        for i in range(len(plan.positions)):
            keep_layers(kept, stage, i, _sighting(stage, plan, i, bare))
        keep(file, kept)


def keep_layers(
    kept: dict[str, np.ndarray], stage, i: int, layers: list[tuple[Window, int]]
) -> None:
    """Render windows, each with its samples, and name them as layers of sighting `i`."""
    kept[f"{i}.layers"] = np.array(len(layers))
    for k, (window, samples) in enumerate(layers):
        kept[f"{i}.{k}.corner"] = np.array(window[:2])
        kept[f"{i}.{k}"] = stage.window(window, samples=samples).astype(np.float16)


def kept_patches(kept, count: int) -> tuple[tuple[Patch, ...], ...]:
    """The layers of `count` sightings from a file."""
    return tuple(
        tuple(
            Patch(tuple(kept[f"{i}.{k}.corner"].tolist()), kept[f"{i}.{k}"])
            for k in range(int(kept[f"{i}.layers"]))
        )
        for i in range(count)
    )


def keep(file: Path, arrays: dict[str, np.ndarray]) -> None:
    with atomic_path(file) as temporary, temporary.open("wb") as stream:
        np.savez_compressed(stream, **arrays)


def _sighting(stage, plan: RigPlan, i: int, bare: bool) -> list[tuple[Window, int]]:
    """Put the ball there; the windows to render, coarse to fine, each with its samples."""
    flange = None if bare else plan.flanges[i]
    stage.move((), Ball(plan.positions[i], RADIUS, plan.ball_color, flange, plan.ball_roughness))
    things = plan.positions[i] + RADIUS * np.vstack([np.eye(3), -np.eye(3)])
    layers = []
    if not bare:
        corners = _gripper_corners(plan, i)
        things = np.concatenate([things, corners])
        pixels = plan.camera.project(corners)
        layers.append((window_around(plan, pixels, GRIPPER_MARGIN), GRIPPER_SAMPLES))
    shadow = shadow_window(stage.cell, plan, things)
    if shadow is not None:
        layers.insert(0, (shadow, SHADOW_SAMPLES))
    middle = plan.camera.pose.apply(plan.positions[i])
    outline = outline_pixels(plan.camera.intrinsics, middle, RADIUS)
    layers.append((window_around(plan, outline, BALL_MARGIN), BALL_SAMPLES))
    return layers


def _gripper_corners(plan: RigPlan, i: int) -> np.ndarray:
    parts = gripper_of(plan.positions[i], plan.flanges[i])
    return np.concatenate([corners_world(*part) for part in parts])


def shadow_window(cell: WorkCell, plan: RigPlan, things: np.ndarray) -> Window | None:
    """Where the shadow of points (N, 3) falls on the table, or on the floor where it misses it."""
    from monocell.scene.room import lamp_place

    lamp = lamp_place(cell)
    # a lamp of some size: the shadow reaches as far as that of its rim's nearest point
    half = 0.5 * plan.lab.lamp_size * np.vstack([np.eye(3)[:2], -np.eye(3)[:2]])
    fallen = [_fallen(cell, lamp + rim, things) for rim in half]
    pixels = plan.camera.project(np.concatenate(fallen))
    return window_around(plan, pixels, SHADOW_MARGIN)


def _fallen(cell: WorkCell, lamp: np.ndarray, things: np.ndarray) -> np.ndarray:
    """Where the shadows of points (N, 3) fall, (N, 3): on the table, or past it on the floor."""
    on = [
        lamp + ((lamp[2] - ground) / (lamp[2] - things[:, 2]))[:, None] * (things - lamp)
        for ground in (0.0, -cell.table.height)
    ]
    table = cell.table
    hit = (np.abs(on[0][:, :2] - table.centre) < table.size / 2).all(axis=1)
    return np.where(hit[:, None], on[0], on[1])


def window_around(plan: RigPlan, pixels: np.ndarray, margin: int) -> Window | None:
    """The whole pixels around (N, 2), within the picture; None when nothing is left."""
    size = np.array([plan.camera.intrinsics.width, plan.camera.intrinsics.height])
    seen = pixels[np.isfinite(pixels).all(axis=1)]
    if not len(seen):
        return None
    low = np.clip(np.floor(seen.min(axis=0)).astype(int) - margin, 0, size)
    high = np.clip(np.ceil(seen.max(axis=0)).astype(int) + margin + 1, 0, size)
    width, height = (high - low).tolist()
    return (int(low[0]), int(low[1]), width, height) if min(width, height) >= 4 else None


def main() -> None:
    """Fill the cache."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--family", choices=FAMILIES, default="varied")
    parser.add_argument("--rigs", type=int, default=40)
    parser.add_argument("--bare", action="store_true", help="the ball without its gripper")
    parser.add_argument("--cache", type=Path, default=CACHE)
    args = parser.parse_args()
    for seed in range(args.rigs):
        began = time.perf_counter()
        plan = random_plan(args.family, seed)
        rendered_rig(plan, bare=args.bare, cache=args.cache)
        progress(f"{plan.name}: {time.perf_counter() - began:.1f} s")


if __name__ == "__main__":
    main()
