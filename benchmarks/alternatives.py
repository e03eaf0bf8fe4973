# SPDX-License-Identifier: GPL-3.0-or-later
"""monocell against what people use instead, on the same rendered cells.

    python benchmarks/alternatives.py [--rigs 12] [--cache FOLDER]

The same gripper holds, at the same places, a 40 mm ball, a ChArUco board of 150 mm, or an AprilTag
of 70 mm; camera, light and intrinsics are the same, and each print's place in the gripper is known
exactly. monocell gets whole pictures; the two ways that use Canny's edges get a window around each
ball. Printed for clean and for noisy JPEG pictures: how many rigs were solved, the camera's error,
and the time per picture.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from board_poses import (
    SeenPanel,
    aligned_pose,
    averaged_pose,
    charuco_corners,
    joint_pose,
    tag_corners,
)
from contour_balls import Window, agreeing_edges, ellipse_centre, sphere_centre
from monocell.core.ball.sphere import outline_pixels
from monocell.core.calibration.frames import pose_from_points
from monocell.core.pose import Pose
from monocell.headless.told import progress, table
from photographs import Development, as_file_gives, developed, exposure_gain
from rendered_accuracy import CLEAN, NOISY
from rendered_panels import rendered_panels
from rendered_rigs import CACHE, RenderedRig, rendered_rig
from rig_plans import RADIUS, RigPlan, random_plan
from rig_scores import pose_errors, score_rig

CLASSES = {"clean": CLEAN, "noise 4, blur 0.8, JPEG 80": NOISY}
CORNERS = {"charuco": charuco_corners, "tag": tag_corners}
PANEL_POSES = {"joint PnP": joint_pose, "averaged": averaged_pose, "aligned": aligned_pose}
NAMES = {"charuco": "ChArUco 150 mm", "tag": "AprilTag 70 mm"}


@dataclass(frozen=True)
class Result:
    """Of one method on one rig: seconds per picture; errors None where it gave no pose."""

    method: str
    seconds: float
    errors: tuple[float, float] | None


def main() -> None:
    """Print one table a class of pictures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rigs", type=int, default=12)
    parser.add_argument("--cache", type=Path, default=CACHE)
    args = parser.parse_args()
    for name, how in CLASSES.items():
        results: list[Result] = []
        for seed in range(args.rigs):
            plan = random_plan("plain", seed)
            results += [*_ball(plan, how, args.cache), *_panels(plan, how, args.cache)]
            progress(f"{name}: {plan.name}")
        methods = list(dict.fromkeys(result.method for result in results))
        rows = [_row(m, [r for r in results if r.method == m]) for m in methods]
        header = (name, "solved", "mm", "90 %", "deg", "90 %", "ms a picture")
        print(table(header, rows), end="\n\n")


def _row(method: str, results: list[Result]) -> tuple[str, ...]:
    errors = [result.errors for result in results if result.errors is not None]
    milliseconds = f"{1e3 * np.median([r.seconds for r in results]):.0f}"
    solved = f"{len(errors)} of {len(results)}"
    if not errors:
        return (method, solved, "", "", "", "", milliseconds)
    place, turn = np.array(errors).T * [[1e3], [180 / np.pi]]
    figures = [f"{v:.2f}" for v in (np.median(place), np.quantile(place, 0.9))]
    figures += [f"{v:.4f}" for v in (np.median(turn), np.quantile(turn, 0.9))]
    return (method, solved, *figures, milliseconds)


def _ball(plan: RigPlan, how: Development, cache: Path) -> Iterator[Result]:
    rig = rendered_rig(plan, cache=cache)
    score = score_rig(rig, how)
    solved = None if score.verdict in ("refused", "failed") else (score.place, score.turn)
    yield Result("monocell, ball 40 mm", score.seconds / len(plan.positions), solved)
    pictures = _pictures(rig, how)
    began = time.perf_counter()
    windows = [_window(plan, i) for i in range(len(pictures))]
    edges = [
        agreeing_edges(picture, window, plan.camera.intrinsics, i)
        for i, (picture, window) in enumerate(zip(pictures, windows, strict=True))
    ]
    cutting = time.perf_counter() - began
    for name, method in (
        ("ball: fitEllipse centres, PnP", _by_ellipses),
        ("ball: three-point spheres, aligned", _by_spheres),
    ):
        yield _timed(name, plan, lambda f=method: f(plan, edges), cutting)


def _panels(plan: RigPlan, how: Development, cache: Path) -> Iterator[Result]:
    for kind, corners_in in CORNERS.items():
        held = rendered_panels(plan, kind, cache)
        pictures = _pictures(held.rig, how)
        began = time.perf_counter()
        corners = [corners_in(picture) for picture in pictures]
        finding = time.perf_counter() - began
        seen = [
            SeenPanel(*found, pose)
            for found, pose in zip(corners, held.world_from_panel, strict=True)
            if len(found[1])
        ]
        for name, solve in PANEL_POSES.items():
            told = f"{NAMES[kind]}: {name}"
            job = lambda s=seen, f=solve: f(plan.camera.intrinsics, s) if s else None  # noqa: E731
            yield _timed(told, plan, job, finding)


def _timed(name: str, plan: RigPlan, job: Callable[[], Pose | None], before: float) -> Result:
    began = time.perf_counter()
    pose = job()
    seconds = before + time.perf_counter() - began
    errors = None if pose is None else pose_errors(plan.camera, pose)
    return Result(name, seconds / len(plan.positions), errors)


def _pictures(rig: RenderedRig, how: Development) -> list[np.ndarray]:
    gain = exposure_gain(rig, how)
    return [
        as_file_gives(developed(rig.light(i), gain, how, (rig.plan.seed, i)), how)
        for i in range(len(rig.plan.positions))
    ]


def _window(plan: RigPlan, i: int) -> Window:
    """What a hand draws around the ball: 1.6 radii to each side, a few pixels off."""
    outline = outline_pixels(
        plan.camera.intrinsics, plan.camera.pose.apply(plan.positions[i]), RADIUS
    )
    low, high = outline.min(axis=0), outline.max(axis=0)
    hand = np.random.default_rng([31, plan.seed, i]).uniform(-3, 3, 2)
    corner = np.rint(low - 0.3 * (high - low) + hand).astype(int)
    width, height = np.rint(1.6 * (high - low)).astype(int).tolist()
    return int(corner[0]), int(corner[1]), width, height


def _by_ellipses(plan: RigPlan, edges: list[np.ndarray]) -> Pose | None:
    centres = [ellipse_centre(found) for found in edges]
    found = [i for i, centre in enumerate(centres) if centre is not None]
    if len(found) < 4:
        return None
    rays = plan.camera.intrinsics.rays(np.array([centres[i] for i in found]))
    plane = rays[:, :2] / rays[:, 2:]
    done, turn, place = cv2.solvePnP(
        plan.positions[found], plane, np.eye(3), np.zeros(0), flags=cv2.SOLVEPNP_SQPNP
    )
    return Pose.from_rotation_vector(turn.ravel(), place.ravel()) if done else None


def _by_spheres(plan: RigPlan, edges: list[np.ndarray]) -> Pose | None:
    centres = [sphere_centre(plan.camera.intrinsics, found, RADIUS) for found in edges]
    found = [i for i, centre in enumerate(centres) if centre is not None]
    if len(found) < 3:
        return None
    return pose_from_points(plan.positions[found], [centres[i] for i in found])


if __name__ == "__main__":
    main()
