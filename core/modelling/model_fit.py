# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects near their places, what is seen of them and what holds them in; all solved out.

One at a time (`joint=False`) each object is fitted with what it stands on as it is, in the order in
which they hold each other; jointly, all picks, relations, known sizes and the camera's own error
are one least-squares problem, so that a size typed for one object improves its neighbours.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from ..arrays import Array
from ..camera import Camera
from ..covariance import propagated
from ..errors import NotConverged, PickError
from ..primitives import Primitive
from .fit_uncertainty import (
    Spreads,
    by_camera_of,
    columns_of,
    noise_covariance_of,
    noise_scale,
    spreads_of,
    with_doubts,
    without_dust,
)
from .group_fit import Fitted, Problem, Scene, fit_groups
from .group_order import in_order, together
from .group_system import CAMERA
from .holding import Hold, References, holds_of
from .noise_sources import Key, NoiseSources
from .observed import Observe, Observed
from .solid import Solid

Layout = tuple[tuple[Key, int], ...]

# relations that are kept to within this (metres, or sines) are kept
KEPT = 1e-6
NO_DOUBTS: Mapping[str, Array] = MappingProxyType({})


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
    """All solved objects by name, the camera (moved only by a joint fit), and the fits' cost.

    `pull_sigmas` is how far a joint fit moves camera and references at most, in their own sigmas.
    """

    objects: Mapping[str, FittedObject]
    camera: Camera
    chi_squared: float
    pull_sigmas: float = 0.0


def fit_model(
    camera: Camera,
    references: References,
    things: Sequence[Primitive],
    observe: Observe,
    solve: Iterable[str],
    *,
    joint: bool = False,
    doubts: Mapping[str, Array] = NO_DOUBTS,
) -> ModelFit:
    """Solve the objects named in `solve`, starting from `things`; the others stay as they are.

    Sizes in `known` are held, relations and `on` are kept exactly. Covariances join pick noise, the
    camera's and the references' own, and what the objects inherit from each other. `doubts` are
    motions (6 + P, K) of one sigma each by which an object may be another that its picks fit.

    Raises PickError for an object that its picks and relations leave open, NotConverged for
    relations that contradict each other, InvalidValue for a relation to what is not there, NoPose.
    """
    solved = set(solve)
    named = {t.name: _to_solve(t) if t.name in solved else t for t in things}
    wanted = [name for name in named if name in solved]
    holds = [h for name in wanted for h in holds_of(named[name], references, list(named))]
    fitting = _Fitting(camera, references, named, observe, holds, wanted, doubts)
    return fitting.jointly() if joint else fitting.one_by_one()


def _to_solve(thing: Primitive) -> Primitive:
    """The object with the sizes that were typed, and without the errors of an earlier solution."""
    parameters = thing.parameters.copy()
    for name, value in thing.known.items():
        parameters[thing.size_names.index(name)] = value
    bare = replace(thing, covariance=None, by_camera=None)
    return bare.with_parameters(parameters) if thing.known else bare


