# SPDX-License-Identifier: GPL-3.0-or-later
"""How alignment on edges converges from a rough model, on table tops rendered with Cycles.

    python benchmarks/align_convergence.py [--cells 30] [--first 24] [--pixels 8] [--share 0.15]

Every thing is put `--pixels` aside in the picture, turned until its corners are up to as far off
again, and each of its sizes is wrong by up to `--share`. `within 0.5 px` counts all that was tried,
believed or not: the rms distance of the true visible edges from those of the solution. `wrong and
believed` is the figure that has to be small. Of those believed, `in 95 %` is how often the truth
lies in the ellipsoid of 95 % that is stated. Cells 0 to 23 were used to choose the thresholds; the
others were not looked at before. `ms` is processor time.
"""

from __future__ import annotations

import argparse
import time
from collections import Counter
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from monocell.core.align.align import align
from monocell.core.align.freedom import Freedom
from monocell.core.align.refine import tangent
from monocell.core.align.result import AlignedObject
from monocell.core.camera import Camera
from monocell.core.modelling.solid import Solid
from monocell.core.picture.overlay import draw_overlay
from monocell.core.pose import Pose
from monocell.core.primitives import Primitive
from monocell.core.rotation import rotation_from_vector
from monocell.core.shape.curves import curves_seen
from monocell.headless.pictures import write_picture
from monocell.headless.told import progress, table
from rendered_rigs import CACHE
from rendered_tabletops import TABLE, rendered_tabletop
from tabletop_plans import TabletopPlan, random_tabletop

CONVERGED_PIXELS = 0.5
# chi squared that 95 % stay below, by the number of what is free
LIMITS = {4: 9.488, 6: 12.592}
SAMPLES, FINE_SAMPLES, FARTHEST = 24, 80, 50.0
MOST_TURN = 0.26


@dataclass(frozen=True, eq=False)
class Trial:
    """One thing: what is true of it, where it began, and what was found."""

    name: str
    pattern: str
    truth: Primitive
    start: Primitive
    told: AlignedObject
    camera: Camera

    @property
    def end(self) -> Primitive:
        """Where it was put, believed or not."""
        return self.start if self.told.tried is None else self.told.tried

    @property
    def off_pixels(self) -> float:
        return edge_distance(self.truth, self.end, self.camera)

    @property
    def inside(self) -> bool:
        """Whether the truth lies in the ellipsoid of 95 % of a believed solution."""
        solid = Solid.of(self.end)
        basis = Freedom.of(self.truth, [self.truth], {TABLE.name: TABLE}).basis(solid)
        back = np.linalg.pinv(basis)
        z = back @ tangent(solid, Solid.of(self.truth))
        covariance = back @ self.end.covariance @ back.T
        return float(z @ np.linalg.solve(covariance, z)) <= LIMITS[len(z)]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cells", type=int, default=30)
    parser.add_argument("--first", type=int, default=24)
    parser.add_argument("--pixels", type=float, default=8.0)
    parser.add_argument("--share", type=float, default=0.15)
    parser.add_argument("--overlays", type=Path, help="a folder for pictures before and after")
    parser.add_argument("--cache", type=Path, default=CACHE)
    args = parser.parse_args()
    trials, spent = [], 0.0
    for seed in range(args.first, args.first + args.cells):
        plan = random_tabletop(seed)
        done, seconds = _cell(plan, args)
        trials += done
        spent += seconds
        progress(f"{plan.name}: {sum(t.told.believed for t in done)} of {len(done)} believed")
    _report(trials, 1e3 * spent / len(trials))


def _cell(plan: TabletopPlan, args: argparse.Namespace) -> tuple[list[Trial], float]:
    rng = np.random.default_rng([77, plan.seed])
    starts = [rough(t, plan.camera, rng, args.pixels, args.share) for t in plan.things]
    picture = rendered_tabletop(plan, args.cache).picture()
    began = time.process_time()
    aligned = align(starts, plan.camera, picture, [TABLE])
    seconds = time.process_time() - began
    if args.overlays:
        args.overlays.mkdir(parents=True, exist_ok=True)
        for label, things in (("before", starts), ("after", aligned.things)):
            overlay = draw_overlay(picture, plan.camera, things)
            write_picture(args.overlays / f"{plan.name}-{label}.png", overlay)
    trials = [
        Trial(t.name, look.pattern, t, start, aligned.objects[t.name], plan.camera)
        for t, look, start in zip(plan.things, plan.looks, starts, strict=True)
    ]
    return trials, seconds


def rough(
    thing: Primitive, camera: Camera, rng: np.random.Generator, pixels: float, share: float
) -> Primitive:
    """The thing as a hurried hand would leave it, standing on the table."""
    solid = Solid.of(thing)
    foot = solid.place - [0.0, 0.0, solid.parameters[-1] / 2]
    step = 1e-4
    by = [(camera.project([foot + step * e]) - camera.project([foot]))[0] for e in np.eye(3)[:2]]
    way = rng.uniform(0, 2 * np.pi)
    aside = np.linalg.solve(np.array(by).T / step, pixels * np.array([np.cos(way), np.sin(way)]))
    parameters = solid.parameters * (1 + rng.uniform(-share, share, len(solid.parameters)))
    extent = np.ptp(camera.project(_corners(thing)), axis=0).max()
    turn = np.clip(rng.uniform(-1, 1) * 2 * pixels / extent, -MOST_TURN, MOST_TURN)
    place = np.array([*(foot[:2] + aside), parameters[-1] / 2])
    rotation = rotation_from_vector([0, 0, turn]) @ solid.rotation
    return Solid(thing.kind, rotation, place, parameters).applied(thing)


