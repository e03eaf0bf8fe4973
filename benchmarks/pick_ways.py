# SPDX-License-Identifier: GPL-3.0-or-later
"""Every way of picking every kind, on random objects: how often the right answer, how good, how soon.

    python benchmarks/pick_ways.py [--objects 500] [--sigma 1] [--only cylinder]

`right` ends where a fit that starts from the truth ends; `other` fits the same picks no worse
elsewhere (they can't tell), `wrong` is worse or nothing. `size` is the median error of all sizes in
percent, `covered` how often the 95 % ellipsoid of the solved sizes holds the true ones.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import dataclass

import numpy as np
from monocell.core.errors import MonocellError
from monocell.core.modelling.model_fit import ModelFit, fit_model
from monocell.core.modelling.pick_equations import pick_observer
from monocell.core.modelling.pick_visibility import hidden_picks
from monocell.core.modelling.starts.start import Starts, start
from monocell.core.primitives import Primitive
from monocell.headless.told import progress, table
from pick_scenes import REFERENCES, NotSeen, Task
from pick_way_table import WAYS, Way

# fits within this much chi squared of the best fit as well
ALIKE = 4.0
SHOWN = True
SAME_SHARE = 1e-3


@dataclass(frozen=True)
class Outcome:
    """What became of one object: right, other or wrong, with its errors."""

    verdict: str
    seconds: float
    size_errors: tuple[float, ...] = ()
    covered: bool = False
    starts: int = 0
    told: str = ""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--objects", type=int, default=500)
    parser.add_argument("--sigma", type=float, default=1.0)
    parser.add_argument("--only", default="")
    parser.add_argument("--show", action="store_true", help="print why an answer is not right")
    args = parser.parse_args()
    rows = []
    for way in WAYS:
        if args.only in way.name:
            progress(way.name)
            outcomes = [_outcome(way, i, args.sigma) for i in range(args.objects)]
            rows.append(_row(way, outcomes))
            if args.show:
                for i, o in enumerate(outcomes):
                    if o.verdict != "right":
                        print(f"  {i}: {o.verdict} {o.told}")
    heads = (
        "way",
        "right %",
        "other %",
        "wrong %",
        "size %",
        "covered %",
        "starts",
        "ms",
        "95 % ms",
    )
    print(table(heads, rows))


def _row(way: Way, outcomes: list[Outcome]) -> tuple[str, ...]:
    def share(name: str) -> str:
        return f"{100 * sum(o.verdict == name for o in outcomes) / len(outcomes):.1f}"

    errors = [e for o in outcomes for e in o.size_errors]
    solved = [o for o in outcomes if o.starts]
    times = 1e3 * np.array([o.seconds for o in outcomes])
    return (
        way.name,
        share("right"),
        share("other"),
        share("wrong"),
        f"{100 * np.median(errors):.2f}" if errors else "-",
        f"{100 * np.mean([o.covered for o in solved]):.1f}",
        f"{np.mean([o.starts for o in solved]):.1f}",
        f"{np.median(times):.1f}",
        f"{np.percentile(times, 95):.1f}",
    )


def _outcome(way: Way, seed: int, sigma: float) -> Outcome:
    rng = np.random.default_rng([seed, sum(map(ord, way.name))])
    task = _task(way, rng)
    sketch = task.sketch(rng, sigma)
    began = time.perf_counter()
    try:
        starts = start(task.camera, sketch, REFERENCES, task.things, sigma)
        fitted = _fitted(task, starts)
    except MonocellError as error:
        return Outcome("wrong", time.perf_counter() - began, told=str(error))
    seconds = time.perf_counter() - began
    ideal = _fit(task, task.scene_truth(), starts)
    if fitted is None:
        return Outcome("wrong", seconds, told="no fit")
    return _judged(task, fitted, ideal, seconds, len(starts.things))


def _judged(
    task: Task, fitted: ModelFit, ideal: ModelFit | None, seconds: float, starts: int
) -> Outcome:
    thing = fitted.objects["it"].thing
    verdict = "right"
    told = ""
    if ideal is not None and not _same(thing, ideal.objects["it"].thing):
        alike = fitted.chi_squared <= ideal.chi_squared + ALIKE
        verdict = "other" if alike else "wrong"
        told = f"chi {fitted.chi_squared:.1f} ({ideal.chi_squared:.1f}) {thing.sizes} {task.truth.sizes}"
    errors, covered = (), True
    free = [i for i, name in enumerate(thing.size_names) if name not in thing.known]
    if free:
        off = (thing.sizes - task.truth.sizes)[free]
        errors = tuple(np.abs(off) / task.truth.sizes[free])
        part = thing.covariance[6:, 6:][np.ix_(free, free)]
        covered = float(off @ np.linalg.pinv(part) @ off) <= _chi_squared_95(len(free))
    return Outcome(verdict, seconds, errors, covered, starts, told)


def _task(way: Way, rng: np.random.Generator) -> Task:
    while True:
        try:
            return way.make(rng)
        except NotSeen:
            continue


def _fitted(task: Task, starts: Starts) -> ModelFit | None:
    """Of the fits from all starts the best, and among those as good one that hides no picks."""
    fits = [fit for thing in starts.things if (fit := _fit(task, thing, starts)) is not None]
    if not fits:
        return None
    least = min(fit.chi_squared for fit in fits)
    good = [fit for fit in fits if fit.chi_squared <= least + ALIKE]
    if len(good) == 1:
        return good[0]
    return min(
        good,
        key=lambda f: (
            len(hidden_picks(f.objects["it"].thing, task.camera, starts.plan)),
            f.chi_squared,
        ),
    )


def _fit(task: Task, thing: Primitive, starts: Starts) -> ModelFit | None:
    things = [*task.things.values(), _named(thing)]
    try:
        return fit_model(
            task.camera, REFERENCES, things, pick_observer({"it": starts.plan}), ["it"]
        )
    except MonocellError as error:
        if SHOWN:
            print("   ", error)
        return None


def _named(thing: Primitive) -> Primitive:
    object.__setattr__(thing, "name", "it")
    return thing


def _same(one: Primitive, other: Primitive) -> bool:
    scale = SAME_SHARE * float(np.abs(other.sizes).max())
    places = one.world_from_object.translation - other.world_from_object.translation
    return bool(np.abs(places).max() < scale and np.abs(one.sizes - other.sizes).max() < scale)


def _chi_squared_95(count: int) -> float:
    """Wilson and Hilferty's approximation, good to half a percent."""
    return float(count * (1 - 2 / (9 * count) + 1.6449 * np.sqrt(2 / (9 * count))) ** 3)


if __name__ == "__main__":
    main()
