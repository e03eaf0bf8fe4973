# SPDX-License-Identifier: GPL-3.0-or-later
"""A real arm before a fixed camera, and a camera on a real arm: points with an unknown offset.

    python benchmarks/real_franka.py FOLDER

FOLDER holds eye_to_hand (an arm holds an AprilTag before a fixed camera) and eye_in_hand (a camera
on the arm looks at a chessboard), as in ViSP's hand-eye tutorial: pictures, intrinsics, and the
flange's pose in each. One point a picture, the middle of the tag or of the board, is used like a
click; neither the size of the tag nor that of the board. Printed are what the fit leaves, how well
it predicts a picture that it has not seen, and the sigmas it states.
"""

from __future__ import annotations

import argparse
import re
from pathlib import Path

import cv2
import numpy as np
from monocell.core.arrays import Array
from monocell.core.calibration.calibrate import Calibration, calibrate_outlines
from monocell.core.camera import Camera
from monocell.core.intrinsics import Intrinsics
from monocell.core.mount import Mount
from monocell.core.pose import Pose
from monocell.core.sighting import PointSighting
from monocell.headless.told import point_told, table

BOARD = (9, 6)


def main() -> None:
    """Both ways round, one table each."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    args = parser.parse_args()
    for name, mount in (("eye_to_hand", None), ("eye_in_hand", Mount())):
        folder = args.folder / name
        camera, sightings = Camera(_intrinsics(folder)), _sightings(folder)
        calibration = _calibrated(camera, sightings, mount)
        print(f"{name}: {len(sightings)} pictures, verdict {calibration.verdict}")
        _tell(calibration, [_left_out(camera, sightings, mount, i) for i in range(len(sightings))])


def _tell(calibration: Calibration, left_out: list[tuple[float, float]]) -> None:
    fit = calibration.fit
    rows = [
        (
            r.picture,
            r.status,
            f"{r.off_pixels:.2f}",
            f"{r.off_millimetres:.2f}",
            f"{p:.2f}",
            f"{m:.2f}",
        )
        for r, (p, m) in zip(calibration.sightings, left_out, strict=True)
    ]
    print(table(("picture", "status", "off px", "off mm", "unseen px", "unseen mm"), rows))
    used = [r for r in calibration.sightings if r.status != "rejected"]
    print(
        f"rms {_rms([r.off_pixels for r in used]):.2f} px, "
        f"{_rms([r.off_millimetres for r in used]):.2f} mm; leaving one out "
        f"{_rms([p for p, _ in left_out]):.2f} px, {_rms([m for _, m in left_out]):.2f} mm"
    )
    sigma = np.sqrt(np.diag(fit.covariance))
    print(
        f"camera at {point_told(fit.camera_from_base.inverse().translation)} of the base, "
        f"1 sigma {1e3 * np.linalg.norm(sigma[3:]):.1f} mm, "
        f"{np.degrees(np.linalg.norm(sigma[:3])):.2f} deg"
    )
    print(
        f"offset {point_told(fit.offsets[0])} "
        f"± {1e3 * np.linalg.norm(fit.offset_sigmas[0]):.1f} mm; "
        f"places off by {1e3 * fit.place_sigma:.2f} mm each"
    )
    for warning in calibration.warnings:
        print(f"warning: {warning}")
    print()


def _left_out(
    camera: Camera, sightings: list[PointSighting], mount: Mount | None, i: int
) -> tuple[float, float]:
    """By how much a fit of the others misses the point of picture i, pixels and millimetres."""
    others = [s for k, s in enumerate(sightings) if k != i]
    fit = _calibrated(camera, others, mount).fit
    flange = sightings[i].world_from_flange
    carrier = flange if mount is None else flange.inverse()
    centre = fit.camera_from_base.apply(carrier.apply(fit.offsets[0]))
    pixel = camera.intrinsics.project(centre[None])[0]
    off = float(np.linalg.norm(pixel - sightings[i].pixel))
    return off, 1e3 * off * float(centre[2]) / camera.intrinsics.fx


def _calibrated(camera: Camera, sightings: list[PointSighting], mount: Mount | None) -> Calibration:
    return calibrate_outlines(camera, sightings, [None] * len(sightings), mount=mount)


def _sightings(folder: Path) -> list[PointSighting]:
    found = []
    for file in sorted(folder.glob("franka_image-*.png")):
        picture = cv2.imread(str(file), cv2.IMREAD_GRAYSCALE)
        number = re.findall(r"\d+", file.stem)[-1]
        flange = _flange(folder / f"franka_pose_rPe_{number}.yaml")
        found.append(PointSighting(file.name, None, _middle(picture), world_from_flange=flange))
    return found


def _middle(picture: np.ndarray) -> Array:
    """Where the middle of the tag, or else of the chessboard, is in a picture."""
    dictionary = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_APRILTAG_36h11)
    parameters = cv2.aruco.DetectorParameters()
    parameters.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_SUBPIX
    tags, _, _ = cv2.aruco.ArucoDetector(dictionary, parameters).detectMarkers(picture)
    if tags:
        return _crossing(tags[0].reshape(4, 2).astype(float))
    found, corners = cv2.findChessboardCornersSB(picture, BOARD)
    if not found:
        raise SystemExit("neither a tag nor the board was found in a picture")
    grid = corners.reshape(BOARD[1], BOARD[0], 2).astype(float)
    return _crossing(grid[[0, 0, -1, -1], [0, -1, -1, 0]])


def _crossing(four: Array) -> Array:
    """Where the diagonals of four corners cross, which perspective keeps."""
    a, b = np.append(four[:2], [[1], [1]], axis=1), np.append(four[2:], [[1], [1]], axis=1)
    point = np.cross(np.cross(a[0], b[0]), np.cross(a[1], b[1]))
    return point[:2] / point[2]


def _flange(file: Path) -> Pose:
    """The flange's translation and rotation vector, six numbers in brackets."""
    numbers = [float(v) for v in re.findall(r"\[\s*([-+.\deE]+)\s*\]", file.read_text())]
    return Pose.from_rotation_vector(numbers[3:], numbers[:3])


def _intrinsics(folder: Path) -> Intrinsics:
    text = (folder / "franka_camera.xml").read_text()
    fields = dict(re.findall(r"<(\w+)>([-+.\deE]+)</", text))
    names = ("image_width", "image_height", "px", "py", "u0", "v0")
    width, height, fx, fy, cx, cy = (float(fields[name]) for name in names)
    return Intrinsics(int(width), int(height), fx, fy, cx, cy)


def _rms(values: list[float]) -> float:
    return float(np.sqrt(np.mean(np.square(values))))


if __name__ == "__main__":
    main()
