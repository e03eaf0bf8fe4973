# SPDX-License-Identifier: GPL-3.0-or-later
"""Table tops rendered once with Cycles and kept: a plan in, its linear light and pictures out.

    python benchmarks/rendered_tabletops.py [--cells 60] [--first 0] [--cache FOLDER]

A table top is one file of linear light with its truth as a cell document beside it. Blur, noise and
encoding are added afterwards, so that one rendering serves many cameras.
"""

from __future__ import annotations

import argparse
import hashlib
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from monocell.core.cell import Cell
from monocell.core.document.cell_file import write_cell
from monocell.core.primitives import Cylinder
from monocell.core.reference import ReferencePlane
from monocell.headless.told import progress
from monocell.scene.work_cell import WorkCell
from photographs import Development, as_file_gives, developed
from rendered_rigs import CACHE, keep
from tabletop_plans import Look, TabletopPlan, random_tabletop

SAMPLES = 16
# a can of so many facets is within 2 um of a round one
FACETS = 512
# of the light this share stays below this part of white
SPARED, WHITE = 0.995, 0.97
# a new number makes all table tops be rendered again
EDITION = 1
TABLE = ReferencePlane("table", np.zeros(3), np.array([0.0, 0.0, 1.0]))
USUAL = Development(blur_pixels=0.5, noise_grey_levels=2.0, jpeg_quality=92)


@dataclass(frozen=True, eq=False)
class RenderedTabletop:
    """A plan and its light (H, W, 3), linear, red green blue."""

    plan: TabletopPlan
    light: np.ndarray

    def picture(self, how: Development = USUAL) -> np.ndarray:
        """What a camera makes of it, (H, W, 3) 8 bits, blue green red, as read from its file."""
        light = self.light.astype(np.float32)
        gain = self.plan.exposure / float(np.median(light.mean(axis=2)))
        brightest = float(np.quantile(light.max(axis=2), SPARED))
        gain = min(gain, WHITE / brightest)
        return as_file_gives(developed(light, gain, how, (self.plan.seed, 101)), how)

    def truth(self) -> Cell:
        """The cell as it is, with nothing picked."""
        return Cell(self.plan.camera, references=(TABLE,), objects=self.plan.things)


def rendered_tabletop(plan: TabletopPlan, cache: Path = CACHE) -> RenderedTabletop:
    """The table top from the cache, or rendered now and put there."""
    file = cache / f"{plan.name}-{digest_of(plan)}.npz"
    if not file.is_file():
        cache.mkdir(parents=True, exist_ok=True)
        keep(file, {"light": _light(plan).astype(np.float16)})
        write_cell(RenderedTabletop(plan, np.zeros(0)).truth(), file.with_suffix(".cell.json"))
    with np.load(file) as kept:
        return RenderedTabletop(plan, kept["light"])


def digest_of(plan: TabletopPlan) -> str:
    """Of all that shows in the picture, to nine digits: processors differ in the last."""
    lens = plan.camera.intrinsics
    numbers = [
        [EDITION, lens.fx, lens.fy, lens.cx, lens.cy, *lens.distortion.coefficients],
        [*plan.camera.pose.matrix().ravel()],
        [float(v) for t in plan.things for v in (*t.world_from_object.matrix().ravel(), *t.sizes)],
        [float(v) for t in plan.things for v in t.appearance.color],
        [float(v) for look in plan.looks for v in (look.roughness, look.scale, *look.second)],
        [float(v) for part in vars(plan.lab).values() for v in np.ravel(part)],
    ]
    told = [[f"{v:.9f}" for v in part] for part in numbers]
    told.append([look.pattern for look in plan.looks])
    return hashlib.sha256(repr(told).encode()).hexdigest()[:10]


def _light(plan: TabletopPlan) -> np.ndarray:
    import bpy
    from monocell.scene.stage import Stage

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with Stage(WorkCell(plan.camera, plan.things, lab=plan.lab)) as stage:
        paint(stage.scene, plan)
        return stage.linear(samples=SAMPLES)


def paint(scene: Any, plan: TabletopPlan) -> None:
    """Give each thing of the plan its look, and the cans as many facets as truth needs."""
    from monocell.core.shape.tessellation import cylinder
    from monocell.scene.meshes import fill_mesh

    for thing, look in zip(plan.things, plan.looks, strict=True):
        ob = scene.objects[thing.name]
        if isinstance(thing, Cylinder):
            fill_mesh(ob.data, cylinder(thing.radius, thing.height, FACETS))
        _paint(ob.data.materials[0], thing.appearance.color, look)


def _paint(material: Any, color: np.ndarray, look: Look) -> None:
    from monocell.scene.materials import shader_of

    shader = shader_of(material)
    shader.inputs["Roughness"].default_value = look.roughness
    if look.pattern == "plain":
        return
    nodes, links = material.node_tree.nodes, material.node_tree.links
    mix = nodes.new("ShaderNodeMix")
    mix.data_type = "RGBA"
    mix.inputs[6].default_value, mix.inputs[7].default_value = (*color, 1.0), (*look.second, 1.0)
    links.new(_pattern(nodes, links, look), mix.inputs[0])
    links.new(mix.outputs[2], shader.inputs["Base Color"])


def _pattern(nodes: Any, links: Any, look: Look) -> Any:
    """The output, 0 or 1, of a pattern in the thing's own frame."""
    place = nodes.new("ShaderNodeTexCoord").outputs["Object"]
    if look.pattern == "speckles":
        noise = nodes.new("ShaderNodeTexNoise")
        noise.inputs["Scale"].default_value = 1.0 / look.scale
        links.new(place, noise.inputs["Vector"])
        return _above(nodes, links, noise.outputs[0], 0.55)
    if look.pattern == "checker":
        checker = nodes.new("ShaderNodeTexChecker")
        checker.inputs["Scale"].default_value = 1.0 / look.scale
        # a square must not begin just on a face, where it would flicker
        shift = nodes.new("ShaderNodeVectorMath")
        shift.inputs[1].default_value = (0.0031, 0.0047, 0.0059)
        links.new(place, shift.inputs[0])
        links.new(shift.outputs[0], checker.inputs["Vector"])
        return checker.outputs["Fac"]
    apart = nodes.new("ShaderNodeSeparateXYZ")
    links.new(place, apart.inputs[0])
    if look.pattern == "halves":
        return _above(nodes, links, apart.outputs["Z"], 0.01)
    wave = nodes.new("ShaderNodeMath")
    wave.operation, wave.inputs[1].default_value = "PINGPONG", 2 * look.scale
    links.new(apart.outputs["Z"], wave.inputs[0])
    return _above(nodes, links, wave.outputs[0], look.scale)


def _above(nodes: Any, links: Any, value: Any, level: float) -> Any:
    step = nodes.new("ShaderNodeMath")
    step.operation, step.inputs[1].default_value = "GREATER_THAN", level
    links.new(value, step.inputs[0])
    return step.outputs[0]


def main() -> None:
    """Fill the cache."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cells", type=int, default=60)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--cache", type=Path, default=CACHE)
    args = parser.parse_args()
    for seed in range(args.first, args.first + args.cells):
        began = time.perf_counter()
        plan = random_tabletop(seed)
        rendered_tabletop(plan, args.cache)
        progress(f"{plan.name}: {time.perf_counter() - began:.1f} s")


if __name__ == "__main__":
    main()
