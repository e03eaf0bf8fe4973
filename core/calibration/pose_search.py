# SPDX-License-Identifier: GPL-3.0-or-later
"""The sightings that fit one pose together: measured balls in, the pose and the odd ones out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from itertools import combinations

import numpy as np

from ..arrays import Array, Mask
from ..ball.outline import SphereOutline
from ..ball.sphere import OutlineRays
from ..errors import DegeneratePositions, NotConverged
from ..intrinsics import Intrinsics
from ..least_squares import levenberg_marquardt
from ..pose import Pose, point_jacobian
from .frames import pose_from_points
from .joint_pose import JointFit, fit_pose
from .observation import OutlineObservation, Place

# a sighting is odd when its own outline would rather have the ball this many sigmas elsewhere,
# beyond what the sightings have in common
ODD_MISFIT = 6.0
# and when it is at least this far off: a ball of a robot is never placed to a micron
ODD_PIXELS = 0.5
# below this factor all sightings agree; leaving some out has to bring the rest this much closer
ALL_WELL, PAYING_MISFIT = 3.0, 0.5
# how well a rough pose from three balls predicts the others, in ball radii and share of distance
ROUGH_ACROSS, ROUGH_DEPTH = 0.35, 0.2
MOST_TRIPLES = 60
# balls this many times farther apart than their positions betray a mistaken unit
MISTAKEN_UNIT_LOW, MISTAKEN_UNIT_HIGH = 0.03, 30.0


@dataclass(frozen=True, eq=False)
class ConsistentFit:
    """The joint fit of the sightings `used` (S,), and by how many pixels each ball is off it."""

    fit: JointFit
    used: Mask
    off_pixels: Array
    misfits: Array


@dataclass(frozen=True, eq=False)
class SeenBall:
    """A ball at `centre_world` (3,) and its measured outline in the picture."""

    centre_world: Array
    outline: SphereOutline
    observation: OutlineObservation

    @staticmethod
    def of(centre_world: Array, outline: SphereOutline, intrinsics: Intrinsics) -> SeenBall:
        rays = OutlineRays.of(intrinsics, outline.pixels)
        used = outline.used
        observation = OutlineObservation(
            rays.chosen(used),
            outline.sigma_pixels[used],
            Place(centre_world),
            outline.radius,
            intrinsics,
        )
        return SeenBall(centre_world, outline, observation)


def fit_consistent(balls: Sequence[SeenBall]) -> ConsistentFit:
    """The pose of all balls, or of those that agree where some do not.

    Raises DegeneratePositions when the balls that agree lie on a line, NotConverged when no three
    of them agree.
    """
    everything = np.ones(len(balls), dtype=bool)
    try:
        together = _fitted(balls, everything, start_pose(balls))
    except DegeneratePositions:
        together = None
    if together is not None and together.fit.misfit < ALL_WELL and not _odd(together).any():
        return together
    if len(balls) == 3:
        if together is None:
            raise NotConverged("the three balls found fit no pose together")
        return together
    best = _without_the_odd(balls)
    # leaving sightings out has to pay: an error that all share is not mended by using fewer
    pays = together is None or best.fit.misfit < PAYING_MISFIT * together.fit.misfit
    return best if pays or together is None else together


def start_pose(balls: Sequence[SeenBall]) -> Pose:
    """A pose from the balls' centres alone. Raises DegeneratePositions."""
    return start_pose_of(
        np.array([ball.centre_world for ball in balls]),
        np.array([ball.outline.centre_camera for ball in balls]),
    )


def start_pose_of(world: Array, camera: Array) -> Pose:
    """A pose from centres (N, 3) in both frames: rigid alignment, then their directions.

    The directions are sharper than the depths. Raises DegeneratePositions.
    """
    # depth is known in proportion to the square of the distance
    aligned = pose_from_points(world, camera, 1 / np.linalg.norm(camera, axis=1) ** 4)
    evaluate = partial(_direction_rows, world=world, camera=camera)
    return levenberg_marquardt(aligned, evaluate, Pose.perturbed, steps=30).value


def _direction_rows(pose: Pose, world: Array, camera: Array) -> tuple[Array, Array]:
    """Off-axis misfit of each centre, per distance, and a weak say of its depth."""
    predicted = pose.apply(world)
    distance = np.linalg.norm(camera, axis=1)
    axes = camera / distance[:, None]
    across = np.eye(3) - axes[:, :, None] * axes[:, None, :]
    # one ball's depth is told about thirty times worse than its direction
    weighing = (across + axes[:, :, None] * axes[:, None, :] / 30) / distance[:, None, None]
    residuals = np.einsum("nij,nj->ni", weighing, predicted - camera)
    rows = weighing @ point_jacobian(predicted)
    return residuals.ravel(), rows.reshape(-1, 6)


def _fitted(balls: Sequence[SeenBall], used: Mask, start: Pose) -> ConsistentFit:
    chosen = [ball for ball, use in zip(balls, used, strict=True) if use]
    fit = fit_pose([ball.observation for ball in chosen], start)
    misfits = np.full(len(balls), np.nan)
    misfits[used] = fit.sighting_misfits
    off = np.array([off_pixels(ball, fit.camera_from_base) for ball in balls])
    return ConsistentFit(fit, used, off, misfits)


