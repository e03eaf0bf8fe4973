# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects near their places, what is seen of them and what holds them in; all solved out.

One at a time (`joint=False`) each object is fitted with what it stands on as it is, in the order in
which they hold each other; jointly, all picks, relations, known sizes and the camera's own error
are one least-squares problem, so that a size typed for one object improves its neighbours.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array
from ..camera import Camera
from ..covariance import inverse_information
from ..errors import NotConverged, PickError
from ..primitives import Primitive
from .group_fit import Fitted, Problem, Scene, fit_groups
from .group_order import in_order, together
from .group_system import CAMERA, GroupSystem
from .holding import Hold, References, holds_of
from .noise_sources import Key, NoiseSources
from .observed import Observe, Observed
from .solid import Solid

# relations that are kept to within this (metres, or sines) are kept
KEPT = 1e-6


@dataclass(frozen=True, eq=False)
class FittedObject:
    """One solved object, what is seen of it, and how sure the fit of its group is.

    `noise_scale` is how many times the stated noise the residuals of its group show, 1 unless they
    clearly exceed it; the covariance holds it already.
    """

    thing: Primitive
    observed: Observed
    noise_scale: float
    settled: bool


@dataclass(frozen=True, eq=False)
class ModelFit:
    """All solved objects by name, the camera (moved only by a joint fit), and the fits' cost."""

    objects: Mapping[str, FittedObject]
    camera: Camera
    chi_squared: float


def fit_model(
    camera: Camera,
    references: References,
    things: Sequence[Primitive],
    observe: Observe,
    solve: Iterable[str],
    *,
    joint: bool = False,
) -> ModelFit:
    """Solve the objects named in `solve`, starting from `things`; the others stay as they are.

    Sizes in `known` are held, relations and `on` are kept exactly. Covariances join pick noise, the
    camera's and the references' own, and what the objects inherit from each other.

    Raises PickError for an object that its picks and relations leave open, NotConverged for
    relations that contradict each other, InvalidValue for a relation to what is not there, NoPose.
    """
    named = {thing.name: _with_known(thing) for thing in things}
    wanted = [name for name in named if name in set(solve)]
    holds = [h for name in wanted for h in holds_of(named[name], references, list(named))]
    fitting = _Fitting(camera, references, named, observe, holds, wanted)
    return fitting.jointly() if joint else fitting.one_by_one()


def _with_known(thing: Primitive) -> Primitive:
    """The object with the sizes that were typed."""
    if not thing.known:
        return thing
    parameters = thing.parameters.copy()
    for name, value in thing.known.items():
        parameters[thing.size_names.index(name)] = value
    return thing.with_parameters(parameters)


@dataclass(frozen=True, eq=False)
class _Fitting:
    camera: Camera
    references: References
    things: dict[str, Primitive]
    observe: Observe
    holds: list[Hold]
    wanted: list[str]

    def one_by_one(self) -> ModelFit:
        things, chi_squared = dict(self.things), 0.0
        still = [t for name, t in things.items() if name not in self.wanted]
        sources = NoiseSources.of(self.camera, self.references, still)
        done: dict[str, FittedObject] = {}
        for group in in_order(self.wanted, self.holds):
            spread, layout = sources.spread(self._keys(group))
            fitted = self._fit([group], things, spread, sum(n for _, n in layout), joint=False)
            spreads = _spreads(fitted.systems[0], group, things)
            solved = _solved(fitted, 0, group, spreads, np.eye(sum(n for _, n in layout)))
            for name, columns in _columns(group, things):
                own = spreads.own[columns] * solved[name].noise_scale
                sources = sources.with_object(
                    name, spreads.by_noise[columns], layout, own, ("group", group[0])
                )
                things[name] = solved[name].thing
            done |= solved
            chi_squared += fitted.cost
        return ModelFit({name: done[name] for name in self.wanted}, self.camera, chi_squared)

    def jointly(self) -> ModelFit:
        groups = together(self.wanted, self.holds)
        still = [t for name, t in self.things.items() if name not in self.wanted]
        sources = NoiseSources.of(self.camera, self.references, still)
        keys = [key for group in groups for key in self._keys(group)]
        spread, layout = sources.spread(keys)
        count = sum(n for _, n in layout)
        fitted = self._fit(groups, self.things, spread, count, joint=True)
        noise_covariance = _noise_covariance(fitted.systems, count)
        done: dict[str, FittedObject] = {}
        for i, group in enumerate(groups):
            spreads = _spreads(fitted.systems[i], group, self.things)
            done |= _solved(fitted, i, group, spreads, noise_covariance)
        camera = fitted.scene.camera
        if CAMERA in spread:
            camera = replace(
                camera, covariance=spread[CAMERA] @ noise_covariance @ spread[CAMERA].T
            )
        return ModelFit({name: done[name] for name in self.wanted}, camera, fitted.cost)

    def _keys(self, group: Sequence[str]) -> list[Key]:
        """All outside a group that it can be wrong with."""
        targets = [t.key for h in self.holds if h.own in group for t in h.targets]
        return [CAMERA, *(key for key in targets if key not in [("object", n) for n in group])]

    def _fit(
        self,
        groups: Sequence[tuple[str, ...]],
        things: Mapping[str, Primitive],
        spread: Mapping[Key, Array],
        noise: int,
        *,
        joint: bool,
    ) -> Fitted:
        names = [name for group in groups for name in group]
        known = {
            name: [things[name].size_names.index(size) for size in things[name].known]
            for name in names
        }
        problem = Problem(groups, self.observe, self.holds, known, spread, noise)
        solids = {name: Solid.of(things[name]) for name in names}
        start = Scene(self.camera, self.references, things, solids, np.zeros(noise))
        fitted = fit_groups(problem, start, joint=joint)
        if fitted is None:
            raise PickError(
                f"{', '.join(names)}: as picked, it can't be seen by this camera and lens"
            )
        _refuse_contradictions(fitted, problem, names)
        return fitted


