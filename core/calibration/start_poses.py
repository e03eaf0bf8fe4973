# SPDX-License-Identifier: GPL-3.0-or-later
"""Rough poses to start a joint fit from: what each target alone tells in, the best few poses out.

Balls at known places have a centre in both frames and are aligned in closed form. For points, which
have no depth, and for targets at an unknown offset, the rotation is what is hard: with it given,
the translation and all offsets are linear. So rotations from all around are tried, and the best few
are carried on to their minimum: every pose that fits is found, also where there are several.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cache, partial

import numpy as np

from ..arrays import Array
from ..errors import DegeneratePositions
from ..least_squares import levenberg_marquardt
from ..pose import Pose, point_jacobian
from .frames import pose_from_points
from .observation import Place
from .unknowns import OUT_OF_BOUNDS, Unknowns, offset_targets

ROTATIONS, CARRIED_ON, KEPT, LOOKED_AT = 200, 12, 6, 24
# one ball's depth is told about thirty times worse than its direction
DEPTH_WORSE = 30.0
# poses nearer to each other than this are the same one
SAME_TURN, SAME_SHIFT = 0.01, 0.01


@dataclass(frozen=True, eq=False)
class Hint:
    """What one sighting alone tells: the unit `ray` (3,) to its target, and for a ball how far."""

    ray: Array
    distance: float | None
    place: Place

    @property
    def centre_camera(self) -> Array:
        """The target's centre (3,); of a point, one metre along its ray."""
        return self.ray * (1.0 if self.distance is None else self.distance)


@dataclass(frozen=True, eq=False)
class Start:
    """A rough pose, the unknown offsets (K, 3) of `targets`, and what it leaves (half a sum)."""

    camera_from_base: Pose
    targets: tuple[str, ...] = ()
    offsets: Array = field(default_factory=lambda: np.zeros((0, 3)))
    cost: float = 0.0

    def offsets_of(self, places: Sequence[Place]) -> Array:
        """The unknown offsets of these places, as a fit of them wants them.

        Raises DegeneratePositions when one of their targets had no part in this pose.
        """
        wanted = offset_targets(places)
        for target in wanted:
            if target not in self.targets:
                raise DegeneratePositions(f"the sightings of {target!r} hold no offset")
        return np.array([self.offsets[self.targets.index(t)] for t in wanted]).reshape(-1, 3)

    def centres(self, places: Sequence[Place]) -> Array:
        """Where targets (S, 3) are in the camera; NaN where their offset is not known."""
        nowhere = np.full(3, np.nan)
        known = dict(zip(self.targets, self.offsets, strict=True))
        in_base = [p.in_base(known.get(p.target, nowhere)) for p in places]
        return self.camera_from_base.apply(in_base)

    def moved(self, step: Array) -> Start:
        # a step out of all bounds changes nothing, and is thereby refused as no better
        if np.abs(step).max() > OUT_OF_BOUNDS:
            return self
        pose = self.camera_from_base.perturbed(step[:6])
        return replace(self, camera_from_base=pose, offsets=self.offsets + step[6:].reshape(-1, 3))


def start_poses(hints: Sequence[Hint]) -> list[Start]:
    """Rough poses, the best first. Raises DegeneratePositions when positions are on a line."""
    if all(h.distance is not None and h.place.offset is not None for h in hints):
        world = np.array([h.place.in_base() for h in hints])
        camera = np.array([h.centre_camera for h in hints])
        return [Start(start_pose_of(world, camera))]
    return all_poses(hints)


def start_pose_of(world: Array, camera: Array) -> Pose:
    """A pose from centres (N, 3) in both frames: rigid alignment, then their directions.

    The directions are sharper than the depths. Raises DegeneratePositions.
    """
    # depth is known in proportion to the square of the distance
    aligned = pose_from_points(world, camera, 1 / np.linalg.norm(camera, axis=1) ** 4)
    weighing = _weighing(camera, np.linalg.norm(camera, axis=1))
    evaluate = partial(_direction_rows, world=world, camera=camera, weighing=weighing)
    return levenberg_marquardt(aligned, evaluate, Pose.perturbed, steps=30, tolerance=1e-6).value


def all_poses(hints: Sequence[Hint]) -> list[Start]:
    """Every pose that fits about as well as the best, the best first.

    Raises DegeneratePositions when no pose has all targets in front of the camera.
    """
    if len(hints) > LOOKED_AT:
        rough = all_poses([hints[i] for i in _spread(len(hints), LOOKED_AT)])
        return [_carried_on(hints, start) for start in rough[:2]]
    tried = _linear_starts(hints)
    found: list[Start] = []
    for start in sorted(tried, key=lambda s: s.cost)[:CARRIED_ON]:
        if len(found) == KEPT:
            break
        carried = _carried_on(hints, start)
        if _in_front(hints, carried) and not any(same_pose(carried, f) for f in found):
            found.append(carried)
    if not found:
        raise DegeneratePositions("no pose has all targets in front of the camera")
    return sorted(found, key=lambda s: s.cost)


def same_pose(one: Start, other: Start) -> bool:
    """Whether two poses are the same but for what is left to do."""
    a, b = one.camera_from_base, other.camera_from_base
    turn = float(np.linalg.norm(a.rotation - b.rotation)) / np.sqrt(2)
    scale = float(np.linalg.norm(a.translation)) + float(np.linalg.norm(b.translation))
    shift = float(np.linalg.norm(a.translation - b.translation))
    return turn < SAME_TURN and shift < SAME_SHIFT * scale


