# SPDX-License-Identifier: GPL-3.0-or-later
"""`monocell find`: a picture, its camera and the ball's radius in, the ball's centre out."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np

from ...core.ball.outline import SphereOutline
from ...core.document.camera_file import read_camera
from ...core.errors import InvalidValue
from ...core.intrinsics import Intrinsics
from ...core.sighting import SphereSighting
from ..told import millimetres, point_told, print_json, warn


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's own arguments."""
    parser.add_argument("picture", type=Path, help="a PNG or JPEG as the camera gave it")
    parser.add_argument("--camera", type=Path, required=True, help="camera file or cell document")
    parser.add_argument("--radius", type=float, required=True, help="the ball's radius in metres")
    parser.add_argument(
        "--window",
        type=float,
        nargs=4,
        metavar=("X", "Y", "W", "H"),
        help="where the ball's middle may be, in pixels; the whole picture without it",
    )
    parser.add_argument("--overlay", type=Path, help="write the picture with the outline on it")
    parser.add_argument("--json", action="store_true", help="print JSON")


def run(args: argparse.Namespace) -> int:
    """Find the ball, print it, draw it."""
    from ...core.ball.find import find_sphere
    from ...core.picture.pictures import read_picture

    if args.overlay is not None and args.overlay.resolve() == args.picture.resolve():
        raise InvalidValue(f"{args.overlay}: the overlay would replace the picture; name another")
    # the same checks as in a document: radius and window are refused with their numbers
    asked = SphereSighting(str(args.picture), np.zeros(3), args.radius, _window(args.window))
    intrinsics = read_camera(args.camera).intrinsics
    picture = read_picture(args.picture, intrinsics)
    outline = find_sphere(picture, intrinsics, asked.radius, asked.window)
    if args.overlay is not None:
        _draw(args.overlay, picture, intrinsics, outline)
    if args.json:
        print_json(_document(outline))
    else:
        _tell(outline)
    warn(outline.warnings)
    return 0


def _window(values: list[float] | None) -> tuple[float, float, float, float] | None:
    return None if values is None else (values[0], values[1], values[2], values[3])


def _sigma(outline: SphereOutline) -> np.ndarray:
    return np.sqrt(np.diag(outline.covariance))


def _document(outline: SphereOutline) -> dict[str, Any]:
    return {
        "center_camera": outline.centre_camera,
        "sigma": _sigma(outline),
        "covariance": outline.covariance,
        "radius": outline.radius,
        "coverage": outline.coverage,
        "cut": outline.cut,
        "rms_pixels": outline.rms_pixels,
        "blur_pixels": outline.blur_pixels,
        "outline_pixels": outline.pixels[outline.used],
        "warnings": outline.warnings,
    }


def _tell(outline: SphereOutline) -> None:
    middle = outline.pixels[outline.used].mean(axis=0)
    sigma = ", ".join(millimetres(s) for s in _sigma(outline))
    print(f"ball at {point_told(outline.centre_camera)} in the camera frame (x right, y down)")
    print(f"1 sigma  {sigma}")
    print(
        f"outline  around pixel ({middle[0]:.1f}, {middle[1]:.1f}), {outline.used.sum()} points, "
        f"{100 * outline.coverage:.0f} % of it seen, {outline.rms_pixels:.2f} px rms"
    )


def _draw(path: Path, picture: Any, intrinsics: Intrinsics, outline: SphereOutline) -> None:
    from ...core.ball.sphere import outline_pixels
    from ...core.camera import Camera
    from ...core.picture.overlay import BallOutline, draw_overlay
    from ...core.pose import Pose
    from ..pictures import write_picture

    camera = Camera(intrinsics, Pose.identity())
    balls = [BallOutline(outline_pixels(intrinsics, outline.centre_camera, outline.radius))]
    write_picture(path, draw_overlay(picture, camera, (), balls))
