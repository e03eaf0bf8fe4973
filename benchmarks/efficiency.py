# SPDX-License-Identifier: GPL-3.0-or-later
"""The joint fit against the Cramer-Rao bound, on random rigs with outline noise of known size.

    python benchmarks/efficiency.py [--rigs 1000] [--noise 0.2]

Outlines are projected exactly, shifted by Gaussian noise along their normals and by one bias of the
size that the fit allows for, then fitted. An efficient estimator has a ratio of 1 between its
errors and the bound; here errors in all six numbers are measured in units of the bound's own
covariance. Rigs that calibration refuses, all positions within 2 % of a line, are left out and
counted: there the bound, a matter of first order, says nothing of errors of degrees.

Beside it, on the same outlines, stands what people use instead: SQPnP on the directions of all
centres, P3P on three (the best of its candidates by all), the paper's frames on three centres, and
rigid alignment of all centres; the median error of the camera's place.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable

import numpy as np
from monocell.core.ball.sphere import OutlineRays, outline_pixels, sphere_from_rays, tangency
from monocell.core.calibration.baselines import baseline_poses
from monocell.core.calibration.frames import pose_from_points
from monocell.core.calibration.joint_pose import BIAS_SIGMA_PIXELS, fit_pose
from monocell.core.calibration.observation import OutlineObservation, Place
from monocell.core.calibration.position_geometry import check_positions
from monocell.core.calibration.seen import Seen
from monocell.core.calibration.start_poses import Hint
from monocell.core.errors import DegeneratePositions, MonocellError
from monocell.core.intrinsics import Intrinsics
from monocell.core.pose import Pose, point_jacobian
from monocell.headless.told import table

RADIUS, POINTS = 0.04, 90
COUNTS = (3, 4, 6, 10, 80)
PLACES = ("joint mm", "pnp mm", "p3p mm", "frames mm", "rigid mm")
LENS = Intrinsics(1280, 960, 1200.0, 1200.0, 640.0, 480.0)


def main() -> None:
    """Print one row a number of positions."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rigs", type=int, default=1000)
    parser.add_argument("--noise", type=float, default=0.2, help="sigma along the normal, pixels")
    args = parser.parse_args()
    rows = [_row(count, args.rigs, args.noise) for count in COUNTS]
    print(table(("positions", "rigs", "refused", "rmse / bound", "turn deg", *PLACES), rows))


def _row(count: int, rigs: int, noise: float) -> tuple[str, ...]:
    squares, turns, refused = [], [], 0
    off: dict[str, list[float]] = {name: [] for name in PLACES}
    for seed in range(rigs):
        rng = np.random.default_rng(1000 * count + seed)
        pose, places = _rig(rng, count)
        try:
            check_positions(places)
        except DegeneratePositions:
            refused += 1
            continue
        seen = _outlines(rng, pose, places, noise)
        observations = [one.observation for one in seen]
        fit = fit_pose(observations, pose)
        twist = _twist(fit.camera_from_base, pose)
        squares.append(twist @ _information(observations, pose, noise) @ twist / 6)
        turns.append(np.linalg.norm(twist[:3]))
        for name, estimate in _estimates(fit.camera_from_base, seen, places).items():
            off[name].append(_off(estimate, pose))
    return (
        str(count),
        str(len(squares)),
        str(refused),
        f"{np.sqrt(np.mean(squares)):.3f}",
        f"{np.degrees(np.median(turns)):.4f}",
        *(f"{1e3 * np.nanmedian(off[name]):.2f}" for name in PLACES),
    )


def _estimates(joint: Pose, seen: list[Seen], places: np.ndarray) -> dict[str, Pose | None]:
    centres = np.array([one.hint.centre_camera for one in seen])
    return {
        "joint mm": joint,
        "pnp mm": _or_nothing(lambda: baseline_poses("pnp", seen)[0].camera_from_base),
        "p3p mm": _or_nothing(lambda: baseline_poses("p3p", seen)[0].camera_from_base),
        "frames mm": _or_nothing(lambda: baseline_poses("frames", seen)[0].camera_from_base),
        "rigid mm": _or_nothing(lambda: pose_from_points(places, centres)),
    }


def _rig(rng: np.random.Generator, count: int) -> tuple[Pose, np.ndarray]:
    eye = np.array([2.0, 0.0, 1.2]) + rng.uniform(-0.4, 0.4, 3)
    pose = Pose.looking_at(eye, [0.3, 0.0, 0.3], [0, 0, 1])
    places = rng.uniform([0.0, -0.45, 0.05], [0.7, 0.45, 0.7], (count, 3))
    return pose, places


def _outlines(rng: np.random.Generator, pose: Pose, places: np.ndarray, noise: float) -> list[Seen]:
    bias = rng.normal(0, BIAS_SIGMA_PIXELS)
    seen = []
    for point in places:
        centre = pose.apply(point)
        exact = outline_pixels(LENS, centre, RADIUS, POINTS)
        normals = tangency(OutlineRays.of(LENS, exact), centre, RADIUS).normals
        moved = exact + normals * (bias + rng.normal(0, noise, POINTS))[:, None]
        rays, place = OutlineRays.of(LENS, moved), Place(point)
        found = sphere_from_rays(rays.rays, RADIUS)
        distance = float(np.linalg.norm(found))
        observation = OutlineObservation(rays, np.full(POINTS, noise), place, RADIUS)
        # a pinhole's own: a radian is a focal length
        seen.append(Seen(observation, Hint(found / distance, distance, place), LENS.fx))
    return seen


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


def _off(estimate: Pose | None, truth: Pose) -> float:
    if estimate is None:
        return float("nan")
    off = estimate.inverse().translation - truth.inverse().translation
    return float(np.linalg.norm(off))


def _or_nothing(method: Callable[[], Pose]) -> Pose | None:
    try:
        return method()
    except MonocellError:
        return None


if __name__ == "__main__":
    main()
