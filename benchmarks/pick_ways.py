# SPDX-License-Identifier: GPL-3.0-or-later
"""Every way of picking every kind, on random objects: how often right, how good, how soon.

    python benchmarks/pick_ways.py [--objects 500] [--sigma 1] [--only cylinder]

`right` ends where a fit that starts from the truth ends, or lower beside it; `other` fits the same
picks no worse elsewhere (they can't tell), `wrong` is worse or nothing. `size` is the median error
of all sizes in percent, `covered` how often the 95 % ellipsoid of the solved sizes holds the true
ones. `untold` are answers that are not right and have no word of a rival. `ms` are milliseconds of
the processor for the whole of it: reading, all starts, all fits, the choice.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import dataclass

import numpy as np
from monocell.core.errors import MonocellError
from monocell.core.modelling.candidates import Chosen, choose
from monocell.core.modelling.model_fit import FittedObject, fit_model
from monocell.core.modelling.pick_equations import pick_observer
from monocell.core.primitives import Primitive
from monocell.headless.told import progress, table
from pick_scenes import REFERENCES, NotSeen, Task
from pick_way_table import WAYS, Way

# fits within this much chi squared of the best fit as well
ALIKE = 4.0
SAME_SHARE = 1e-3
HEADS = ("way", "right %", "other %", "wrong %", "size %", "covered %", "untold", "ms", "95 % ms")
# of a normal distribution, one side: 99.9 %
SURE = 3.0902


@dataclass(frozen=True)
class Outcome:
    """What became of one object: right, other or wrong, with its errors."""

    verdict: str
    seconds: float
    size_errors: tuple[float, ...] = ()
    covered: bool = False
    warned: bool = False
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
            outcomes = [_outcome(way, i, args.sigma) for i in range(args.objects)]
            rows.append(_row(way, outcomes))
            progress("  ".join(rows[-1]))
            if args.show:
                for i, o in enumerate(outcomes):
                    if o.verdict != "right":
                        print(f"  {i}: {o.verdict} {o.told}")
    print(table(HEADS, rows))


def _row(way: Way, outcomes: list[Outcome]) -> tuple[str, ...]:
    def share(name: str) -> str:
        return f"{100 * sum(o.verdict == name for o in outcomes) / len(outcomes):.1f}"

    errors = [e for o in outcomes for e in o.size_errors]
    solved = [o for o in outcomes if o.size_errors or o.verdict == "right"]
    lost = [o for o in outcomes if o.verdict != "right"]
    times = 1e3 * np.array([o.seconds for o in outcomes])
    return (
        way.name,
        share("right"),
        share("other"),
        share("wrong"),
        f"{100 * np.median(errors):.2f}" if errors else "-",
        f"{100 * np.mean([o.covered for o in solved]):.1f}",
        f"{sum(not o.warned and bool(o.size_errors) for o in lost)}",
        f"{np.median(times):.1f}",
        f"{np.percentile(times, 95):.1f}",
    )


def _outcome(way: Way, seed: int, sigma: float) -> Outcome:
    rng = np.random.default_rng([seed, sum(map(ord, way.name))])
    task = _task(way, rng)
    sketch = task.sketch(rng, sigma)
    began = time.process_time()
    try:
        chosen = choose(task.camera, sketch, REFERENCES, task.things, sigma)
    except MonocellError as error:
        return Outcome("wrong", time.process_time() - began, told=str(error))
    seconds = time.process_time() - began
    return _judged(task, chosen, _cost_from_truth(task, chosen), seconds)


def _judged(
    task: Task, chosen: Chosen, ideal: tuple[Primitive, float] | None, seconds: float
) -> Outcome:
    thing = chosen.fitted.thing
    cost = _cost(chosen.fitted)
    ideal_cost = np.inf if ideal is None else ideal[1]
    same = ideal is not None and _same(thing, ideal[0])
    # an outline seen edge-on has several small valleys beside each other: the deepest will do
    better = cost <= ideal_cost and _holds(thing, task.truth, SURE)
    alike = cost <= ideal_cost + ALIKE
    verdict = "right" if same or better else "other" if alike else "wrong"
    told = (
        f"chi squared {cost:.1f}, from the truth {ideal_cost:.1f}; "
        f"sizes {thing.sizes.round(4)}, true {task.truth.sizes.round(4)}"
    )
    errors, covered = (), True
    free = _free(thing)
    if free:
        off = (thing.sizes - task.truth.sizes)[free]
        errors = tuple(np.abs(off) / task.truth.sizes[free])
        covered = _holds(thing, task.truth, 1.6449)
    warned = any("add a pick to tell them apart" in w for w in chosen.warnings)
    return Outcome(verdict, seconds, errors, covered, warned, told)


def _free(thing: Primitive) -> list[int]:
    known = [*thing.known, *(["top_radius"] if "apex" in thing.picks else [])]
    return [i for i, name in enumerate(thing.size_names) if name not in known]


def _holds(thing: Primitive, truth: Primitive, normal: float) -> bool:
    """Whether the ellipsoid of the solved sizes, as wide as a normal's quantile, holds the true."""
    free = _free(thing)
    if not free:
        return True
    off = (thing.sizes - truth.sizes)[free]
    part = thing.covariance[6:, 6:][np.ix_(free, free)]
    return float(off @ np.linalg.pinv(part) @ off) <= _chi_squared(len(free), normal)


def _task(way: Way, rng: np.random.Generator) -> Task:
    while True:
        try:
            return way.make(rng)
        except NotSeen:
            continue


def _cost_from_truth(task: Task, chosen: Chosen) -> tuple[Primitive, float] | None:
    """Where a fit that starts from the truth ends, and its chi squared."""
    things = [*task.things.values(), _named(task.scene_truth())]
    observe = pick_observer({"it": chosen.plan})
    try:
        fit = fit_model(task.camera, REFERENCES, things, observe, ["it"])
    except MonocellError:
        return None
    return fit.objects["it"].thing, _cost(fit.objects["it"])


def _cost(fitted: FittedObject) -> float:
    return float(np.sum((fitted.observed.residuals / fitted.observed.sigma) ** 2))


def _named(thing: Primitive) -> Primitive:
    object.__setattr__(thing, "name", "it")
    return thing


def _same(one: Primitive, other: Primitive) -> bool:
    scale = SAME_SHARE * float(np.abs(other.sizes).max())
    places = one.world_from_object.translation - other.world_from_object.translation
    return bool(np.abs(places).max() < scale and np.abs(one.sizes - other.sizes).max() < scale)


def _chi_squared(count: int, normal: float) -> float:
    """The quantile of chi squared where a normal's is `normal` (Wilson and Hilferty 1931)."""
    return float(count * (1 - 2 / (9 * count) + normal * np.sqrt(2 / (9 * count))) ** 3)


if __name__ == "__main__":
    main()
