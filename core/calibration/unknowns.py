# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers a joint fit solves for: what is known of every target in, values and derivatives out.

The order is fixed: the twist of `camera_from_base`, the edge bias, three numbers for each unknown
offset, then what is refined.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..pose import Pose
from ..rotation import hat
from .observation import Place

Refinable = Literal["focal", "radius"]
REFINABLE: tuple[Refinable, ...] = ("focal", "radius")
TWIST = ("rotation x", "rotation y", "rotation z", "x", "y", "z")
BIAS = 6
OUT_OF_BOUNDS = 1e5
# what moves a residual beside the target's centre: each is a column of `Columns.shared`
SHARED = ("edge bias", "radius", "focal", "radial")


@dataclass(frozen=True, eq=False)
class State:
    """One value of all unknowns; radius and focal length as logarithms of a factor."""

    camera_from_base: Pose
    offsets: Array
    edge_bias_pixels: float = 0.0
    log_radius: float = 0.0
    log_focal: float = 0.0


@dataclass(frozen=True)
class Refined:
    """By what factor refining changed the radius or the focal lengths, with 1 sigma of it."""

    name: Refinable
    factor: float
    sigma: float


@dataclass(frozen=True, eq=False)
class Columns:
    """Residuals (N,) in pixels, and by what they move: the centre (N, 3), what is SHARED (N, 4)."""

    residual_pixels: Array
    by_centre: Array
    shared: Array


@dataclass(frozen=True, eq=False)
class Unknowns:
    """The unknowns of S sightings: `which` (S,) says whose offset is unknown, -1 for known ones."""

    targets: tuple[str, ...]
    refined: tuple[Refinable, ...]
    which: NDArray[np.intp]
    known_offsets: Array
    rotations: Array
    translations: Array

    @staticmethod
    def of_places(places: Sequence[Place], refined: Sequence[Refinable] = ()) -> Unknowns:
        targets = offset_targets(places)
        return Unknowns(
            targets,
            tuple(name for name in REFINABLE if name in refined),
            np.array([_which(p, targets) for p in places], dtype=np.intp),
            np.array([np.zeros(3) if p.offset is None else p.offset for p in places]),
            np.array([p.base_from_carrier.rotation for p in places]),
            np.array([p.base_from_carrier.translation for p in places]),
        )

    @property
    def names(self) -> tuple[str, ...]:
        """One name a number, P in all."""
        offsets = tuple(
            f"{axis} of the offset{' of ' + target if target else ''}"
            for target in self.targets
            for axis in "xyz"
        )
        return (*TWIST, "edge bias", *offsets, *self.refined)

    @property
    def count(self) -> int:
        """P."""
        return self.after_offsets + len(self.refined)

    @property
    def after_offsets(self) -> int:
        """Where the refined numbers begin."""
        return BIAS + 1 + 3 * len(self.targets)

    def offsets(self, state: State) -> Array:
        """The offset (S, 3) of each sighting's target in its carrier."""
        if not self.targets:
            return self.known_offsets
        return np.where(
            (self.which < 0)[:, None], self.known_offsets, state.offsets[np.maximum(self.which, 0)]
        )

    def places_base(self, state: State) -> Array:
        """Where the targets (S, 3) are in the base."""
        turned = np.einsum("sij,sj->si", self.rotations, self.offsets(state))
        return turned + self.translations

    def moved(self, state: State, step: Array) -> State:
        """The state after a step (P,)."""
        # a step out of all bounds changes nothing, and is thereby refused as no better
        if np.abs(step).max() > OUT_OF_BOUNDS:
            return state
        more = dict(zip(self.refined, step[self.after_offsets :], strict=True))
        return replace(
            state,
            camera_from_base=state.camera_from_base.perturbed(step[:BIAS]),
            edge_bias_pixels=state.edge_bias_pixels + float(step[BIAS]),
            offsets=state.offsets + step[BIAS + 1 : self.after_offsets].reshape(-1, 3),
            log_radius=state.log_radius + float(more.get("radius", 0.0)),
            log_focal=state.log_focal + float(more.get("focal", 0.0)),
        )

    def rows(self, columns: Columns, owner: NDArray[np.intp], state: State) -> Array:
        """Derivatives (N, P) of the residuals by the unknowns."""
        by_centre = columns.by_centre
        centres = state.camera_from_base.apply(self.places_base(state))
        turning = np.cross(centres[owner], by_centre)
        parts = [turning, by_centre, columns.shared[:, :1]]
        parts += [self._by_offset(by_centre, owner, state, k) for k in range(len(self.targets))]
        parts += [columns.shared[:, [SHARED.index(name)]] for name in self.refined]
        return np.hstack(parts)

    def chain(self, state: State) -> Array:
        """How the centres and what is shared change with the unknowns, (S, 7, P + A).

        The last A columns are of what is not solved for but can be asked.
        """
        centres = state.camera_from_base.apply(self.places_base(state))
        columns = self.count + len(self.asked)
        chain = np.zeros((len(centres), 3 + len(SHARED), columns))
        chain[:, :3, :3] = -hat(centres)
        chain[:, :3, 3:6] = np.eye(3)
        chain[:, 3, BIAS] = 1
        turned = state.camera_from_base.rotation @ self.rotations
        for k in range(len(self.targets)):
            at = BIAS + 1 + 3 * k
            chain[self.which == k, :3, at : at + 3] = turned[self.which == k]
        more = (*self.refined, *self.asked)
        for i, name in enumerate(more):
            chain[:, 3 + SHARED.index(name), columns - len(more) + i] = 1
        return chain

    def refinements(self, state: State, sigmas: Array) -> tuple[Refined, ...]:
        """What was refined, with its share of the sigmas (P,)."""
        logs = {"radius": state.log_radius, "focal": state.log_focal}
        return tuple(
            Refined(name, float(np.exp(logs[name])), float(sigma * np.exp(logs[name])))
            for name, sigma in zip(self.refined, sigmas[self.after_offsets :], strict=True)
        )

    @property
    def asked(self) -> tuple[str, ...]:
        """What is shared and not solved for, in the order of the chain's last columns."""
        return tuple(name for name in SHARED[1:] if name not in self.refined)

    def _by_offset(self, by_centre: Array, owner: NDArray[np.intp], state: State, k: int) -> Array:
        mine = self.which[owner] == k
        turned = state.camera_from_base.rotation @ self.rotations
        by_offset = np.zeros_like(by_centre)
        by_offset[mine] = np.einsum("ni,nij->nj", by_centre[mine], turned[owner[mine]])
        return by_offset


def offset_targets(places: Sequence[Place]) -> tuple[str, ...]:
    """The targets whose offset is unknown, in the order in which they come."""
    return tuple(dict.fromkeys(p.target for p in places if p.offset is None))


def _which(place: Place, targets: Sequence[str]) -> int:
    return targets.index(place.target) if place.offset is None else -1