def _linear_starts(hints: Sequence[Hint]) -> list[Start]:
    """For each rotation the translation and offsets that leave least, (G,) of them."""
    places = [h.place for h in hints]
    unknowns = Unknowns.of_places(places)
    rotations = rotations_all_around(ROTATIONS)
    centres = np.array([h.centre_camera for h in hints])
    weighing = _weighing(centres, np.array([h.distance or np.inf for h in hints]))
    turned = rotations[:, None] @ unknowns.rotations
    blocks = [np.broadcast_to(np.eye(3), turned.shape)]
    blocks += [turned * (unknowns.which == k)[:, None, None] for k in range(len(unknowns.targets))]
    rows = weighing @ np.concatenate(blocks, axis=-1)
    known = np.einsum("sij,sj->si", unknowns.rotations, unknowns.known_offsets)
    in_base = known + unknowns.translations
    depth_known = np.array([h.distance is not None for h in hints])[:, None]
    wanted = np.where(depth_known, centres, 0.0) - np.einsum("gij,sj->gsi", rotations, in_base)
    weighed = np.einsum("sij,gsj->gsi", weighing, wanted)
    flat = rows.reshape(len(rotations), -1, rows.shape[-1])
    right = weighed.reshape(len(rotations), -1)
    normal = np.swapaxes(flat, 1, 2) @ flat
    ridge = 1e-9 * np.trace(normal, axis1=1, axis2=2)[:, None, None] * np.eye(normal.shape[-1])
    solved = np.linalg.solve(normal + ridge, np.einsum("gnp,gn->gp", flat, right)[..., None])
    left = right - (flat @ solved)[..., 0]
    return [
        Start(Pose(rotation, x[:3]), unknowns.targets, x[3:].reshape(-1, 3), float(r @ r))
        for rotation, x, r in zip(rotations, solved[..., 0], left, strict=True)
    ]


def _carried_on(hints: Sequence[Hint], start: Start) -> Start:
    unknowns = Unknowns.of_places([h.place for h in hints])
    evaluate = partial(
        _hint_rows,
        unknowns=unknowns,
        rays=np.array([h.ray for h in hints]),
        depths=np.array([h.distance or np.inf for h in hints]),
    )
    best = levenberg_marquardt(start, evaluate, Start.moved, steps=40, tolerance=1e-8)
    return replace(best.value, cost=best.cost)


def _hint_rows(start: Start, unknowns: Unknowns, rays: Array, depths: Array) -> tuple[Array, Array]:
    """How far each target is off its ray, and weakly off its depth, in radians (3 S,)."""
    offsets = unknowns.known_offsets
    if unknowns.targets:
        mine = start.offsets[np.maximum(unknowns.which, 0)]
        offsets = np.where((unknowns.which < 0)[:, None], offsets, mine)
    in_base = np.einsum("sij,sj->si", unknowns.rotations, offsets) + unknowns.translations
    centres = start.camera_from_base.apply(in_base)
    distance = np.linalg.norm(centres, axis=1)
    axes = centres / distance[:, None]
    across = (np.eye(3) - axes[:, :, None] * axes[:, None, :]) / distance[:, None, None]
    # an unknown depth is infinite here, and weighs nothing
    share = np.where(np.isfinite(depths), distance / depths - 1, 0.0) / DEPTH_WORSE
    by_depth = axes / depths[:, None] / DEPTH_WORSE
    residuals = axes - rays + share[:, None] * rays
    by_centre = across + rays[:, :, None] * by_depth[:, None, :]
    by_pose = by_centre @ point_jacobian(centres)
    turned = start.camera_from_base.rotation @ unknowns.rotations
    by_offsets = [
        by_centre @ turned * (unknowns.which == k)[:, None, None]
        for k in range(len(unknowns.targets))
    ]
    rows = np.concatenate([by_pose, *by_offsets], axis=-1)
    return residuals.ravel(), rows.reshape(-1, rows.shape[-1])


def _in_front(hints: Sequence[Hint], start: Start) -> bool:
    centres = start.centres([h.place for h in hints])
    return bool((np.einsum("si,si->s", centres, [h.ray for h in hints]) > 0).all())


def _weighing(centres: Array, distances: Array) -> Array:
    """Weights (S, 3, 3) across the line of sight, and weakly along it where the depth is told."""
    axes = centres / np.linalg.norm(centres, axis=1)[:, None]
    along = axes[:, :, None] * axes[:, None, :]
    weak = np.where(np.isfinite(distances), 1 / DEPTH_WORSE, 0.0)[:, None, None]
    scale = np.where(np.isfinite(distances), distances, 1.0)[:, None, None]
    weights: Array = (np.eye(3) - along + weak * along) / scale
    return weights


def _direction_rows(
    pose: Pose, world: Array, camera: Array, weighing: Array
) -> tuple[Array, Array]:
    predicted = pose.apply(world)
    residuals = np.einsum("nij,nj->ni", weighing, predicted - camera)
    rows = weighing @ point_jacobian(predicted)
    return residuals.ravel(), rows.reshape(-1, 6)


def _spread(count: int, chosen: int) -> list[int]:
    return np.linspace(0, count - 1, chosen).round().astype(int).tolist()


@cache
def rotations_all_around(count: int) -> Array:
    """`count` rotations (count, 3, 3) spread evenly (super-Fibonacci spirals, Alexa 2022)."""
    s = np.arange(count) + 0.5
    t = s / count
    # the constants are those of the paper: sqrt(2), and the root of x^4 = x + 4
    alpha, beta = 2 * np.pi * s / np.sqrt(2.0), 2 * np.pi * s / 1.533751168755204288118041
    r, big = np.sqrt(t), np.sqrt(1 - t)
    x, y, z, w = r * np.sin(alpha), r * np.cos(alpha), big * np.sin(beta), big * np.cos(beta)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    rotations: Array = np.moveaxis(np.array(rows), -1, 0)
    return rotations
