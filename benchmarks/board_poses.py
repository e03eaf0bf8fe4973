# SPDX-License-Identifier: GPL-3.0-or-later
"""A camera's pose from a ChArUco board or an AprilTag in the gripper, by OpenCV: corners in.

Each picture's corners are known in the world, because the robot's position and the plate's place in
the gripper are. `joint` is one PnP on all corners of all pictures, the best a user can do;
`averaged` is what most do: the board's pose in each picture, and the mean of the camera poses that
follow, without those that a plane's mirror pose spoils; `aligned` uses only where each board is,
by rigid alignment.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from monocell.core.calibration.frames import pose_from_points
from monocell.core.intrinsics import Intrinsics
from monocell.core.pose import Pose
from rendered_panels import PLATE, TAG, charuco_board, tag_dictionary

# what a marker that was not found is looked for again in
ENLARGED = 2
MIRRORED = np.radians(12)


@dataclass(frozen=True, eq=False)
class SeenPanel:
    """Corners of one panel: in the panel (N, 3), in the picture (N, 2), and where the panel was."""

    corners_panel: np.ndarray
    pixels: np.ndarray
    world_from_panel: Pose


def charuco_corners(picture: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Inner corners of the board: in the panel (N, 3) and in the picture (N, 2)."""
    board = charuco_board()
    detector, best, names = cv2.aruco.CharucoDetector(board), np.zeros((0, 2)), []
    for scale in (1, ENLARGED):
        found, ids, _, _ = detector.detectBoard(_grey(picture, scale))
        if found is not None and len(found) > len(best):
            # OpenCV 4.11 counts a board's corners from the corner of a pixel
            best, names = (found[:, 0]) / scale - 0.5, ids.ravel()
        if len(best) == len(board.getChessboardCorners()):
            break
    half = PLATE["charuco"] / 2
    return board.getChessboardCorners()[names].reshape(-1, 3) - [half, half, 0], best


def tag_corners(picture: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The tag's four corners: in the panel (4, 3) and in the picture (4, 2), or none of them."""
    parameters = cv2.aruco.DetectorParameters()
    parameters.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_SUBPIX
    detector = cv2.aruco.ArucoDetector(tag_dictionary(), parameters)
    corners, ids, _ = detector.detectMarkers(_grey(picture, ENLARGED))
    square = TAG / 2 * np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0.0]])
    for found, name in zip(corners, () if ids is None else ids.ravel(), strict=True):
        if name == 0:
            return square, (found[0] + 0.5) / ENLARGED - 0.5
    return np.zeros((0, 3)), np.zeros((0, 2))


def joint_pose(intrinsics: Intrinsics, seen: Sequence[SeenPanel]) -> Pose | None:
    """PnP on all corners at once, refined on their distances in the picture."""
    world = np.concatenate([s.world_from_panel.apply(s.corners_panel) for s in seen])
    return _pnp(intrinsics, world, np.concatenate([s.pixels for s in seen]), cv2.SOLVEPNP_SQPNP)


def averaged_pose(intrinsics: Intrinsics, seen: Sequence[SeenPanel]) -> Pose | None:
    """The mean of what each picture alone says, its turns by the chordal mean.

    Of a small plane the mirrored pose fits nearly as well: what is turned far from the one that
    most are near to is left out.
    """
    poses = [
        camera_from_panel @ s.world_from_panel.inverse()
        for s, camera_from_panel in _each(intrinsics, seen)
    ]
    if not poses:
        return None
    turns = np.array([[_turn(a, b) for b in poses] for a in poses])
    middle = int(np.argmin(np.median(turns, axis=1)))
    poses = [pose for pose, turn in zip(poses, turns[middle], strict=True) if turn < MIRRORED]
    u, _, vt = np.linalg.svd(np.sum([pose.rotation for pose in poses], axis=0))
    rotation = u @ np.diag([1, 1, np.linalg.det(u @ vt)]) @ vt
    centre = np.mean([pose.inverse().translation for pose in poses], axis=0)
    return Pose(rotation, -rotation @ centre)


def aligned_pose(intrinsics: Intrinsics, seen: Sequence[SeenPanel]) -> Pose | None:
    """Rigid alignment of where each panel is with where the robot held it."""
    pairs = _each(intrinsics, seen)
    if len(pairs) < 3:
        return None
    world = [s.world_from_panel.translation for s, _ in pairs]
    return pose_from_points(
        world, [camera_from_panel.translation for _, camera_from_panel in pairs]
    )


def _turn(one: Pose, other: Pose) -> float:
    return float(np.linalg.norm((one @ other.inverse()).rotation_vector()))


def _each(intrinsics: Intrinsics, seen: Sequence[SeenPanel]) -> list[tuple[SeenPanel, Pose]]:
    """The panels whose own pose can be told, each with it."""
    alone = [
        (s, _pnp(intrinsics, s.corners_panel, s.pixels, cv2.SOLVEPNP_IPPE))
        for s in seen
        if len(s.pixels) >= 4
    ]
    return [(s, pose) for s, pose in alone if pose is not None]


def _pnp(intrinsics: Intrinsics, points: np.ndarray, pixels: np.ndarray, how: int) -> Pose | None:
    if len(points) < 4:
        return None
    rays = intrinsics.rays(pixels)
    plane = rays[:, :2] / rays[:, 2:]
    done, turn, place = cv2.solvePnP(points, plane, np.eye(3), np.zeros(0), flags=how)
    if not done:
        return None
    turn, place = cv2.solvePnPRefineLM(points, plane, np.eye(3), np.zeros(0), turn, place)
    return Pose.from_rotation_vector(turn.ravel(), place.ravel())


def _grey(picture: np.ndarray, scale: int) -> np.ndarray:
    grey = cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY)
    if scale == 1:
        return grey
    return cv2.resize(grey, None, fx=scale, fy=scale, interpolation=cv2.INTER_CUBIC)
