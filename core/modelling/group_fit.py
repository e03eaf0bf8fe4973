# SPDX-License-Identifier: GPL-3.0-or-later
"""Groups of objects, what is seen of them and what holds them in; the best fit of all out.

Alone, each group is fitted with camera and references as they are given. Jointly, the noise of
camera and references is fitted with all groups at once: it is eliminated group by group (Schur
complement), so that the work grows with the number of objects and not with its cube.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array
from ..camera import Camera
from ..errors import InvalidValue
from ..primitives import Primitive
from ..reference import ReferenceLine, ReferencePlane
from ..rotation import rotation_from_vector
from .group_system import CAMERA, GroupSystem, Spread, gauge_rows, group_system
from .holding import Hold, References
from .observed import Observe, Observed
from .solid import Solid

# a relation off by a tenth of a millimetre (or milliradian) is still near to where it was kept
HELD_SIGMA = 1e-4
# what a metre (or radian) off a relation costs: more than any picks could gain by it, and in
# proportion, because a square would let the picks buy the last micrometres
HELD_COST = 1e6
SETTLED_HOLD = 1e-9
LARGEST_DAMPING, SMALLEST_DAMPING = 1e10, 1e-12


@dataclass(frozen=True, eq=False)
class Scene:
    """All that a fit moves: the camera, the references and the objects, by name.

    `things` are the objects as they were given; `solids` tell where they are now. `noise` (Q,) is
    the shared noise in sigmas, zero where camera and references stand as they were given.
    """

    camera: Camera
    references: References
    things: Mapping[str, Primitive]
    solids: Mapping[str, Solid]
    noise: Array

    def placed(self) -> dict[str, Primitive]:
        """The objects as they are now. Raises InvalidValue for a shape that can't be."""
        return {
            name: self.solids[name].applied(thing) if name in self.solids else thing
            for name, thing in self.things.items()
        }


@dataclass(frozen=True, eq=False)
class Problem:
    """What does not change in a fit.

    `groups` are names of objects that are solved together; `fixed_sizes[name]` are the indices of
    the parameters that were typed. `spread` tells how what is outside the groups moves with the
    shared noise of `noise` numbers.
    """

    groups: Sequence[tuple[str, ...]]
    observe: Observe
    holds: Sequence[Hold]
    fixed_sizes: Mapping[str, Sequence[int]]
    spread: Spread
    noise: int

    def holds_in(self, group: Sequence[str]) -> list[Hold]:
        """The relations of a group's own objects."""
        return [hold for hold in self.holds if hold.own in group]


@dataclass(frozen=True, eq=False)
class Fitted:
    """Where a fit ended: the scene, its systems there, and whether it settled."""

    scene: Scene
    systems: tuple[GroupSystem, ...]
    observed: Mapping[str, Observed]
    settled: bool

    @property
    def noise(self) -> int:
        """How many numbers the shared noise has."""
        return len(self.scene.noise)

    @property
    def cost(self) -> float:
        """The sum of squared residuals in sigmas, with the noise's own."""
        seen = sum(float(s.seen @ s.seen) for s in self.systems)
        return seen + float(self.scene.noise @ self.scene.noise)

    @property
    def worst_hold(self) -> float:
        """By how much the relations are off at most (metres, or sines)."""
        return max((float(np.abs(s.held).max()) for s in self.systems if len(s.held)), default=0.0)


def fit_groups(problem: Problem, start: Scene, *, joint: bool, steps: int = 60) -> Fitted | None:
    """Least squares under exact relations, by Marquardt's damped steps from `start`.

    None where the start can't be seen at all. With `joint` the shared noise moves too.
    """
    here = _evaluated(problem, start)
    if here is None:
        return None
    damping = 1e-4
    for _ in range(steps):
        moves, noise, promised = _step(here.systems, here.scene.noise, damping, joint)
        if promised <= 1e-11 * (here.cost + 1e-12) and here.worst_hold < SETTLED_HOLD:
            return replace(here, settled=True)
        tried = _evaluated(problem, _moved(problem, here.scene, start, moves, noise))
        if tried is not None and _merit(tried) <= _merit(here):
            here, damping = tried, max(damping * 0.1, SMALLEST_DAMPING)
        elif damping >= LARGEST_DAMPING:
            return replace(here, settled=here.worst_hold < HELD_SIGMA)
        else:
            damping *= 8.0
    return here


def _merit(fitted: Fitted) -> float:
    held = sum(float(np.abs(s.held).sum()) for s in fitted.systems)
    return fitted.cost + HELD_COST * held


