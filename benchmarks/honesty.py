# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether the stated error holds the truth, over rendered rigs each photographed by another camera.

    python benchmarks/honesty.py [--rigs 42] [--cache FOLDER]

Every rig is a different mix of light, background, ball colour, occlusion and lens (`rig_plans.py`,
family varied), blur, shake, noise and JPEG (`photographs.py`). Printed: by verdict how many, how
often the truth lies in the 95 % ellipsoid and the largest error, in sigmas of equal improbability;
how often the truth lies in other ellipsoids; and each rig, the worst first, to look at with
`inspect_rig.py`. What is refused is counted.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from monocell.headless.told import progress, table
from photographs import random_development
from rendered_rigs import CACHE, rendered_rig
from rig_plans import random_plan
from rig_scores import VERDICTS, Score, score_rig

LEVELS = (0.50, 0.68, 0.90, 0.95, 0.99)


def main() -> None:
    """Print three tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rigs", type=int, default=42)
    parser.add_argument("--first", type=int, default=0, help="seed of the first rig")
    parser.add_argument("--cache", type=Path, default=CACHE)
    args = parser.parse_args()
    scores = []
    for seed in range(args.first, args.first + args.rigs):
        rig = rendered_rig(random_plan("varied", seed), cache=args.cache)
        scores.append(score_rig(rig, random_development(seed)))
        progress(f"{rig.plan.name}: {scores[-1].verdict}")
    solved = [score for score in scores if score.verdict != "refused"]
    print(table(VERDICT_HEADER, _by_verdict(scores)))
    print()
    print(table(("ellipsoid of", "holds the truth of", "of those called good"), _curve(solved)))
    print()
    print(table(RIG_HEADER, [_told(score) for score in sorted(scores, key=_worst_first)]))


VERDICT_HEADER = ("verdict", "rigs", "in 95 %", "largest sigmas", "median mm", "max mm",
                  "median deg", "max deg")  # fmt: skip
RIG_HEADER = ("rig", "sigmas", "mm", "deg", "used", "verdict", "pictures", "why")


def _by_verdict(scores: Sequence[Score]) -> list[tuple[str, ...]]:
    groups = [(v, [s for s in scores if s.verdict == v]) for v in VERDICTS]
    groups.append(("all but failed", [s for s in scores if s.verdict in ("good", "weak")]))
    groups.append(("all solved", [s for s in scores if s.verdict != "refused"]))
    return [_group(name, group) for name, group in groups]


def _group(name: str, scores: Sequence[Score]) -> tuple[str, ...]:
    if not scores or scores[0].verdict == "refused":
        return (name, str(len(scores)), *[""] * 6)
    place = 1e3 * np.array([s.place for s in scores])
    turn = np.degrees([s.turn for s in scores])
    return (
        name,
        str(len(scores)),
        f"{100 * np.mean([s.probability < 0.95 for s in scores]):.0f} %",
        f"{max(s.sigmas for s in scores):.1f}",
        *(f"{v:.2f}" for v in (np.median(place), place.max())),
        *(f"{v:.4f}" for v in (np.median(turn), turn.max())),
    )


def _curve(solved: Sequence[Score]) -> list[tuple[str, ...]]:
    good = [s for s in solved if s.verdict == "good"]
    rows = []
    for level in LEVELS:
        shares = [
            f"{100 * np.mean([s.probability < level for s in part]):.0f} %" if part else ""
            for part in (solved, good)
        ]
        rows.append((f"{100 * level:.0f} %", *shares))
    return rows


def _worst_first(score: Score) -> float:
    return float("inf") if score.verdict == "refused" else -score.sigmas


def _told(score: Score) -> tuple[str, ...]:
    why = score.reason if len(score.reason) < 90 else score.reason[:87] + "..."
    if score.verdict == "refused":
        return (score.rig, "", "", "", "", score.verdict, score.pictures, why)
    return (
        score.rig,
        f"{score.sigmas:.1f}",
        f"{1e3 * score.place:.2f}",
        f"{np.degrees(score.turn):.4f}",
        str(score.used),
        score.verdict,
        score.pictures,
        why,
    )


if __name__ == "__main__":
    main()