def edge_distance(truth: Primitive, found: Primitive, camera: Camera) -> float:
    """How far the true visible edges lie from the same edges of another solution, rms pixels.

    A box that is turned by right angles is the same box.
    """
    return min(_edge_distance(turned, found, camera) for turned in _turned(truth))


def _turned(thing: Primitive) -> list[Primitive]:
    if thing.kind != "box":
        return [thing]
    turns = []
    for quarter in range(4):
        turn = Pose(rotation_from_vector([0, 0, quarter * np.pi / 2]), np.zeros(3))
        size = thing.sizes[[1, 0, 2]] if quarter % 2 else thing.sizes
        turned = replace(thing, world_from_object=thing.world_from_object @ turn, covariance=None)
        turns.append(turned.with_parameters(size))
    return turns


def _edge_distance(truth: Primitive, found: Primitive, camera: Camera) -> float:
    true, other = curves_seen(truth, camera), curves_seen(found, camera)
    lines = [
        (other.names[i], _pixels(found, other, i, FINE_SAMPLES, camera))
        for i in np.flatnonzero(other.visible)
    ]
    squares = []
    for i in np.flatnonzero(true.visible):
        at = _pixels(truth, true, i, SAMPLES, camera)[1:-1]
        nearest = np.full(len(at), FARTHEST)
        for name, line in lines:
            if name == true.names[i]:
                nearest = np.minimum(nearest, _to_line(at, line))
        squares.append(nearest**2)
    return float(np.sqrt(np.concatenate(squares).mean()))


def _pixels(thing: Primitive, curves, i: int, count: int, camera: Camera) -> np.ndarray:
    one = curves.chosen(np.array([i]))
    t = np.linspace(*curves.ends[i], count)[:, None]
    return camera.project(thing.world_from_object.apply(one.points(t)[:, 0]))


def _to_line(points: np.ndarray, line: np.ndarray) -> np.ndarray:
    start, way = line[:-1], np.diff(line, axis=0)
    length = np.maximum((way**2).sum(axis=1), 1e-12)
    share = np.clip(((points[:, None] - start) * way).sum(axis=2) / length, 0, 1)
    foot = start + share[..., None] * way
    return np.linalg.norm(points[:, None] - foot, axis=2).min(axis=1)


def _corners(thing: Primitive) -> np.ndarray:
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    return thing.world_from_object.apply(signs * thing.half_extent)


def _report(trials: list[Trial], milliseconds: float) -> None:
    off = np.array([t.off_pixels for t in trials])
    before = np.array([edge_distance(t.truth, t.start, t.camera) for t in trials])
    believed = np.array([t.told.believed for t in trials])
    near = off < CONVERGED_PIXELS
    print(f"{len(trials)} things, {milliseconds:.0f} ms each")
    print(f"median distance of the edges: {np.median(before):.2f} px before")
    print(f"within 0.5 px: {100 * near.mean():.1f} %, within 1 px {100 * (off < 1).mean():.1f} %")
    print(f"believed: {100 * believed.mean():.1f} %; refused {100 * (~believed).mean():.1f} %")
    wrong = (believed & ~near).sum(), (believed & (off > 1)).sum()
    print(f"wrong and believed: {wrong[0]} beyond 0.5 px, {wrong[1]} beyond 1 px")
    rows = [_row("begun", [(t.truth, t.start) for t in trials], before)]
    rows.append(_row("tried", [(t.truth, t.end) for t in trials], off))
    sure = [t for t in trials if t.told.believed]
    rows.append(_row("believed", [(t.truth, t.end) for t in sure], off[believed]))
    print(table(("median", "edges px", "size %", "place mm"), rows))
    if sure:
        print(f"in 95 %: {100 * np.mean([t.inside for t in sure]):.1f} % of the believed")
    _by_pattern(trials, near, believed)
    reasons = Counter(_kind_of(reason) for t in trials for reason in t.told.reasons)
    for reason, count in reasons.most_common(8):
        print(f"  {count:4} {reason}")


def _by_pattern(trials: list[Trial], near: np.ndarray, believed: np.ndarray) -> None:
    patterns = np.array([t.pattern for t in trials])
    rows = []
    for pattern in sorted(set(patterns)):
        those = patterns == pattern
        rows.append(
            (
                pattern,
                str(those.sum()),
                f"{100 * near[those].mean():.0f} %",
                f"{100 * believed[those].mean():.0f} %",
            )
        )
    print(table(("pattern", "things", "within 0.5 px", "believed"), rows))


def _row(label: str, pairs: list[tuple[Primitive, Primitive]], off: np.ndarray) -> tuple[str, ...]:
    if not pairs:
        return (label, "-", "-", "-")
    sizes = np.concatenate([np.abs(end.sizes / truth.sizes - 1) for truth, end in pairs])
    places = [
        np.linalg.norm(end.world_from_object.translation - truth.world_from_object.translation)
        for truth, end in pairs
    ]
    return (
        label,
        f"{np.median(off):.3f}",
        f"{100 * np.median(sizes):.2f}",
        f"{1e3 * np.median(places):.2f}",
    )


def _kind_of(reason: str) -> str:
    return "".join("#" if c.isdigit() else c for c in reason)[:60]


if __name__ == "__main__":
    main()