def _evaluated(problem: Problem, scene: Scene) -> Fitted | None:
    """The systems at a scene; None where an object can't be, or can't be seen so."""
    try:
        things = scene.placed()
    except InvalidValue:
        return None
    observed = problem.observe(scene.solids, scene.camera)
    if not all(np.isfinite(seen.residuals).all() for seen in observed.values()):
        return None
    fixed = {name: _fixed_rows(problem, scene.solids[name], name) for name in scene.solids}
    systems = tuple(
        group_system(
            group,
            things,
            scene.references,
            observed,
            problem.holds_in(group),
            fixed,
            problem.spread,
            problem.noise,
        )
        for group in problem.groups
    )
    return Fitted(scene, systems, observed, settled=False)


def _fixed_rows(problem: Problem, solid: Solid, name: str) -> Array:
    known = problem.fixed_sizes.get(name, ())
    gauges = gauge_rows(solid.kind, solid.rotation, solid.parameters)
    return np.vstack([gauges, np.eye(6 + len(solid.parameters))[[6 + i for i in known]]])


def _step(
    systems: Sequence[GroupSystem], noise: Array, damping: float, joint: bool
) -> tuple[list[Array], Array, float]:
    """The groups' steps and the noise's, and by how much they promise to lower the cost."""
    solved = [_eliminated(system, damping) for system in systems]
    shared = np.zeros(len(noise))
    if joint and len(noise):
        information, gradient = np.eye(len(noise)), noise.copy()
        for (jacobian, by_noise, residual), (inverse, own) in zip(
            (s.reduced for s in systems), solved, strict=True
        ):
            cross = jacobian.T @ by_noise
            information += by_noise.T @ by_noise - cross.T @ inverse @ cross
            gradient += by_noise.T @ residual + cross.T @ own
        information[np.diag_indices_from(information)] *= 1 + damping
        shared = -np.linalg.solve(information, gradient)
    moves, promised = [], 0.0
    for system, (inverse, own) in zip(systems, solved, strict=True):
        jacobian, by_noise, residual = system.reduced
        free = own - inverse @ (jacobian.T @ (by_noise @ shared))
        moves.append(system.free @ free + system.carried @ shared + system.restored)
        after = residual + jacobian @ free + by_noise @ shared
        promised += float(residual @ residual - after @ after)
    after_noise = noise + shared
    return moves, shared, promised + float(noise @ noise - after_noise @ after_noise)


def _eliminated(system: GroupSystem, damping: float) -> tuple[Array, Array]:
    """The damped inverse (F, F) of a group's normal matrix, and its step (F,) without noise."""
    jacobian, _, residual = system.reduced
    scale = np.linalg.norm(jacobian, axis=0)
    scale[scale == 0] = 1.0
    unit = jacobian / scale
    normal = unit.T @ unit
    normal[np.diag_indices_from(normal)] += damping
    inverse = np.linalg.inv(normal) if len(normal) else normal
    inverse = inverse / np.outer(scale, scale)
    return inverse, -inverse @ (jacobian.T @ residual)


def _moved(
    problem: Problem, scene: Scene, start: Scene, moves: Sequence[Array], shared: Array
) -> Scene:
    solids = dict(scene.solids)
    for group, move in zip(problem.groups, moves, strict=True):
        at = 0
        for name in group:
            width = 6 + len(solids[name].parameters)
            solids[name] = solids[name].moved(move[at : at + width])
            at += width
    if not shared.any():
        return replace(scene, solids=solids)
    return with_noise(problem.spread, start, replace(scene, solids=solids), scene.noise + shared)


def with_noise(spread: Spread, start: Scene, scene: Scene, noise: Array) -> Scene:
    """The scene with camera and references where that much noise puts them."""
    camera = start.camera
    if CAMERA in spread:
        pose = camera.pose.perturbed(spread[CAMERA] @ noise)
        camera = replace(camera, camera_from_world=pose)
    references, things = dict(start.references), dict(start.things)
    for (sort, name), by_noise in spread.items():
        if sort == "reference":
            references[name] = _moved_reference(references[name], by_noise @ noise)
        elif sort == "object" and name not in scene.solids:
            thing = things[name]
            things[name] = Solid.of(thing).moved(by_noise @ noise).applied(thing)
    return replace(scene, camera=camera, references=references, things=things, noise=noise)


def _moved_reference(
    reference: ReferencePlane | ReferenceLine, tangent: Array
) -> ReferencePlane | ReferenceLine:
    turn, point = rotation_from_vector(tangent[:3]), reference.point + tangent[3:]
    if isinstance(reference, ReferencePlane):
        return replace(reference, point=point, normal=turn @ reference.normal)
    return replace(reference, point=point, direction=turn @ reference.direction)