@dataclass(frozen=True, eq=False)
class _Spreads:
    """How a group's tangent follows the shared noise (D, Q) and its picks' own noise (D, F)."""

    by_noise: Array
    own: Array


def _spreads(
    system: GroupSystem, group: Sequence[str], things: Mapping[str, Primitive]
) -> _Spreads:
    jacobian, by_noise, _ = system.reduced
    information = jacobian.T @ jacobian
    inverse = inverse_information(information) if len(information) else information
    if inverse is None:
        raise PickError(_left_open(system, group, things))
    root = np.linalg.cholesky(inverse) if len(inverse) else inverse
    follows = system.carried - system.free @ inverse @ jacobian.T @ by_noise
    return _Spreads(follows, system.free @ root)


def _solved(
    fitted: Fitted, i: int, group: Sequence[str], spreads: _Spreads, noise_covariance: Array
) -> dict[str, FittedObject]:
    system = fitted.systems[i]
    scale = noise_scale(float(system.seen @ system.seen), len(system.seen) - system.free.shape[1])
    done = {}
    for name, columns in _columns(group, fitted.scene.things):
        own, by_noise = spreads.own[columns] * scale, spreads.by_noise[columns]
        covariance = own @ own.T + by_noise @ noise_covariance @ by_noise.T
        thing = fitted.scene.solids[name].applied(
            fitted.scene.things[name], 0.5 * (covariance + covariance.T)
        )
        done[name] = FittedObject(thing, fitted.observed[name], scale, fitted.settled)
    return done


def noise_scale(chi_squared: float, spare: int) -> float:
    """How many times the stated noise the residuals show; 1 unless they clearly exceed it.

    Clearly: beyond two standard deviations of chi squared, and never with fewer than two spare
    equations, which could not tell.
    """
    if spare < 2:
        return 1.0
    reduced = chi_squared / spare
    return float(np.sqrt(reduced)) if reduced > 1.0 + 2.0 * float(np.sqrt(2.0 / spare)) else 1.0


def _noise_covariance(systems: Iterable[GroupSystem], count: int) -> Array:
    """What all objects together leave of the shared noise, (Q, Q)."""
    information = np.eye(count)
    for system in systems:
        jacobian, by_noise, _ = system.reduced
        cross = jacobian.T @ by_noise
        inverse = np.linalg.pinv(jacobian.T @ jacobian, hermitian=True)
        information += by_noise.T @ by_noise - cross.T @ inverse @ cross
    return np.linalg.inv(information)


def _columns(group: Sequence[str], things: Mapping[str, Primitive]) -> list[tuple[str, slice]]:
    widths = [6 + len(things[name].parameters) for name in group]
    ends = np.cumsum(widths)
    return [
        (name, slice(int(end) - width, int(end)))
        for name, end, width in zip(group, ends, widths, strict=True)
    ]


def _left_open(system: GroupSystem, group: Sequence[str], things: Mapping[str, Primitive]) -> str:
    """Which numbers may change without any pick noticing."""
    jacobian = system.reduced[0]
    scale = np.linalg.norm(jacobian, axis=0)
    scale[scale == 0] = 1e-300
    _, _, directions = np.linalg.svd(jacobian / scale)
    loose = system.free @ (directions[-1] / scale)
    loose = np.abs(loose) / max(float(np.abs(loose).max()), 1e-300) > 0.05
    told = []
    for name, columns in _columns(group, things):
        part = loose[columns]
        names = things[name].size_names
        open_ones = [
            n for n, is_loose in zip(names, part[6 : 6 + len(names)], strict=True) if is_loose
        ]
        open_ones += ["its polygon"] if part[6 + len(names) :].any() else []
        open_ones += ["its place"] if part[3:6].any() else []
        open_ones += ["its turn"] if part[:3].any() else []
        if open_ones:
            told.append(f"{name}: the picks do not determine {', '.join(open_ones)}")
    return f"{'; '.join(told)}; add picks, a relation or a known size"


def _refuse_contradictions(fitted: Fitted, problem: Problem, names: Sequence[str]) -> None:
    if fitted.worst_hold <= KEPT:
        return
    things = fitted.scene.placed()
    off = [
        (float(np.abs(hold.rows(things, fitted.scene.references).values).max()), hold)
        for hold in problem.holds
        if hold.own in names
    ]
    worst, hold = max(off, key=lambda pair: pair[0])
    raise NotConverged(
        f"{hold.own}: {hold.relation.kind} {hold.relation.to} can't be kept together with its "
        f"other relations and known sizes: {1e3 * worst:.3g} mm (or milliradians) are left; "
        "take one away"
    )