def off_pixels(ball: SeenBall, pose: Pose) -> float:
    """How far, across the picture, a found ball is from where the pose puts it."""
    predicted, found = pose.apply(ball.centre_world), ball.outline.centre_camera
    angle = np.arctan2(np.linalg.norm(np.cross(predicted, found)), predicted @ found)
    rays_per_pixel = np.linalg.norm(ball.observation.outline.rays_by_pixel, axis=(1, 2))
    return float(angle / (np.median(rays_per_pixel) / np.sqrt(2)))


def _odd(fit: ConsistentFit) -> Mask:
    common = max(1.0, float(np.nanmedian(fit.misfits)))
    odd: Mask = (fit.misfits > ODD_MISFIT * common) & (fit.off_pixels > ODD_PIXELS)
    return odd


def _without_the_odd(balls: Sequence[SeenBall]) -> ConsistentFit:
    used, start = _largest_agreement(balls)
    fit = _fitted(balls, used, start)
    for _ in range(len(balls)):
        odd = _odd(fit) & fit.used
        if fit.used.sum() <= 3 or (fit.fit.misfit < ALL_WELL and not odd.any()):
            break
        if odd.any():
            fit = _fitted(balls, fit.used & ~odd, fit.fit.camera_from_base)
            continue
        better = _best_without_one(balls, fit)
        if better is None:
            break
        fit = better
    return fit


def _best_without_one(balls: Sequence[SeenBall], fit: ConsistentFit) -> ConsistentFit | None:
    """The fit without the ball that bends it most, None where no single one does.

    One wrong place can bend the pose until all balls look equally wrong, and none is odd.
    """
    tried = []
    for i in np.flatnonzero(fit.used):
        fewer = fit.used & (np.arange(len(balls)) != i)
        try:
            start = start_pose([ball for ball, use in zip(balls, fewer, strict=True) if use])
            tried.append(_fitted(balls, fewer, start))
        except DegeneratePositions:
            continue
    best = min(tried, key=lambda one: one.fit.misfit, default=None)
    pays = best is not None and best.fit.misfit < PAYING_MISFIT * fit.fit.misfit
    return best if pays else None


def _largest_agreement(balls: Sequence[SeenBall]) -> tuple[Mask, Pose]:
    triples = list(combinations(range(len(balls)), 3))
    if len(triples) > MOST_TRIPLES:
        order = np.random.default_rng(0).permutation(len(triples))[:MOST_TRIPLES]
        triples = [triples[i] for i in order]
    best: tuple[int, float, Mask, Pose] | None = None
    for triple in triples:
        try:
            pose = start_pose([balls[i] for i in triple])
        except DegeneratePositions:
            continue
        agrees, off = _agreeing(balls, pose)
        if best is None or (agrees.sum(), -off) > (best[0], -best[1]):
            best = (int(agrees.sum()), off, agrees, pose)
    if best is None or best[0] < 3:
        raise NotConverged(
            f"no three of the {len(balls)} balls found fit one pose; {_units_hint(balls)}"
        )
    agreeing = [ball for ball, use in zip(balls, best[2], strict=True) if use]
    return best[2], start_pose(agreeing)


def _agreeing(balls: Sequence[SeenBall], pose: Pose) -> tuple[Mask, float]:
    found = np.array([ball.outline.centre_camera for ball in balls])
    radii = np.array([ball.outline.radius for ball in balls])
    predicted = pose.apply([ball.centre_world for ball in balls])
    distance = np.linalg.norm(found, axis=1)
    along = np.abs(np.linalg.norm(predicted, axis=1) / distance - 1)
    cosine = np.einsum("ni,ni->n", predicted, found) / (
        np.linalg.norm(predicted, axis=1) * distance
    )
    across = np.arccos(np.clip(cosine, -1, 1)) * distance / radii
    agrees: Mask = (across < ROUGH_ACROSS) & (along < ROUGH_DEPTH)
    return agrees, float(np.minimum(across, ROUGH_ACROSS).sum())


def _units_hint(balls: Sequence[SeenBall]) -> str:
    """What to check: a wrong unit shows in how far the balls are apart, found against given."""
    found = np.array([ball.outline.centre_camera for ball in balls])
    given = np.array([ball.centre_world for ball in balls])
    apart = [
        float(np.median(np.linalg.norm(p[:, None] - p, axis=2)[np.triu_indices(len(p), 1)]))
        for p in (found, given)
    ]
    radius = balls[0].outline.radius
    if apart[0] < radius:
        return "the ball is in the same place in all pictures: are they the right ones?"
    ratio = apart[0] / max(apart[1], 1e-12)
    if MISTAKEN_UNIT_LOW < ratio < MISTAKEN_UNIT_HIGH:
        return "check that every picture is the one of its position, then positions and radius"
    return (
        f"with a radius of {radius:g} m the balls found are {apart[0]:.3g} m apart, the positions "
        f"given {apart[1]:.3g} m: is one of them in millimetres?"
    )
