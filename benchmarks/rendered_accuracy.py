# SPDX-License-Identifier: GPL-3.0-or-later
"""Calibration error on pictures rendered with Cycles, in three classes of pictures.

    python benchmarks/rendered_accuracy.py [--rigs 20] [--cache FOLDER]

40 mm ball, 5-8 positions, camera 2-3 m away, f about 1200 px; random light, colours and textures.
For each class: median, 90 % and largest error of the camera's place and turn, how often the truth
lies in the stated 95 % ellipsoid, and the median error in place of the baselines on the same
outlines. What is refused, or solved with the verdict `failed`, is counted and in no other figure.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
from monocell.headless.told import table
from photographs import Development
from rendered_rigs import CACHE, rendered_rig
from rig_plans import random_plan
from rig_scores import BASELINES, Score, score_rig

CLEAN = Development(blur_pixels=0.5, noise_grey_levels=1.0)
NOISY = Development(blur_pixels=0.8, noise_grey_levels=4.0, jpeg_quality=80)
SMALL = Development(blur_pixels=0.5, noise_grey_levels=4.0, jpeg_quality=80, halved=True)
# name, what the camera makes of the light, without a gripper, millimetres and degrees aimed at
CLASSES = {
    "clean, ball alone": (CLEAN, True, 0.3, 0.006),
    "clean, gripper": (CLEAN, False, 0.3, 0.006),
    "noise 4, blur 0.8, JPEG 80, gripper": (NOISY, False, 1.0, 0.02),
    "640x480, ball of 9 px, noise 4, JPEG 80": (SMALL, False, 2.5, 0.04),
}
HEADER = ("rigs", "refused", "failed", "weak", "mm", "90 %", "max", "deg", "90 %", "max", "in 95 %",
          *(f"{name} mm" for name in BASELINES))  # fmt: skip


def main() -> None:
    """Print one row a class, then what each rig did."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rigs", type=int, default=20)
    parser.add_argument("--classes", help="only classes whose name contains this")
    parser.add_argument("--each", action="store_true", help="also print every rig")
    parser.add_argument("--cache", type=Path, default=CACHE)
    args = parser.parse_args()
    rows, each = [], []
    for name, (how, bare, millimetres, degrees) in CLASSES.items():
        if args.classes and args.classes not in name:
            continue
        rigs = (
            rendered_rig(random_plan("plain", seed), bare=bare, cache=args.cache)
            for seed in range(args.rigs)
        )
        scores = [score_rig(rig, how, baselines=True) for rig in rigs]
        rows.append((name, *_figures(scores), f"{millimetres:g} / {degrees:g}"))
        each += [(name, *_told(score)) for score in scores]
    print(table(("pictures", *HEADER, "aim mm / deg"), rows))
    if args.each:
        print()
        print(table(("pictures", "rig", "ball", "verdict", "used", "mm", "deg", "sigmas"), each))


def _figures(scores: list[Score]) -> tuple[str, ...]:
    solved = [score for score in scores if score.verdict in ("good", "weak")]
    counts = [
        sum(s.verdict == verdict for s in scores) for verdict in ("refused", "failed", "weak")
    ]
    if not solved:
        return (str(len(scores)), *map(str, counts), *[""] * (len(HEADER) - 4))
    place = 1e3 * np.array([score.place for score in solved])
    turn = np.degrees([score.turn for score in solved])
    within = np.mean([score.probability < 0.95 for score in solved])
    return (
        str(len(scores)),
        *map(str, counts),
        *(f"{v:.2f}" for v in (np.median(place), np.quantile(place, 0.9), place.max())),
        *(f"{v:.4f}" for v in (np.median(turn), np.quantile(turn, 0.9), turn.max())),
        f"{100 * within:.0f} %",
        *(f"{1e3 * np.nanmedian([s.baselines[b][0] for s in solved]):.1f}" for b in BASELINES),
    )


def _told(score: Score) -> tuple[str, ...]:
    ball = score.pictures.split(",")[0]
    if score.verdict == "refused":
        return (score.rig, ball, score.reason[:60], "", "", "", "")
    figures = (f"{1e3 * score.place:.2f}", f"{np.degrees(score.turn):.4f}", f"{score.sigmas:.1f}")
    return (score.rig, ball, score.verdict, str(score.used), *figures)


if __name__ == "__main__":
    main()
