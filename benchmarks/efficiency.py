# SPDX-License-Identifier: GPL-3.0-or-later
"""The joint fit against the Cramer-Rao bound, on random rigs with outline noise of known size.

    python benchmarks/efficiency.py [--rigs 200] [--noise 0.2]

Outlines are projected exactly, shifted by Gaussian noise along their normals and by one bias of the
size that the fit allows for, then fitted. An efficient estimator has a ratio of 1 between its
errors and the bound; here errors in all six numbers are measured in units of the bound's own
covariance. The paper's three-point frames and rigid alignment of all centres stand beside it.
"""

from __future__ import annotations

import argparse

import numpy as np
from monocell.core.ball.sphere import OutlineRays, outline_pixels, sphere_from_rays, tangency
from monocell.core.calibration.frames import pose_from_points, pose_from_triads
from monocell.core.calibration.joint_pose import BIAS_SIGMA_PIXELS, fit_pose
from monocell.core.calibration.observation import OutlineObservation, Place
from monocell.core.errors import MonocellError
from monocell.core.intrinsics import Intrinsics
from monocell.core.pose import Pose, point_jacobian
from monocell.headless.told import table

RADIUS, POINTS = 0.04, 90
COUNTS = (3, 4, 6, 10, 80)
LENS = Intrinsics(1280, 960, 1200.0, 1200.0, 640.0, 480.0)


def main() -> None:
    """Print one row a number of positions."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rigs", type=int, default=200)
    parser.add_argument("--noise", type=float, default=0.2, help="sigma along the normal, pixels")
    args = parser.parse_args()
    rows = [_row(count, args.rigs, args.noise) for count in COUNTS]
    header = ("positions", "rigs", "rmse / bound", "place mm", "turn deg", "frames mm", "rigid mm")
    print(table(header, rows))


def _row(count: int, rigs: int, noise: float) -> tuple[str, ...]:
    squares, joint, frames, rigid = [], [], [], []
    for seed in range(rigs):
        rng = np.random.default_rng(1000 * count + seed)
        pose, places = _rig(rng, count)
        observations, centres = _outlines(rng, pose, places, noise)
        fit = fit_pose(observations, pose)
        twist = _twist(fit.camera_from_base, pose)
        squares.append(twist @ _information(observations, pose, noise) @ twist / 6)
        joint.append(_errors(fit.camera_from_base, pose))
        frames.append(_errors(_or_nothing(pose_from_triads, places[:3], centres[:3]), pose)[0])
        rigid.append(_errors(_or_nothing(pose_from_points, places, centres), pose)[0])
    place, turn = np.median(joint, axis=0)
    return (
        str(count),
        str(rigs),
        f"{np.sqrt(np.mean(squares)):.3f}",
        f"{1e3 * place:.2f}",
        f"{np.degrees(turn):.4f}",
        f"{1e3 * np.nanmedian(frames):.1f}",
        f"{1e3 * np.nanmedian(rigid):.1f}",
    )


def _rig(rng: np.random.Generator, count: int) -> tuple[Pose, np.ndarray]:
    eye = np.array([2.0, 0.0, 1.2]) + rng.uniform(-0.4, 0.4, 3)
    pose = Pose.looking_at(eye, [0.3, 0.0, 0.3], [0, 0, 1])
    places = rng.uniform([0.0, -0.45, 0.05], [0.7, 0.45, 0.7], (count, 3))
    return pose, places


def _outlines(
    rng: np.random.Generator, pose: Pose, places: np.ndarray, noise: float
) -> tuple[list[OutlineObservation], np.ndarray]:
    bias = rng.normal(0, BIAS_SIGMA_PIXELS)
    observations, centres = [], []
    for place in places:
        centre = pose.apply(place)
        exact = outline_pixels(LENS, centre, RADIUS, POINTS)
        normals = tangency(OutlineRays.of(LENS, exact), centre, RADIUS).normals
        moved = exact + normals * (bias + rng.normal(0, noise, POINTS))[:, None]
        rays = OutlineRays.of(LENS, moved)
        observations.append(OutlineObservation(rays, np.full(POINTS, noise), Place(place), RADIUS))
        centres.append(sphere_from_rays(rays.rays, RADIUS))
    return observations, np.array(centres)


def _information(observations: list[OutlineObservation], pose: Pose, noise: float) -> np.ndarray:
    """Fisher's information of the pose (6, 6), the bias marginalised under its prior."""
    information = np.zeros((7, 7))
    information[6, 6] = BIAS_SIGMA_PIXELS**-2
    for o in observations:
        centre = pose.apply(o.place.offset)
        by_centre = tangency(o.outline, centre, o.radius).by_centre
        rows = np.column_stack([by_centre @ point_jacobian(centre), -np.ones(POINTS)]) / noise
        information += rows.T @ rows
    a, b, c = information[:6, :6], information[:6, 6], information[6, 6]
    return a - np.outer(b, b) / c


def _twist(estimate: Pose, truth: Pose) -> np.ndarray:
    change = estimate @ truth.inverse()
    return np.concatenate([change.rotation_vector(), change.translation])


def _errors(estimate: Pose | None, truth: Pose) -> tuple[float, float]:
    if estimate is None:
        return float("nan"), float("nan")
    place = estimate.inverse().translation - truth.inverse().translation
    turn = (estimate @ truth.inverse()).rotation_vector()
    return float(np.linalg.norm(place)), float(np.linalg.norm(turn))


def _or_nothing(method, world: np.ndarray, camera: np.ndarray) -> Pose | None:
    try:
        return method(world, camera)
    except MonocellError:
        return None


if __name__ == "__main__":
    main()