@dataclass(frozen=True, eq=False)
class _Fitting:
    camera: Camera
    references: References
    things: dict[str, Primitive]
    observe: Observe
    holds: list[Hold]
    wanted: list[str]
    doubts: Mapping[str, Array]

    def one_by_one(self) -> ModelFit:
        things, done, chi_squared = dict(self.things), dict[str, FittedObject](), 0.0
        still = [t for name, t in things.items() if name not in self.wanted]
        sources = NoiseSources.of(self.camera, self.references, still)
        for level in in_order(self.wanted, self.holds):
            for groups, fitted, layout in self._level(level, things, sources):
                for i, group in enumerate(groups):
                    spreads = self._spreads(fitted, i, group, things)
                    solved = self._solved(fitted, i, group, spreads, layout)
                    sources = _remembered(sources, solved, group, spreads, layout, things)
                    done |= solved
                chi_squared += fitted.cost
            things |= {name: fitted_one.thing for name, fitted_one in done.items()}
        return ModelFit({name: done[name] for name in self.wanted}, self.camera, chi_squared)

    def _level(
        self,
        level: Sequence[tuple[str, ...]],
        things: Mapping[str, Primitive],
        sources: NoiseSources,
    ) -> Iterable[tuple[Sequence[tuple[str, ...]], Fitted, Layout]]:
        """Groups that don't touch each other, side by side, or one by one to find who fails."""
        if len(level) > 1:
            spread, layout = sources.spread(k for group in level for k in self._keys(group))
            fitted = self._fit(level, things, spread, sum(n for _, n in layout), joint=False)
            if fitted is not None and fitted.settled and fitted.worst_hold <= KEPT:
                return [(level, fitted, layout)]
        return [self._alone(group, things, sources) for group in level]

    def _alone(
        self, group: tuple[str, ...], things: Mapping[str, Primitive], sources: NoiseSources
    ) -> tuple[Sequence[tuple[str, ...]], Fitted, Layout]:
        spread, layout = sources.spread(self._keys(group))
        fitted = self._fit([group], things, spread, sum(n for _, n in layout), joint=False)
        return [group], self._checked(fitted, group), layout

    def jointly(self) -> ModelFit:
        groups = together(self.wanted, self.holds)
        still = [t for name, t in self.things.items() if name not in self.wanted]
        sources = NoiseSources.of(self.camera, self.references, still)
        keys = [key for group in groups for key in self._keys(group)]
        spread, layout = sources.spread(keys)
        count = sum(n for _, n in layout)
        fitted = self._checked(
            self._fit(groups, self.things, spread, count, joint=True), self.wanted
        )
        noise_covariance = noise_covariance_of(fitted.systems, count)
        done: dict[str, FittedObject] = {}
        for i, group in enumerate(groups):
            spreads = self._spreads(fitted, i, group, self.things)
            done |= self._solved(fitted, i, group, spreads, layout, noise_covariance)
        camera = fitted.scene.camera
        if CAMERA in spread:
            camera = replace(
                camera, covariance=spread[CAMERA] @ noise_covariance @ spread[CAMERA].T
            )
        pull = float(np.abs(fitted.scene.noise).max(initial=0.0))
        return ModelFit({name: done[name] for name in self.wanted}, camera, fitted.cost, pull)

    def _solved(
        self,
        fitted: Fitted,
        i: int,
        group: Sequence[str],
        spreads: Spreads,
        layout: Layout,
        noise_covariance: Array | None = None,
    ) -> dict[str, FittedObject]:
        """A group's objects with their errors; without a covariance the noise has its one sigma."""
        system, scene = fitted.systems[i], fitted.scene
        spare = len(system.seen) - system.free.shape[1]
        scale = noise_scale(float(system.seen @ system.seen), spare)
        shared: Array = np.eye(fitted.noise)
        if noise_covariance is not None:
            shared = noise_covariance
        done = {}
        for name, columns in columns_of(group, scene.things):
            own, by_noise = spreads.own[columns] * scale, spreads.by_noise[columns]
            whole = propagated(own, np.eye(own.shape[1])) + propagated(by_noise, shared)
            thing = scene.solids[name].applied(scene.things[name])
            by_camera = by_camera_of(by_noise, layout, self.camera)
            thing = replace(thing, covariance=without_dust(whole), by_camera=by_camera)
            done[name] = FittedObject(thing, fitted.observed[name], scale, fitted.settled)
        return done

    def _spreads(
        self, fitted: Fitted, i: int, group: Sequence[str], things: Mapping[str, Primitive]
    ) -> Spreads:
        spreads = spreads_of(fitted.systems[i], group, things)
        return with_doubts(spreads, columns_of(group, things), self.doubts)

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
    ) -> Fitted | None:
        names = [name for group in groups for name in group]
        known = {
            name: [things[name].size_names.index(size) for size in things[name].known]
            for name in names
        }
        problem = Problem(groups, self.observe, self.holds, known, spread, noise)
        solids = {name: Solid.of(things[name]) for name in names}
        start = Scene(self.camera, self.references, things, solids, np.zeros(noise))
        return fit_groups(problem, start, joint=joint)

    def _checked(self, fitted: Fitted | None, names: Sequence[str]) -> Fitted:
        if fitted is None:
            raise PickError(
                f"{', '.join(names)}: as picked, it can't be seen by this camera and lens"
            )
        _refuse_contradictions(fitted, self.holds, names)
        return fitted


def _remembered(
    sources: NoiseSources,
    solved: Mapping[str, FittedObject],
    group: Sequence[str],
    spreads: Spreads,
    layout: Layout,
    things: Mapping[str, Primitive],
) -> NoiseSources:
    """The sources with the solved objects of a group, for what stands on them."""
    for name, columns in columns_of(group, things):
        own = spreads.own[columns] * solved[name].noise_scale
        by_noise = spreads.by_noise[columns]
        sources = sources.with_object(name, by_noise, layout, own, ("group", group[0]))
    return sources


def _refuse_contradictions(fitted: Fitted, holds: Iterable[Hold], names: Sequence[str]) -> None:
    if fitted.worst_hold <= KEPT:
        return
    things = fitted.scene.placed()
    off = [
        (float(np.abs(hold.rows(things, fitted.scene.references).values).max()), hold)
        for hold in holds
        if hold.own in names
    ]
    worst, hold = max(off, key=lambda pair: pair[0])
    raise NotConverged(
        f"{hold.own}: {hold.relation.kind} {hold.relation.to} can't be kept together with its "
        f"other relations and known sizes: {1e3 * worst:.3g} mm (or milliradians) are left; "
        "take one away"
    )
