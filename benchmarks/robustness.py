# SPDX-License-Identifier: GPL-3.0-or-later
"""How finding a ball bears what pictures do to it: found, refused, or wrong, over many pictures.

python benchmarks/robustness.py [--seeds N] [--window] [--condition NAME ...] [--list]
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from hard_pictures import CONDITIONS, NO_BALL, Shot, conditions_of
from monocell.core.ball.find import find_sphere
from monocell.core.ball.outline import SphereOutline
from monocell.core.errors import SphereNotFound
from monocell.headless.told import table

# a wrong answer is off by more sigmas, or by more of the distance and more pixels aside
SIGMAS, DEPTH_SHARE, ASIDE_PIXELS = 5.0, 0.1, 1.0
HEADER = (
    "condition",
    "pictures",
    "found %",
    "elsewhere",
    "over 5 sigma",
    "refused",
    "warned",
    "aside px",
    "depth %",
    "rms z",
    "ms",
)


@dataclass(frozen=True)
class Outcome:
    """What became of one picture: pixels aside, depth as a share, sigmas off in three numbers."""

    seed: int
    refusal: str = ""
    aside_pixels: float = np.nan
    depth: float = np.nan
    sigmas: float = np.nan
    warnings: tuple[str, ...] = ()
    seconds: float = 0.0

    @property
    def elsewhere(self) -> bool:
        return self.depth > DEPTH_SHARE or self.aside_pixels > 10 * ASIDE_PIXELS

    @property
    def overconfident(self) -> bool:
        return not self.elsewhere and self.sigmas > SIGMAS


def main() -> None:
    """Try every condition and print a line of each."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=40)
    parser.add_argument("--window", action="store_true", help="look in a window around the ball")
    parser.add_argument("--condition", nargs="+", default=[*CONDITIONS, *NO_BALL])
    parser.add_argument("--list", action="store_true", help="name the seeds that went wrong")
    args = parser.parse_args()
    rows, faults = [], []
    for name in conditions_of(args.condition):
        outcomes = [_tried(CONDITIONS[name], seed, args.window) for seed in range(args.seeds)]
        rows.append(_row(name, outcomes))
        faults += [f"{name}, seed {o.seed}: {_fault(o)}" for o in outcomes if _fault(o)]
    print(table(HEADER, rows))
    for name in (n for n in args.condition if n in NO_BALL):
        told = [_believed(NO_BALL[name], seed) for seed in range(args.seeds)]
        marked = sum(t == "warned" for t in told)
        believed = [seed for seed, t in enumerate(told) if t == "believed"]
        print(f"{name}: {args.seeds} pictures, {marked} found with a warning, ", end="")
        print(f"{len(believed)} found without {believed or ''}")
    if args.list:
        print("\n".join(faults))


def _tried(shot_of: Callable[[int], Shot], seed: int, in_window: bool) -> Outcome:
    shot = shot_of(seed)
    began = time.perf_counter()
    try:
        outline = find_sphere(
            shot.picture, shot.intrinsics, shot.ball.radius, shot.window if in_window else None
        )
    except SphereNotFound as error:
        return Outcome(seed, str(error), seconds=time.perf_counter() - began)
    return _held_against(shot, seed, outline, time.perf_counter() - began)


def _held_against(shot: Shot, seed: int, outline: SphereOutline, seconds: float) -> Outcome:
    truth = np.array(shot.ball.centre_camera)
    error = outline.centre_camera - truth
    distance = float(np.linalg.norm(truth))
    both = np.stack(
        [outline.centre_camera * distance / np.linalg.norm(outline.centre_camera), truth]
    )
    pixels = shot.intrinsics.project(both)
    return Outcome(
        seed,
        "",
        float(np.linalg.norm(pixels[1] - pixels[0])),
        abs(float(np.linalg.norm(outline.centre_camera)) / distance - 1),
        float(np.sqrt(error @ np.linalg.solve(outline.covariance, error))),
        outline.warnings,
        seconds,
    )


def _row(name: str, outcomes: list[Outcome]) -> tuple[str, ...]:
    seen = [o for o in outcomes if not o.refusal]
    right = [o for o in seen if not o.elsewhere]
    middle = [
        f"{factor * np.median([getattr(o, value) for o in right]) if right else np.nan:.{digits}f}"
        for value, factor, digits in (("aside_pixels", 1, 3), ("depth", 100, 3))
    ]
    spread = np.sqrt(np.mean([o.sigmas**2 for o in right]) / 3) if right else np.nan
    return (
        name,
        str(len(outcomes)),
        f"{100 * len(right) / len(outcomes):.0f}",
        str(sum(o.elsewhere and not o.warnings for o in seen)),
        str(sum(o.overconfident and not o.warnings for o in seen)),
        str(sum(bool(o.refusal) for o in outcomes)),
        str(sum(bool(o.warnings) for o in seen)),
        *middle,
        f"{spread:.2f}",
        f"{1e3 * np.median([o.seconds for o in outcomes]):.0f}",
    )


def _fault(outcome: Outcome) -> str:
    if outcome.refusal:
        return f"refused: {outcome.refusal}"
    if outcome.elsewhere or outcome.overconfident:
        told = "; ".join(outcome.warnings) or "no warning"
        return (
            f"{outcome.aside_pixels:.2f} px aside, {100 * outcome.depth:.2f} % deep, "
            f"{outcome.sigmas:.1f} sigmas ({told})"
        )
    return ""


def _believed(shot_of: Callable[[int], Shot], seed: int) -> str:
    shot = shot_of(seed)
    try:
        outline = find_sphere(shot.picture, shot.intrinsics, shot.ball.radius)
    except SphereNotFound:
        return "refused"
    return "warned" if outline.warnings else "believed"


if __name__ == "__main__":
    main()
